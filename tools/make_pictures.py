"""Draw the pictures of README and docs: ``python tools/make_pictures.py [RAW.csv]``.

RAW.csv : a switch on the bench, columns x_um, force_gf, actuated, one run down and up; by default the
MX Brown of the shared data. The pictures that need no measurement are drawn without it.
"""

from __future__ import annotations

import io
import os
import sys
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from PIL import Image

from fdvv.files import write_atomic
from fdvv.mechanism import WANTED_cN
from fdvv.model import FitMethod, MeasuredCurve, Stroke, active_part, fit_curve, load_builtin, scan_sizes
from fdvv.plot import (
    figure_of,
    figure_png,
    figure_svg,
    house_style,
    plot_averages,
    plot_fit,
    plot_mechanism,
    plot_model,
    plot_parts,
    plot_registration,
    plot_scan,
    plot_surface,
    plot_vibration,
)
from fdvv.preprocess import process
from fdvv.testing import captured_session
from fdvv.units import cN_from_gf
from fdvv.workflow import design_mechanism, designed_strokes, drawn_parts

ROOT = Path(__file__).parents[1]
OUTPUT = ROOT / "docs" / "images"
SHARED = Path(os.environ.get("FDVV_SHARED", ROOT.parent / "shared")) / "data"
RAW = SHARED / "bluepylons-parsed" / "Cherry-MX-Hyperglide-Brown.csv"
CREDIT = "data: bluepylons, CC BY 4.0"
LARGEST_PNG = 150_000
CAPTURE_SEED = 2


def read_press(path: Path) -> MeasuredCurve:
    """Read the way down of a bench file, from contact to bottom-out."""
    x_um, force_gf = np.loadtxt(path, delimiter=",", skiprows=1, usecols=(0, 1), unpack=True)
    deepest = int(np.argmax(x_um)) + 1
    # the stage may waver by a step: displacement never falls in a press
    x_mm = np.maximum.accumulate(x_um[:deepest]) / 1000.0
    return active_part(MeasuredCurve(x_mm, cN_from_gf(force_gf[:deepest]), Stroke.PRESS))


def draw_overview(measured: MeasuredCurve, name: str) -> Figure:
    """Draw the picture at the top of the README: the shipped model beside a fit of a raw switch."""
    fig = Figure(figsize=(13.0, 4.8), layout="constrained")
    grid = fig.add_gridspec(2, 2, width_ratios=(1.25, 1.0), height_ratios=(3, 1))
    with house_style():
        left, top = fig.add_subplot(grid[:, 0]), fig.add_subplot(grid[0, 1])
        axes = (top, fig.add_subplot(grid[1, 1], sharex=top))
    plot_model(load_builtin("mx-clear"), left)
    plot_fit(measured, [fit_curve(measured)], axes, title=name)
    top.tick_params(labelbottom=False)
    credit(fig)
    return fig


def credit(fig: Figure) -> None:
    """Write who measured at the foot of a figure."""
    fig.set_layout_engine("constrained", rect=(0.0, 0.035, 1.0, 0.965))
    fig.text(0.995, 0.005, CREDIT, ha="right", va="bottom", fontsize=7, color="#52606d")


def few_colours(png: bytes) -> bytes:
    """Bring a picture of lines down to a palette, a third of its size."""
    stream = io.BytesIO()
    picture = Image.open(io.BytesIO(png)).convert("RGB")
    picture.quantize(256, dither=Image.Dither.NONE).save(stream, format="png", optimize=True)
    return stream.getvalue()


def save_svg(name: str, drawn: Any, description: str) -> None:
    """Write a figure as docs/images/name.svg."""
    write_atomic(OUTPUT / f"{name}.svg", figure_svg(drawn, description))
    print(OUTPUT / f"{name}.svg")


def draw_model_pictures() -> None:
    """Draw what the shipped model looks like."""
    model = load_builtin("mx-clear")
    what = "of the shipped MX Clear model"
    save_svg("model", plot_model(model), f"Press and release curves {what}")
    surface = plot_surface(model, Stroke.PRESS)
    save_svg("surface", surface, f"Press force over displacement and velocity {what}")
    save_svg("vibration", plot_vibration(model), f"Vibration {what}")


def draw_capture_pictures() -> None:
    """Draw what becomes of a simulated recording of the procedure."""
    processed = process(captured_session("mx-clear", CAPTURE_SEED).recording)
    registered = plot_registration(processed, Stroke.PRESS, 200.0, simulated=True)
    save_svg("registration", registered, "Samples of presses at 200 mm/s, their mean and spread; simulated")
    averages = plot_averages(processed, simulated=True)
    save_svg("averages", averages, "Averaged curves of four paces with their spread; simulated")


def draw_mechanism_pictures() -> None:
    """Draw a leaf switch and a dome that were designed for two shipped models."""
    for name, kind in (("mx-clear", "leaf"), ("rubber-dome", "dome")):
        result = design_mechanism(load_builtin(name), kind, speeds_mm_s=())
        what = f"of a {kind} designed for the shipped model {name}; simulated"
        grid = plot_mechanism(designed_strokes(result), WANTED_cN, f"a {kind} for {name}")
        save_svg(f"mechanism-{kind}", grid, f"Target, design, tolerance band and residual {what}")
        save_svg(f"mechanism-{kind}-parts", plot_parts(drawn_parts(result)), f"Parts {what}")


def draw_fit_pictures(raw: Path) -> None:
    """Draw the overview and what the fit does to a raw switch."""
    measured, name = read_press(raw), raw.stem.replace("-", " ")
    content = few_colours(figure_png(draw_overview(measured, f"{name}, press"), dpi=120.0))
    if len(content) > LARGEST_PNG:
        raise SystemExit(f"overview.png has {len(content)} bytes, more than {LARGEST_PNG}")
    write_atomic(OUTPUT / "overview.png", content)
    print(OUTPUT / "overview.png")
    fits = [fit_curve(measured, method) for method in (FitMethod.UNIFORM, FitMethod.ADAPTIVE)]
    fig = figure_of(plot_fit(measured, fits, title=f"{name}, press"))
    credit(fig)
    save_svg("fit", fig, f"Uniform and adaptive fits of {name} with 15 control points")
    scores = {str(method): scan_sizes(measured, method) for method in FitMethod}
    fig = figure_of(plot_scan(scores, title=f"{name}, press"))
    credit(fig)
    save_svg("scan", fig, f"BIC* of {name} for 5 to 40 control points")


if __name__ == "__main__":
    raw_file = Path(sys.argv[1]) if len(sys.argv) > 1 else RAW
    draw_model_pictures()
    draw_capture_pictures()
    draw_mechanism_pictures()
    if not raw_file.exists():
        raise SystemExit(f"{raw_file} is not there: pass a bench file to draw overview, fit and scan")
    draw_fit_pictures(raw_file)

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

from fdvv.bench.figures import plot_averages, plot_registration
from fdvv.button.figures import plot_fit
from fdvv.io.files import write_atomic
from fdvv.model.curve import MeasuredCurve, Stroke
from fdvv.model.file import load_builtin
from fdvv.model.fit import active_part, fit_curve
from fdvv.preprocess.process import process
from fdvv.report.model_figures import plot_model, plot_vibration
from fdvv.report.style import house_style
from fdvv.report.svg import figure_png, figure_svg
from fdvv.testing.captured import captured_session
from fdvv.units import cN_from_gf
from fdvv_switch.design_button import design_mechanism
from fdvv_switch.figures import plot_mechanism, plot_parts
from fdvv_switch.report import designed_strokes
from fdvv_switch.residual import WANTED_cN
from fdvv_switch.section import drawings_of

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
    plot_fit(measured, [fit_curve(measured, control_points=15)], axes, title=name)
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
    save_svg("vibration", plot_vibration(load_builtin("mx-clear")), "Vibration of the shipped MX Clear model")


def draw_capture_pictures() -> None:
    """Draw what becomes of a simulated recording of the procedure."""
    processed = process(captured_session("mx-clear", CAPTURE_SEED).recording)
    registered = plot_registration(processed, Stroke.PRESS, 200.0, simulated=True)
    save_svg("registration", registered, "Samples of presses at 200 mm/s, their mean and spread; simulated")
    averages = plot_averages(processed, simulated=True)
    save_svg("averages", averages, "Averaged curves of four velocities with their spread; simulated")


def draw_mechanism_pictures() -> None:
    """Draw a leaf switch that was designed for a shipped model."""
    result = design_mechanism(load_builtin("mx-clear"), "leaf", speeds_mm_s=())
    what = "of a leaf designed for the shipped model mx-clear; simulated"
    grid = plot_mechanism(designed_strokes(result), WANTED_cN, "a leaf for mx-clear")
    save_svg("mechanism-leaf", grid, f"Target, design, tolerance band and residual {what}")
    save_svg("mechanism-leaf-parts", plot_parts(drawings_of(result.mechanism)), f"Parts {what}")


def draw_overview_picture(raw: Path) -> None:
    """Draw the overview of a raw switch and its fits."""
    measured, name = read_press(raw), raw.stem.replace("-", " ")
    content = few_colours(figure_png(draw_overview(measured, f"{name}, press"), dpi=120.0))
    if len(content) > LARGEST_PNG:
        raise SystemExit(f"overview.png has {len(content)} bytes, more than {LARGEST_PNG}")
    write_atomic(OUTPUT / "overview.png", content)
    print(OUTPUT / "overview.png")


if __name__ == "__main__":
    raw_file = Path(sys.argv[1]) if len(sys.argv) > 1 else RAW
    draw_model_pictures()
    draw_capture_pictures()
    draw_mechanism_pictures()
    if not raw_file.exists():
        raise SystemExit(f"{raw_file} is not there: pass a bench file to draw the overview")
    draw_overview_picture(raw_file)

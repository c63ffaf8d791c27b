"""One button, or several compared, as one HTML file to hand on: nothing fetched, nothing run."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from fdvv.button.compare import Comparison, compare
from fdvv.button.kind import kind_sentence
from fdvv.button.like import LikeTable, button_figures, distances
from fdvv.errors import ModelError
from fdvv.force_text import force_number, force_unit, shown_force
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.file import MODEL_SUFFIX, model_to_json
from fdvv.model.model import FDVVModel
from fdvv.model.noticeable import LITERATURE, Jnds
from fdvv.report.chart import SPEEDS, ChartLine, chart_svg
from fdvv.report.report import Download, Section, Table, render_html

MOST_BUTTONS = 6
"""More colours are hard to distinguish."""

WIDE, HIGH = 720.0, 340.0  # px; leaves a quarter of the report's 62rem to the legend; the height is assumed
STEP_mm = 0.01  # 1.7 px of the chart at 4 mm of travel; finer is hardly seen
SAME_jnd, NEAR_jnd = 1.0, 2.0  # 1: by what a JND is; 2: assumed; neither was tried on people

LANDMARKS: tuple[tuple[str, str, int], ...] = (
    ("Travel, mm", "travel_mm", 2),
    ("Actuation, mm", "actuation_mm", 2),
    ("Force at actuation, {}", "actuation_cN", 1),
    ("Preload, {}", "preload_cN", 1),
    ("Peak, {}", "peak_cN", 1),
    ("Peak at, mm", "peak_mm", 2),
    ("Valley, {}", "valley_cN", 1),
    ("Snap ratio", "snap_ratio", 3),
    ("Bottom-out, {}", "bottom_out_cN", 1),
    ("Work of the press, mJ", "work_mJ", 3),
    ("Hysteresis loss, mJ", "hysteresis_loss_mJ", 3),
)


def buttons_page(
    models: Sequence[FDVVModel], velocity_mm_s: float | None = None, jnds: Jnds = LITERATURE
) -> str:
    """Return the page of one button, or of several; the first is the reference of a comparison.

    velocity_mm_s : of the curves that are compared, the slowest by default; a button alone shows all.
    jnds : what their distance is counted in. The model files are in the page, to be saved from it. Raises
    ModelError for no button, for more than six, and for one without a press.
    """
    if not 1 <= len(models) <= MOST_BUTTONS:
        raise ModelError(f"a page shows 1 to {MOST_BUTTONS} buttons, got {len(models)}")
    found = compare(models, velocity_mm_s)
    alone = len(models) == 1
    compared = " ".join((*difference_sentences(models, jnds), counted_in(jnds)))
    summary = kind_sentence(models[0]) if alone else compared
    lines = _every_line(models[0]) if alone else list(_compared_lines(models, velocity_mm_s))
    sections = [
        Section("Force over displacement", (_legend(alone),), (_chart(lines, models),)),
        Section("Landmarks", tables=(_landmark_table(found),)),
    ]
    if not alone:
        sections.append(Section("Differences of force", tables=(_difference_table(found),)))
    sections.append(Section("Where the curves come from", tuple(_origin(model) for model in models)))
    simulated = [model.name for model in models if model.provenance.simulated]
    return render_html(
        models[0].name if alone else f"{', '.join(found.names[:-1])} and {found.names[-1]}",
        summary,
        sections,
        "Made with fdvv, the button laboratory. 1 cN is about 1 gf.",
        f"{' and '.join(simulated)} was not measured on hardware" if simulated else None,
        [Download(f"{model.name}{MODEL_SUFFIX}", model_to_json(model)) for model in models],
    )


def difference_sentences(models: Sequence[FDVVModel], jnds: Jnds = LITERATURE) -> Iterator[str]:
    """Say of every button but the first how unlike the first it feels, in just noticeable differences.

    The distance is fdvv.button.like's, an estimate. jnds : what it is counted in.
    """
    table = LikeTable()
    table.extend([button_figures(model) for model in models])
    parts = table.parts(0, jnds)[1:]
    for model, jnd, of in zip(models[1:], distances(parts), parts, strict=True):
        if not np.isfinite(jnd):
            yield f"{model.name} and {models[0].name} share too little to be compared."
            continue
        what = ("force", "shape of the curve", "places of the landmarks")[int(np.argmax(of))]
        by = f"about {jnd:.1f} just noticeable differences, most of it in the {what}"
        yield f"{model.name} {_felt(float(jnd))} {models[0].name}: {by}."


def counted_in(jnds: Jnds) -> str:
    """Say in one sentence whose JNDs distances are counted in."""
    return f"Counted in {jnds.origin}; computed, not tried on people."


def _felt(jnd: float) -> str:
    if jnd < SAME_jnd:
        return "can hardly be felt apart from"
    return "feels close to" if jnd < NEAR_jnd else "feels clearly different from"


def _legend(alone: bool) -> str:
    colour = "The faster, the darker." if alone else "Each button has a colour."
    return f"{colour} The press is solid, the release dashed. Displacement counts from contact."


def _every_line(model: FDVVModel) -> list[ChartLine]:
    speeds = sorted({curve.velocity_mm_s or 0.0 for curve in model.curves})
    last = max(len(speeds) - 1, 1)

    def colour(curve: ForceCurve) -> str:
        return SPEEDS[round((len(SPEEDS) - 1) * speeds.index(curve.velocity_mm_s or 0.0) / last)]

    return [_line(curve, _speed_name(curve), colour(curve)) for curve in model.curves]


def _speed_name(curve: ForceCurve) -> str:
    """Name a curve by its speed, once for both strokes."""
    if curve.stroke is Stroke.RELEASE:
        return ""
    return "press" if curve.velocity_mm_s is None else f"{curve.velocity_mm_s:g} mm/s"


def _compared_lines(models: Sequence[FDVVModel], velocity_mm_s: float | None) -> Iterator[ChartLine]:
    for at, model in enumerate(models):
        for stroke in Stroke:
            curve = model.nearest(stroke, velocity_mm_s)
            if curve is not None:
                yield _line(curve, model.name if stroke is Stroke.PRESS else "", at)


def _line(curve: ForceCurve, name: str, colour: int | str) -> ChartLine:
    drawn = curve.sample(STEP_mm)
    dashed = curve.stroke is Stroke.RELEASE
    return ChartLine(drawn.displacement_mm, shown_force(drawn.force_cN), name, colour, dashed)


def _chart(lines: Sequence[ChartLine], models: Sequence[FDVVModel]) -> str:
    title = f"Force over displacement of {', '.join(model.name for model in models)}"
    return chart_svg(lines, "displacement (mm)", f"force ({force_unit()})", title, WIDE, HIGH)


def _landmark_table(found: Comparison) -> Table:
    marks = [mark.to_dict() for mark in found.landmarks]
    rows = tuple(
        (label.format(force_unit()), *(_number(mark[name], digits, "{}" in label) for mark in marks))
        for label, name, digits in LANDMARKS
        if any(mark[name] is not None for mark in marks)
    )
    return Table(("", *found.names), rows)


def _difference_table(found: Comparison) -> Table:
    rows = tuple(
        (
            d.name,
            str(d.stroke),
            *(_number(value, 1, True) for value in (d.rms_cN, d.mean_cN, d.max_cN)),
            f"{d.max_mm:.2f}",
        )
        for d in found.differences
    )
    columns = (
        "Button",
        "Stroke",
        *(f"{name}, {force_unit()}" for name in ("RMS", "Mean", "Largest")),
        "at, mm",
    )
    return Table(columns, rows, f"Force of each button less that of {found.names[0]}.")


def _number(value: float | None, digits: int, force: bool = False) -> str:
    write = force_number if force else format
    return "–" if value is None else write(value, f".{digits}f").replace("-", "−")


def _origin(model: FDVVModel) -> str:
    said = "; ".join(filter(None, (model.provenance.source, model.provenance.method)))
    return f"{model.name}: {said or 'its file does not say'}."

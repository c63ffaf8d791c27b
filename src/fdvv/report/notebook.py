"""What a notebook shows of a model, its landmarks or a press: small charts and tables, without script."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from fdvv.model._chart import ChartLine, chart_svg, words
from fdvv.model._curve import ForceCurve, Stroke

if TYPE_CHECKING:
    from fdvv.model._landmarks import Landmarks
    from fdvv.model._model import FDVVModel
    from fdvv.model._press import Press

UNITS = {"mm_s": "mm/s", "cN_mm": "cN/mm", "mm": "mm", "cN": "cN", "mJ": "mJ", "ratio": "1"}
"""Last parts of our names, longest first, and what people read."""
POINTS = 160
LONGEST_LICENCE = 36
FORCE, DISPLACEMENT = "force (cN)", "displacement (mm)"


def block(title: str, note: str, parts: Sequence[str]) -> str:
    """Join charts and tables side by side under a title; they go below each other where there is no room.

    title and note are escaped, parts are HTML already.
    """
    head = f"<strong>{words(title)}</strong>" + (f" <span>{words(note)}</span>" if note else "")
    body = "".join(f'<div style="flex:none">{part}</div>' for part in parts)
    style = "display:flex;flex-wrap:wrap;gap:1em;align-items:flex-start"
    return f'<div style="color:inherit"><div>{head}</div><div style="{style}">{body}</div></div>'


def table(rows: Sequence[Sequence[str]], head: Sequence[str] = ()) -> str:
    """Lay text out as a table; the first column to the left, the others to the right. Cells are escaped."""
    style = "padding:1px 8px;text-align:{};background:none;color:inherit;font-weight:{}"

    def line(cells: Sequence[str], tag: str) -> str:
        weight = "600" if tag == "th" else "normal"
        made = [
            f'<{tag} style="{style.format("right" if i else "left", weight)}">{words(cell)}</{tag}>'
            for i, cell in enumerate(cells)
        ]
        return f'<tr style="background:none">{"".join(made)}</tr>'

    titles = line(head, "th") if head else ""
    body = "".join(line(row, "td") for row in rows)
    return f'<table style="border-collapse:collapse;font-size:90%;margin:0">{titles}{body}</table>'


def model_html(model: FDVVModel) -> str:
    """Show a model: its curves, the contact's points, and the figures people compare."""
    note = f"{model.travel_mm:g} mm" + (", simulated" if model.provenance.simulated else "")
    chart = chart_svg(_curves(model), DISPLACEMENT, FORCE, f"force over displacement of {model.name}")
    return block(model.name, note, [chart, table(_facts(model))])


def _curves(model: FDVVModel) -> list[ChartLine]:
    lines = []
    for stroke in Stroke:
        curves = model.of(stroke)
        for rank, curve in enumerate(curves):
            # the slowest stands out; the others fade towards the fastest
            opacity = 1.0 if len(curves) == 1 else 1.0 - 0.6 * rank / (len(curves) - 1)
            colour = 0 if stroke is Stroke.PRESS else 1
            x = np.linspace(curve.start_mm, curve.end_mm, POINTS)
            name = _named(curve, len(curves)) if rank in (0, len(curves) - 1) else ""
            lines.append(ChartLine(x, curve.force_cN(x), name, colour, stroke is Stroke.RELEASE, opacity))
    points = ((Stroke.PRESS, model.actuation_mm, "actuation"), (Stroke.RELEASE, model.reset_mm, "reset"))
    for stroke, at, name in points:
        on = model.nearest(stroke)
        if at is not None and on is not None:
            place = np.array([at])
            lines.append(
                ChartLine(place, on.force_cN(place), name, 0 if name == "actuation" else 1, dots=True)
            )
    return lines


def _named(curve: ForceCurve, of: int) -> str:
    speed = "" if curve.velocity_mm_s is None else f" {curve.velocity_mm_s:g} mm/s"
    return f"{curve.stroke}{speed}" if of > 1 or speed else str(curve.stroke)


def _facts(model: FDVVModel) -> list[tuple[str, str]]:
    from fdvv.model._landmarks import landmarks

    rows = [("curves", str(len(model.curves))), ("vibrations", str(len(model.vibrations)))]
    if model.of(Stroke.PRESS):
        found = landmarks(model).to_dict()
        names = ("preload_cN", "peak_mm", "peak_cN", "valley_cN", "snap_ratio", "bottom_out_cN", "work_mJ")
        rows += [_row(name, found[name]) for name in names if found[name] is not None]
    if model.provenance.licence:
        licence = model.provenance.licence
        rows.append(
            ("licence", licence if len(licence) <= LONGEST_LICENCE else f"{licence[:LONGEST_LICENCE]}…")
        )
    return rows


def _row(name: str, value: float | None) -> tuple[str, str]:
    """Take the unit out of a name and put it behind the number."""
    for ending, unit in UNITS.items():
        if name.endswith(f"_{ending}"):
            name = name.removesuffix(f"_{ending}")
            shown = "–" if value is None else f"{value:.3g}" if unit == "1" else f"{value:.2f} {unit}"
            return name.replace("_", " "), shown
    return name.replace("_", " "), "–" if value is None else f"{value:g}"


def landmarks_html(found: Landmarks) -> str:
    """Show landmarks as a table; what a button has not is a dash."""
    rows = [_row(name, value) for name, value in found.to_dict().items()]
    half = (len(rows) + 1) // 2
    return block("landmarks", "", [table(rows[:half]), table(rows[half:])])


def press_html(press: Press) -> str:
    """Show a press: force over displacement, and displacement over time."""
    turn = int(np.argmax(press.displacement_mm)) + 1
    x, force = press.displacement_mm, press.force_cN
    lines = [
        ChartLine(x[:turn], force[:turn], "press"),
        ChartLine(x[turn:], force[turn:], "release", 1, True),
    ]
    if turn == x.size:
        lines = lines[:1]
    title = f"press at {press.velocity_mm_s:g} mm/s"
    time = chart_svg([ChartLine(press.t_s, x)], "time (s)", DISPLACEMENT, f"{title}: displacement over time")
    loop = chart_svg(lines, DISPLACEMENT, FORCE, f"{title}: force over displacement")
    note = f"{press.t_s.size} samples" + (", simulated" if press.simulated else "")
    return block(title, note, [loop, time])


def bundle(html: str, text: str) -> dict[str, str]:
    """Give what IPython asks an object for: the drawing, and a line where nothing can be drawn."""
    return {"text/html": html, "text/plain": text}

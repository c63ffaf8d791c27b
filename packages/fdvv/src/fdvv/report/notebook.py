"""Models, landmarks, presses and recordings in a notebook: small charts and tables, without script.

Records do not know their pictures: `import fdvv` registers `to_html` with IPython where one runs.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from fdvv.force_text import force_text, force_unit, shown_force
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.landmarks import Landmarks, landmarks
from fdvv.model.model import FDVVModel
from fdvv.model.press import Press
from fdvv.recording.types import UNITS, Recording, Stream, Take
from fdvv.report.chart import ChartLine, chart_svg, printable
from fdvv.report.templates import environment

READ_UNITS = {"mm_s": "mm/s", "cN_mm": "cN/mm", "mm": "mm", "cN": "cN", "mJ": "mJ", "ratio": "1"}
"""Last parts of our names, longest first, and what people read."""
POINTS = 160  # every 2.3 px of a chart, whose axes are 372 px wide; chart.MOST_POINTS thins longer lines
LONGEST_LICENCE = 36  # assumed; names of licences fit, a sentence would widen the table beside the chart
DISPLACEMENT = "displacement (mm)"


def _force_axis() -> str:
    return f"force ({force_unit()})"


def block(title: str, note: str, parts: Sequence[str]) -> str:
    """Return charts and tables side by side under a title; they wrap where there is no room.

    title and note are escaped, parts are HTML already.
    """
    template = environment().get_template("notebook_block.html")
    return template.render(title=printable(title), note=printable(note), parts=parts)


def table(rows: Sequence[Sequence[str]], head: Sequence[str] = ()) -> str:
    """Return text as a table; the first column to the left, the others to the right. Cells are escaped."""
    cells = [[printable(cell) for cell in row] for row in rows]
    return environment().get_template("notebook_table.html").render(rows=cells, head=head)


def model_html(model: FDVVModel) -> str:
    """Show a model: its curves, the contact's points, and the figures people compare."""
    note = f"{model.travel_mm:g} mm" + (", simulated" if model.provenance.simulated else "")
    chart = chart_svg(_curves(model), DISPLACEMENT, _force_axis(), f"force over displacement of {model.name}")
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
            name = _label(curve, len(curves)) if rank in (0, len(curves) - 1) else ""
            lines.append(
                ChartLine(x, shown_force(curve.force_cN(x)), name, colour, stroke is Stroke.RELEASE, opacity)
            )
    points = ((Stroke.PRESS, model.actuation_mm, "actuation"), (Stroke.RELEASE, model.reset_mm, "reset"))
    for stroke, at, name in points:
        on = model.nearest(stroke)
        if at is not None and on is not None:
            place, colour = np.array([at]), 0 if stroke is Stroke.PRESS else 1
            lines.append(ChartLine(place, shown_force(on.force_cN(place)), name, colour, dots=True))
    return lines


def _label(curve: ForceCurve, of: int) -> str:
    speed = "" if curve.velocity_mm_s is None else f" {curve.velocity_mm_s:g} mm/s"
    return f"{curve.stroke}{speed}" if of > 1 or speed else str(curve.stroke)


def _facts(model: FDVVModel) -> list[tuple[str, str]]:
    rows = [("curves", str(len(model.curves))), ("vibrations", str(len(model.vibrations)))]
    if model.of(Stroke.PRESS):
        marks = landmarks(model).to_dict()
        names = ("preload_cN", "peak_mm", "peak_cN", "valley_cN", "snap_ratio", "bottom_out_cN", "work_mJ")
        rows += [_landmark_row(name, marks[name]) for name in names if marks[name] is not None]
    if model.provenance.licence:
        licence = model.provenance.licence
        short = licence if len(licence) <= LONGEST_LICENCE else f"{licence[:LONGEST_LICENCE]}…"
        rows.append(("licence", short))
    return rows


def _landmark_row(name: str, value: float | None) -> tuple[str, str]:
    """Take the unit out of a name and put it behind the number."""
    for ending, unit in READ_UNITS.items():
        if name.endswith(f"_{ending}"):
            name = name.removesuffix(f"_{ending}")
            return name.replace("_", " "), "–" if value is None else _with_unit(value, unit)
    return name.replace("_", " "), "–" if value is None else f"{value:g}"


def _with_unit(value: float, unit: str) -> str:
    if unit.startswith("cN"):
        return force_text(value, ".2f", unit.removeprefix("cN"))
    return f"{value:.3g}" if unit == "1" else f"{value:.2f} {unit}"


def landmarks_html(marks: Landmarks) -> str:
    """Show landmarks as a table; what a button has not is a dash."""
    rows = [_landmark_row(name, value) for name, value in marks.to_dict().items()]
    half = (len(rows) + 1) // 2
    return block("landmarks", "", [table(rows[:half]), table(rows[half:])])


def press_html(press: Press) -> str:
    """Show a press: force over displacement, and displacement over time."""
    turn = int(np.argmax(press.displacement_mm)) + 1
    x, force = press.displacement_mm, shown_force(press.force_cN)
    lines = [ChartLine(x[:turn], force[:turn], "press")]
    if turn < x.size:
        lines.append(ChartLine(x[turn:], force[turn:], "release", 1, True))
    title = f"press at {press.velocity_mm_s:g} mm/s"
    time = chart_svg([ChartLine(press.t_s, x)], "time (s)", DISPLACEMENT, f"{title}: displacement over time")
    loop = chart_svg(lines, DISPLACEMENT, _force_axis(), f"{title}: force over displacement")
    note = f"{press.t_s.size} samples" + (", simulated" if press.simulated else "")
    return block(title, note, [loop, time])


MOST_TAKES = 20
DRAWN = ("force", "displacement", "sound", "acceleration", "counts", "light")
"""What is drawn of a take: the first of these that it has, alone, for clocks and units differ."""


def recording_html(recording: Recording) -> str:
    """Show a recording: its takes, and of the first press, or else the first take, one stream."""
    rows = [_take_row(take) for take in recording.takes[:MOST_TAKES]]
    if len(recording.takes) > MOST_TAKES:
        rows.append((f"… {len(recording.takes) - MOST_TAKES} more", "", "", ""))
    parts = [table(rows, ("take", "stage", "mm/s", "streams"))]
    drawn = _choose_stream(recording)
    if drawn:
        parts.append(_stream_chart(*drawn))
    note = f"{len(recording.takes)} takes" + (", simulated" if recording.simulated else "")
    return block(recording.name, note, parts)


def _take_row(take: Take) -> tuple[str, str, str, str]:
    speed = "–" if take.velocity_mm_s is None else f"{take.velocity_mm_s:g}"
    streams = ", ".join(f"{s.name} ({s.t_s.size})" for s in take.streams)
    return str(take.number), str(take.stage), speed, streams if len(streams) <= 80 else f"{streams[:79]}…"


def _choose_stream(recording: Recording) -> tuple[Take, Stream] | None:
    """Choose what is drawn: something of a press if there is one."""
    for take in sorted(recording.takes, key=lambda take: (take.stage != "press", take.number)):
        for quantity in DRAWN:
            for stream in take.of(quantity):
                if stream.raw.ndim == 1 and stream.t_s.size > 1:
                    return take, stream
    return None


def _stream_chart(take: Take, stream: Stream) -> str:
    label = f"{stream.quantity} ({UNITS[stream.quantity]})"
    line = ChartLine(stream.t_s - stream.t_s[0], stream.values)
    return chart_svg([line], "time (s)", label, f"take {take.number}: {stream.name}")


DRAWN_BY: dict[type[Any], Callable[[Any], str]] = {
    FDVVModel: model_html,
    Landmarks: landmarks_html,
    Press: press_html,
    Recording: recording_html,
}


def to_html(record: Any) -> str:
    """Return the HTML of a model, landmarks, a press or a recording; raise KeyError for anything else."""
    return DRAWN_BY[type(record)](record)

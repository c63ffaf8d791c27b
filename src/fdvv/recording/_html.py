"""What a notebook shows of a recording: its takes as a table, and one of them drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fdvv.model import ChartLine, chart_svg, html_block, html_table

if TYPE_CHECKING:
    from fdvv.recording._types import Recording, Stream, Take

MOST_TAKES = 20
DRAWN = ("force", "displacement", "sound", "acceleration", "counts", "light")
"""What is drawn of a take: the first of these that it has, alone, for clocks and units differ."""


def recording_html(recording: Recording) -> str:
    """Show a recording: its takes, and of the first press, or else the first take, one stream."""
    rows = [_row(take) for take in recording.takes[:MOST_TAKES]]
    if len(recording.takes) > MOST_TAKES:
        rows.append((f"… {len(recording.takes) - MOST_TAKES} more", "", "", ""))
    parts = [html_table(rows, ("take", "stage", "mm/s", "streams"))]
    drawn = _drawn(recording)
    if drawn:
        parts.append(_chart(*drawn))
    note = f"{len(recording.takes)} takes" + (", simulated" if recording.simulated else "")
    return html_block(recording.name, note, parts)


def _row(take: Take) -> tuple[str, str, str, str]:
    speed = "–" if take.velocity_mm_s is None else f"{take.velocity_mm_s:g}"
    streams = ", ".join(f"{s.name} ({s.t_s.size})" for s in take.streams)
    return str(take.number), str(take.stage), speed, streams if len(streams) <= 80 else f"{streams[:79]}…"


def _drawn(recording: Recording) -> tuple[Take, Stream] | None:
    """Choose what is drawn: something of a press if there is one."""
    for take in sorted(recording.takes, key=lambda take: (take.stage != "press", take.number)):
        for quantity in DRAWN:
            for stream in take.of(quantity):
                if stream.raw.ndim == 1 and stream.t_s.size > 1:
                    return take, stream
    return None


def _chart(take: Take, stream: Stream) -> str:
    from fdvv.recording._types import UNITS

    label = f"{stream.quantity} ({UNITS[stream.quantity]})"
    line = ChartLine(stream.t_s - stream.t_s[0], stream.values)
    return chart_svg([line], "time (s)", label, f"take {take.number}: {stream.name}")

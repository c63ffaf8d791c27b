"""A recording as one long table of text: what every statistics program reads."""

from __future__ import annotations

import csv
import io
import math

from fdvv.exchange._types import Exported
from fdvv.recording import UNITS, Recording

COLUMNS = ("take", "stage", "velocity_mm_s", "stream", "axis", "quantity", "unit", "clock", "t_s", "value")
FORMULA = ("=", "+", "-", "@", "\t", "\r")
"""What makes a spreadsheet run a cell; a name that begins so is set off with an apostrophe."""


def recording_csv(recording: Recording) -> Exported:
    """Write a row for each sample of each stream, with its unit; a marker has a row for each axis.

    The columns are those of recording_to_pandas. Times of different clocks cannot be compared; what was not
    seen is an empty cell.
    """
    held = io.StringIO()
    writer = csv.writer(held, lineterminator="\n")
    writer.writerow(COLUMNS)
    for take in recording.takes:
        speed = "" if take.velocity_mm_s is None else repr(float(take.velocity_mm_s))
        for stream in take.streams:
            values = stream.values.reshape(stream.t_s.size, -1)
            axes = [""] if stream.raw.ndim == 1 else "xyz" if values.shape[1] == 3 else range(values.shape[1])
            fixed = [str(stream.quantity), UNITS[stream.quantity], _plain(stream.clock)]
            times = [repr(t) for t in stream.t_s.tolist()]
            for axis, column in zip(axes, values.T.tolist(), strict=True):
                head = [take.number, str(take.stage), speed, _plain(stream.name), axis, *fixed]
                writer.writerows(
                    [*head, t, "" if math.isnan(value) else repr(value)]
                    for t, value in zip(times, column, strict=True)
                )
    kept = ("every sample in its unit, with take, stage, pace and clock",)
    lost = ("marks, raw counts and calibration", "bench, sources and remarks")
    return Exported("recording-csv", held.getvalue().encode(), kept, lost)


def _plain(text: str) -> str:
    return f"'{text}" if text.startswith(FORMULA) else text

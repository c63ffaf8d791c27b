"""Exports of OptiTrack's Motive as CSV, versions 1.21 to 1.25."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from fdvv.recording._motive_head import EXPORT, KNOWN, Head, LENGTH_mm, made, read_head
from fdvv.recording._reading import Reading, counted, number, refusal, rising, unlike
from fdvv.recording._types import Quantity, Stream
from fdvv.text import cells
from fdvv.units import FloatArray

CLOCK = "camera"
ROUNDED_s = 0.00055
"""Times are printed to a millisecond at some rates, to a microsecond at others."""


def read_motive(source: Path, lines: Sequence[str]) -> Reading:
    """Read each place as a marker in the unit of the file; a blank cell, where nothing was seen, is NaN.

    Times are those of the frame counter at the export's frame rate where the printed ones agree to within
    their rounding, else the printed ones. Raises InputError.
    """
    head = read_head(source, lines)
    warnings = _told(head)
    table, told = _table(head, lines)
    warnings += told
    if not table.shape[0]:
        raise refusal(source, f"line {head.first_row + 1}", "it holds no frame", EXPORT)
    t_s, told = _times(head, table[:, 0], table[:, 1])
    keep = rising(t_s)
    dropped = int(keep.size - keep.sum())
    warnings += told + ([f"{counted(dropped, 'frame')} left out: the times do not rise"] if dropped else [])
    warnings += _frames(head, table[:, 0])
    begun = made(head.told.get("Capture Start Time", ""))
    if begun is None:
        told_start = head.told.get("Capture Start Time", "")
        warnings.append(f"the capture start {told_start!r:.40} tells no certain moment")
    scale = LENGTH_mm[head.told["Length Units"].lower()]
    streams = unlike(
        Stream(triple.title, Quantity.MARKER, CLOCK, t_s[keep], table[keep][:, triple.at], scale)
        for triple in head.triples
    )
    form = f"motive-{head.told['Format Version']}"
    return Reading(form, streams, (), warnings, begun or "", head.told.get("Take Name", ""))


def _told(head: Head) -> list[str]:
    """Say what is not read."""
    version = head.told["Format Version"]
    warnings = [] if version in KNOWN else [f"format version {version} is not known; read like {KNOWN[-1]}"]
    left_out = {what: count for what, count in head.left_out.items() if what != "timecode"}
    if left_out:
        listed = ", ".join(f"{count} of {what}" for what, count in left_out.items())
        warnings.append(f"columns left out: {listed}")
    return warnings


def _table(head: Head, lines: Sequence[str]) -> tuple[FloatArray, list[str]]:
    """Read the numbers, blanks and faults as NaN; rows without a frame and a time are left out."""
    body = [line for line in lines[head.first_row :] if line.strip(", \t")]
    timecode = "timecode" in head.left_out
    table = _fast(body, head.columns, timecode)
    if table is not None:
        return table, []
    rows, bad, short = [], 0, 0
    for line in body:
        found = cells(line, ",")[: head.columns]
        values = [number(cell) for cell in found]
        bad += sum(np.isnan(v) and bool(c.strip()) for v, c in zip(values, found, strict=True))
        bad -= timecode and len(found) > 2 and bool(found[2].strip())
        short += len(found) < head.columns
        if len(found) == head.columns and not np.isnan(values[:2]).any():
            rows.append(values)
    table = np.array(rows, dtype=np.float64).reshape(len(rows), head.columns)
    warnings = [f"{counted(bad, 'cell')} of no usable number read as gaps"] if bad else []
    warnings += [f"{counted(short, 'row')} cut short left out"] if short else []
    lost = len(body) - short - len(rows)
    warnings += [f"{counted(lost, 'row')} without a frame number and a time left out"] if lost else []
    return table, warnings


def _fast(body: Sequence[str], columns: int, timecode: bool) -> FloatArray | None:
    """Read rows that are whole and hold numbers and blanks only, else None."""
    text = ",".join(body)
    found = text.split(",")
    if len(found) != columns * len(body) or "_" in text:
        return None
    if timecode:
        found[2::columns] = [""] * len(body)
    try:
        values: npt.NDArray[Any] = np.array([float(cell) if cell else np.nan for cell in found])
    except ValueError:
        return None
    table: FloatArray = values.reshape(len(body), columns)
    fine = np.isfinite(table[:, :2]).all() and not np.isinf(table).any()
    # rows of other lengths may add up to the same number of cells
    return table if fine and all(line.count(",") == columns - 1 for line in body) else None


def _times(head: Head, frame: FloatArray, printed_s: FloatArray) -> tuple[FloatArray, list[str]]:
    rate = head.rate_Hz()
    if rate is None:
        return printed_s, ["the head tells no frame rate; the times are those printed"]
    counted_s = frame / rate
    offset_s = 0.0 if abs(printed_s[0] - counted_s[0]) <= ROUNDED_s else printed_s[0] - counted_s[0]
    if np.max(np.abs(printed_s - counted_s - offset_s)) <= min(ROUNDED_s, 0.45 / rate):
        return counted_s + offset_s, []
    steps = np.diff(printed_s)
    found = 1 / np.median(steps) if steps.size and np.median(steps) > 0 else np.nan
    told = f"the head tells {rate:g} frames a second, the times {found:.4g}; the times are those printed"
    return printed_s, [told]


def _frames(head: Head, frame: FloatArray) -> list[str]:
    """Tell of frames that are missing."""
    missing = int(np.sum(np.maximum(np.diff(frame) - 1, 0)))
    warnings = [f"{counted(missing, 'frame')} missing in between"] if missing else []
    told = head.told.get("Total Exported Frames", "")
    if told.isdigit() and int(told) != frame.size:
        warnings.append(f"the head tells of {counted(int(told), 'frame')}, {frame.size} are there")
    return warnings

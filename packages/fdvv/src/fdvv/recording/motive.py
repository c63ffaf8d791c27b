"""Exports of OptiTrack's Motive as CSV, versions 1.21 to 1.25."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from fdvv.io.text import cells
from fdvv.recording.reading import Reading, counted, counted_warning, number, refusal, rising, unlike
from fdvv.recording.types import Quantity, Stream
from fdvv.units import FloatArray

CLOCK = "camera"
KNOWN = ("1.21", "1.22", "1.23", "1.24", "1.25")
LENGTH_mm = {"meters": 1000.0, "centimeters": 10.0, "millimeters": 1.0, "inches": 25.4}
SEEN = ("marker", "labeled marker", "unlabeled marker")
LABELS = ("type", "name", "id", "parent")
EXPORT = "export it again from Motive, with header information and the markers"
ROUNDED_s = 0.00055
"""Times are printed to a millisecond at some rates, to a microsecond at others."""
_AXES = re.compile(r"\s*frame\s*,\s*time", re.IGNORECASE)
_BEFORE_NOON = {"am", "a.m.", "de."}
_AFTER_NOON = {"pm", "p.m.", "du."}
"""Halves of the day as English and Hungarian Windows write them."""


@dataclass(frozen=True)
class Triple:
    """The columns X, Y, Z of one place, as their head names it."""

    kind: str
    name: str
    at: tuple[int, int, int]

    @property
    def title(self) -> str:
        """Return the stream's name; one that Motive computed from a body says so."""
        return self.name if self.kind.lower() in SEEN else f"{self.name} ({self.kind.lower()})"


@dataclass(frozen=True)
class MotiveHead:
    """The lines above the numbers.

    Attributes
    ----------
    pairs : keys and values of the first line.
    triples : positions, in the order of their columns.
    left_out : components that are no position, each with the number of its columns.
    columns : how many a whole row has.
    first_row : index of the first line of numbers.
    """

    pairs: Mapping[str, str]
    triples: Sequence[Triple]
    left_out: Mapping[str, int]
    columns: int
    first_row: int

    def rate_Hz(self) -> float | None:
        """Return the rate of the rows; None if the head holds no usable one."""
        rates = (number(self.pairs.get(key, "")) for key in ("Export Frame Rate", "Capture Frame Rate"))
        return next((rate for rate in rates if 0 < rate < 1e6), None)


def is_motive(head: Sequence[str]) -> bool:
    return bool(re.match(r'"?Format Version"?,', head[0]))


def read_head(source: object, lines: Sequence[str]) -> MotiveHead:
    """Read the head. InputError where it names no position or no unit."""
    first = cells(lines[0], ",")
    pairs = {key.strip(): value.strip() for key, value in zip(first[::2], first[1::2], strict=False)}
    _check(source, pairs)
    at = next((i for i, line in enumerate(lines[1:30], 1) if _AXES.match(line)), None)
    if at is None:
        raise refusal(source, "line 1 to 30", "no line begins with Frame,Time", EXPORT)
    axes = [cell.strip().upper() for cell in cells(lines[at], ",")]
    kinds, names, components = _rows([cells(line, ",") for line in lines[1:at] if line.strip()], len(axes))
    triples = _triples(kinds, names, components, axes)
    if not triples:
        raise refusal(source, f"line {at + 1}", "it holds frames and times but no marker", EXPORT)
    taken = {column for triple in triples for column in triple.at}
    left_out = Counter(
        components[column].strip().lower() or axes[column].lower() or "nameless"
        for column in range(2, len(axes))
        if column not in taken
    )
    return MotiveHead(pairs, triples, left_out, len(axes), at + 1)


def _check(source: object, pairs: Mapping[str, str]) -> None:
    version = pairs.get("Format Version", "")
    if not re.fullmatch(r"1\.2\d?", version):
        reason = f"format version {version!r:.20}, versions {KNOWN[0]} to {KNOWN[-1]} are read"
        raise refusal(source, "line 1", reason, "export it again from Motive 1.9 or newer")
    unit = pairs.get("Length Units", "")
    if unit.lower() not in LENGTH_mm:
        reason = f"Length Units is {unit!r:.20}, one of {', '.join(LENGTH_mm)} is read"
        raise refusal(source, "line 1", reason, EXPORT)


def _rows(rows: list[list[str]], width: int) -> tuple[list[str], list[str], list[str]]:
    """Return kinds, names and components per column; version 1.21 does not say which row is which."""
    rows = [row + [""] * (width - len(row)) for row in rows]
    labelled = {row[1].strip().lower(): row for row in rows}
    blank = [""] * width
    bare = [row for row in rows if row[1].strip().lower() not in LABELS]
    components = bare.pop() if bare else blank
    kinds, names, *_ = [*bare, blank, blank]
    return labelled.get("type", kinds), labelled.get("name", names), components


def _triples(kinds: list[str], names: list[str], components: list[str], axes: list[str]) -> list[Triple]:
    found, column = [], 2
    while column + 2 < len(axes):
        same = len({(kinds[i], names[i]) for i in range(column, column + 3)}) == 1
        places = all(components[i].strip().lower() == "position" for i in range(column, column + 3))
        if same and places and axes[column : column + 3] == ["X", "Y", "Z"]:
            kind, name = kinds[column].strip() or "Marker", names[column].strip().strip('"')
            found.append(Triple(kind, name or f"column {column + 1}", (column, column + 1, column + 2)))
            column += 3
        else:
            column += 1
    return found


def made(printed: str) -> str | None:
    """Read "2023-11-28 10.27.58.765 DU." as ISO 8601 without a zone; None if it is no moment.

    Hours are those of a twelve-hour clock, so one without AM or PM is ambiguous before 13.
    """
    match = re.match(r"(\d{4}-\d\d-\d\d) (\d\d)\.(\d\d)\.(\d\d)\.(\d{3})\s*(\S*)", printed)
    if match is None:
        return None
    hour, half = int(match[2]), match[6].lower()
    if half in _BEFORE_NOON | _AFTER_NOON:
        hour = hour % 12 + 12 * (half in _AFTER_NOON)
    elif 0 < hour < 13:
        return None
    text = f"{match[1]}T{hour:02}:{match[3]}:{match[4]}.{match[5]}"
    with suppress(ValueError):
        datetime.fromisoformat(text)
        return text
    return None


def read_motive(source: Path, lines: Sequence[str]) -> Reading:
    """Read each place as a marker in the unit of the file; a blank cell, where nothing was seen, is NaN.

    Times are those of the frame counter at the export's frame rate where the printed ones agree to within
    their rounding, else the printed ones. Raises InputError.
    """
    head = read_head(source, lines)
    warnings = _unread(head)
    table, notes = _table(head, lines)
    warnings += notes
    if not table.shape[0]:
        raise refusal(source, f"line {head.first_row + 1}", "it holds no frame", EXPORT)
    t_s, notes = _times(head, table[:, 0], table[:, 1])
    keep = rising(t_s)
    warnings += notes + counted_warning(int((~keep).sum()), "frame", "left out: the times do not rise")
    warnings += _frames(head, table[:, 0])
    start = head.pairs.get("Capture Start Time", "")
    started = made(start)
    if started is None:
        warnings.append(f"the capture start {start!r:.40} tells no certain moment")
    scale = LENGTH_mm[head.pairs["Length Units"].lower()]
    streams = unlike(
        Stream(triple.title, Quantity.MARKER, CLOCK, t_s[keep], table[keep][:, triple.at], scale)
        for triple in head.triples
    )
    form = f"motive-{head.pairs['Format Version']}"
    return Reading(form, streams, (), warnings, started or "", head.pairs.get("Take Name", ""))


def _unread(head: MotiveHead) -> list[str]:
    version = head.pairs["Format Version"]
    warnings = [] if version in KNOWN else [f"format version {version} is not known; read like {KNOWN[-1]}"]
    left_out = {what: count for what, count in head.left_out.items() if what != "timecode"}
    if left_out:
        listed = ", ".join(f"{count} of {what}" for what, count in left_out.items())
        warnings.append(f"columns left out: {listed}")
    return warnings


def _table(head: MotiveHead, lines: Sequence[str]) -> tuple[FloatArray, list[str]]:
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
    warnings = counted_warning(bad, "cell", "of no usable number read as gaps")
    warnings += counted_warning(short, "row", "cut short left out")
    lost = len(body) - short - len(rows)
    return table, warnings + counted_warning(lost, "row", "without a frame number and a time left out")


def _fast(body: Sequence[str], columns: int, timecode: bool) -> FloatArray | None:
    """Parse the rows at once; None unless all hold numbers and blanks only."""
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


def _times(head: MotiveHead, frame: FloatArray, printed_s: FloatArray) -> tuple[FloatArray, list[str]]:
    rate = head.rate_Hz()
    if rate is None:
        return printed_s, ["the head tells no frame rate; the times are those printed"]
    counted_s = frame / rate
    offset_s = 0.0 if abs(printed_s[0] - counted_s[0]) <= ROUNDED_s else printed_s[0] - counted_s[0]
    if np.max(np.abs(printed_s - counted_s - offset_s)) <= min(ROUNDED_s, 0.45 / rate):
        return counted_s + offset_s, []
    steps = np.diff(printed_s)
    found = 1 / np.median(steps) if steps.size and np.median(steps) > 0 else np.nan
    warning = f"the head tells {rate:g} frames a second, the times {found:.4g}; the times are those printed"
    return printed_s, [warning]


def _frames(head: MotiveHead, frame: FloatArray) -> list[str]:
    warnings = counted_warning(int(np.sum(np.maximum(np.diff(frame) - 1, 0))), "frame", "missing in between")
    stated = head.pairs.get("Total Exported Frames", "")
    if stated.isdigit() and int(stated) != frame.size:
        warnings.append(f"the head tells of {counted(int(stated), 'frame')}, {frame.size} are there")
    return warnings

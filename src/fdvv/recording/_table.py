"""Tables with a time column and named columns with units, separated by comma, semicolon, tab or blanks."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from fdvv.recording._reading import Reading, counted, number, refusal, rising, unlike
from fdvv.recording._titles import Title, read_title, time_scale_s
from fdvv.recording._types import Quantity, Stream
from fdvv.text import cells, sniff_separator
from fdvv.units import FloatArray

CLOCK = "table"
NAME_THEM = "name them with their units, as in time_s,force_cN,displacement_mm"


def find_header(head: Sequence[str]) -> int | None:
    """Find the first line that names a time and something measured; None if there is none."""
    for at, line in enumerate(head):
        titles = cells(line, sniff_separator(line))
        timed = sum(time_scale_s(title) is not None for title in titles)
        if timed and any(read_title(title) for title in titles):
            return at
    return None


def read_table(source: Path, lines: Sequence[str]) -> Reading:
    """Read each named column as a stream, three x, y, z of one name as a marker; blank cells are NaN.

    Raises InputError.
    """
    at = find_header(lines[:60])
    if at is None:
        raise refusal(source, "line 1", "no header names a time and what was measured", NAME_THEM)
    separator = sniff_separator(lines[at])
    titles = cells(lines[at], separator)
    table = _numbers(lines[at + 1 :], separator, len(titles))
    clock = next(i for i, title in enumerate(titles) if time_scale_s(title) is not None)
    t_s = (time_scale_s(titles[clock]) or 1.0) * table[:, clock]
    keep = rising(t_s)
    if keep.sum() < 2:
        raise refusal(source, f"line {at + 2}", "it holds no two rows with rising times", NAME_THEM)
    dropped = int(keep.size - keep.sum())
    warnings = [f"{counted(dropped, 'row')} left out: no time, or one that does not rise"] if dropped else []
    found = {i: read_title(title) for i, title in enumerate(titles) if i != clock}
    unread = [repr(titles[i][:30]) for i, title in found.items() if title is None and titles[i].strip()]
    if unread:
        warnings.append(f"columns left out, for they name no quantity and unit: {', '.join(unread[:6])}")
    named = {i: title for i, title in found.items() if title is not None}
    warnings += [
        f"column {titles[i].strip()[:30]!r} has no unit; its numbers are kept as counts"
        for i, title in named.items()
        if not title.unit_is_known
    ]
    return Reading("table", unlike(_streams(named, t_s[keep], table[keep])), (), warnings)


def _streams(named: dict[int, Title], t_s: FloatArray, table: FloatArray) -> list[Stream]:
    found = []
    for i, title in named.items():
        if not title.axis:
            found.append(Stream(title.name, title.quantity, CLOCK, t_s, table[:, i], title.scale))
        elif title.axis == "x":
            found.append(_marker(named, title, t_s, table, i))
    met = {stream.name for stream in found}
    # an axis that has no x beside it is a displacement of its own
    for i, title in named.items():
        if title.axis and title.name not in met:
            name = f"{title.name}_{title.axis}"
            found.append(Stream(name, Quantity.DISPLACEMENT, CLOCK, t_s, table[:, i], title.scale))
    return found


def _marker(named: dict[int, Title], x: Title, t_s: FloatArray, table: FloatArray, at: int) -> Stream:
    """Join the three axes of a marker; those of other units are brought to that of x."""
    columns = [table[:, at]]
    for axis in "yz":
        same = [(i, t) for i, t in named.items() if (t.name, t.axis) == (x.name, axis)]
        nothing = np.full(t_s.size, np.nan)
        columns.append(table[:, same[0][0]] * (same[0][1].scale / x.scale) if same else nothing)
    return Stream(x.name, Quantity.MARKER, CLOCK, t_s, np.column_stack(columns), x.scale)


def _numbers(body: Sequence[str], separator: str, columns: int) -> FloatArray:
    """Read rows of numbers; what is blank, missing or none is NaN."""
    rows = [cells(line, separator)[:columns] for line in body if line.strip()]
    if separator != ",":
        rows = [[cell.replace(",", ".") for cell in row] for row in rows]
    whole = [row + [""] * (columns - len(row)) for row in rows]
    return np.array([[number(cell) for cell in row] for row in whole], dtype=np.float64).reshape(-1, columns)

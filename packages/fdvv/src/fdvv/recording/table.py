"""Tables with a time column and named columns with units, separated by comma, semicolon, tab or blanks."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fdvv.io.text import cells, sniff_separator
from fdvv.recording.reading import Reading, counted, counted_warning, number, refusal, rising, unlike
from fdvv.recording.types import Quantity, Stream
from fdvv.units import FloatArray, GRAM_FORCE_cN

UNITS = {
    "cN": (Quantity.FORCE, 1.0),
    "mN": (Quantity.FORCE, 0.1),
    "N": (Quantity.FORCE, 100.0),
    "gf": (Quantity.FORCE, GRAM_FORCE_cN),
    "mm": (Quantity.DISPLACEMENT, 1.0),
    "um": (Quantity.DISPLACEMENT, 1e-3),
    "cm": (Quantity.DISPLACEMENT, 10.0),
    "m": (Quantity.DISPLACEMENT, 1000.0),
    "V": (Quantity.SOUND, 1.0),
    "mV": (Quantity.SOUND, 1e-3),
    "m_s2": (Quantity.ACCELERATION, 1.0),
    "count": (Quantity.COUNTS, 1.0),
    "counts": (Quantity.COUNTS, 1.0),
}
"""Units as they end a name, each with the factor to the unit of its quantity."""
CLOCK, COUNTS_CLOCK = "table", "converter"
NAME_THEM = "name them with their units, as in time_s,force_cN,displacement_mm"
TIME_s = {"s": 1.0, "ms": 1e-3, "us": 1e-6}
MOST_COLUMNS = 8
MOST_BAD = 0.1
"""Of a log of numbers so large a part of the lines may hold none."""

PLAIN = {
    "light": Quantity.LIGHT,
    "led": Quantity.LIGHT,
    "contact": Quantity.CONTACT,
    "closed": Quantity.CONTACT,
    "force": Quantity.COUNTS,
    "displacement": Quantity.COUNTS,
    "position": Quantity.COUNTS,
    "sound": Quantity.COUNTS,
    "adc": Quantity.COUNTS,
}
"""Names that are read without a unit; what they measure is then known only where it has none."""
_TIME = re.compile(r"(?:time|t|timestamp)_(s|ms|us)\Z", re.IGNORECASE)
_AXIS = re.compile(r"(.+)_([xyz])\Z", re.IGNORECASE)
_RATE = re.compile(r"(?:^|[_\-. ])(\d+(?:\.\d+)?)(k|K|)(?:(?<=[kK])|Hz)(?:Hz|sps|SPS)?(?=[_\-. ]|$)")
_BITS = re.compile(r"(?:^|[_\-. ])(\d{1,2})b(?:it|its)?(?=[_\-. ]|$)")
_NUMBERS = re.compile(r"[-+\d.eE,; \t]+\Z", re.ASCII)


@dataclass(frozen=True)
class Title:
    """What a name says; axis is x, y or z of a marker, empty for all else."""

    name: str
    quantity: Quantity
    scale: float
    axis: str = ""
    unit_is_known: bool = True


def time_scale_s(title: str) -> float | None:
    """Return the factor to seconds if this names a time."""
    match = _TIME.match(_plain(title))
    return TIME_s[match[1].lower()] if match else None


def read_title(title: str) -> Title | None:
    """Read a name such as force_cN, left_x_mm, "force (gf)" or contact; None if it says no quantity."""
    text = _plain(title)
    for unit in sorted(UNITS, key=len, reverse=True):
        name = text.removesuffix(f"_{unit}")
        if name != text and name:
            quantity, scale = UNITS[unit]
            axis = _AXIS.match(name)
            if axis and quantity is Quantity.DISPLACEMENT:
                return Title(axis[1], Quantity.MARKER, scale, axis[2].lower())
            return Title(name, quantity, scale)
    meant = PLAIN.get(text.lower())
    return None if meant is None else Title(text, meant, 1.0, unit_is_known=meant is not Quantity.COUNTS)


def _plain(title: str) -> str:
    text = title.strip().strip('"').replace("\N{MICRO SIGN}", "u").replace("\N{GREEK SMALL LETTER MU}", "u")
    return re.sub(r"[\s_]+", "_", re.sub(r"[()\[\]]", " ", text).strip()).replace("m/s2", "m_s2")


def find_header(head: Sequence[str]) -> int | None:
    """Find the first line that names a time and something measured; None if there is none."""
    for at, line in enumerate(head):
        titles = cells(line, sniff_separator(line))
        if any(map(time_scale_s, titles)) and any(map(read_title, titles)):
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
    warnings = counted_warning(int((~keep).sum()), "row", "left out: no time, or one that does not rise")
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
    columns = [table[:, at]]
    for axis in "yz":
        same = (
            table[:, i] * (t.scale / x.scale) for i, t in named.items() if (t.name, t.axis) == (x.name, axis)
        )
        columns.append(next(same, np.full(t_s.size, np.nan)))
    return Stream(x.name, Quantity.MARKER, CLOCK, t_s, np.column_stack(columns), x.scale)


def _numbers(body: Sequence[str], separator: str, columns: int) -> FloatArray:
    """Read rows of numbers; blanks, missing cells and text are NaN."""
    rows = [cells(line, separator)[:columns] for line in body if line.strip()]
    if separator != ",":
        rows = [[cell.replace(",", ".") for cell in row] for row in rows]
    whole = [row + [""] * (columns - len(row)) for row in rows]
    return np.array([[number(cell) for cell in row] for row in whole], dtype=np.float64).reshape(-1, columns)


def is_counts(head: Sequence[str]) -> bool:
    """Recognise such a log by lines of numbers only, equally many on each."""
    rows = [_cells(line) for line in head if _NUMBERS.match(line)]
    widths = {len(row) for row in rows}
    good = all(not np.isnan(number(cell)) for row in rows for cell in row)
    most = len(rows) >= 0.9 * len(head) and _NUMBERS.match(head[0]) is not None
    return most and good and len(widths) == 1 and max(widths) <= MOST_COLUMNS


def _cells(line: str) -> list[str]:
    return [cell for cell in re.split(r"[,;\s]+", line.strip()) if cell]


def rate_and_bits(name: str) -> tuple[float | None, int | None]:
    """Return rate (Hz) and bits of a name as hammer_2K_24b_fast; None for what it lacks."""
    rate, bits = _RATE.search(name), _BITS.search(name)
    found_Hz = float(rate[1]) * (1000 if rate[2] else 1) if rate else None
    return found_Hz or None, int(bits[1]) if bits else None


def read_counts(source: Path, lines: Sequence[str], rate_Hz: float | None) -> Reading:
    """Read each column as counts of a converter; a line that is no number is a gap, so that time goes on.

    rate_Hz : if it is given, that of the name does not count. Raises InputError.
    """
    named_Hz, bits = rate_and_bits(source.stem)
    rate = rate_Hz or named_Hz
    if rate is None:
        reason = "numbers alone, and neither file nor name tells their rate"
        raise refusal(source, "whole file", reason, "give rate_Hz, or name the file as in key_2kHz.txt")
    values = _values(source, lines)
    warnings = ["the numbers are counts of a converter whose scale nobody stated"]
    if rate_Hz is None:
        warnings.append(f"the rate of {rate:g} Hz is that of the file's name")
    warnings += counted_warning(int(np.isnan(values).any(axis=1).sum()), "line", "of no number read as gaps")
    most = np.nanmax(np.abs(values))
    if bits and most >= 2**bits:
        warnings.append(f"the name tells of {bits} bits, but the numbers reach {most:.0f}")
    t_s = np.arange(values.shape[0]) / rate
    several = values.shape[1] > 1
    streams = [
        Stream(f"counts {i}" if several else "counts", Quantity.COUNTS, COUNTS_CLOCK, t_s, _whole(column))
        for i, column in enumerate(values.T, 1)
    ]
    return Reading("counts", streams, (), warnings)


def _values(source: Path, lines: Sequence[str]) -> FloatArray:
    """Read the numbers, a line without one as NaN. InputError if there are too many such lines."""
    rows = [_cells(line) for line in lines]
    while rows and not rows[-1]:
        rows.pop()
    width = max((len(row) for row in rows[:60]), default=0)
    if not width:
        raise refusal(source, "whole file", "it holds no number")
    gap = [np.nan] * width
    values = np.array([[number(c) for c in row] if len(row) == width else gap for row in rows])
    bad = int(np.isnan(values).any(axis=1).sum())
    if bad > MOST_BAD * len(rows):
        raise refusal(source, "whole file", f"{bad} of {counted(len(rows), 'line')} hold no number")
    return values


def _whole(column: FloatArray) -> np.ndarray[tuple[int], np.dtype[np.int32]] | FloatArray:
    if np.isfinite(column).all() and (column == np.round(column)).all() and np.abs(column).max() < 2**31:
        return column.astype(np.int32)
    return np.ascontiguousarray(column)

"""Logs of a converter: numbers alone, one line per sample, the rate in the name of the file."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from fdvv.recording._reading import Reading, counted, number, refusal
from fdvv.recording._types import Quantity, Stream
from fdvv.units import FloatArray

CLOCK = "converter"
MOST_COLUMNS = 8
MOST_BAD = 0.1
_RATE = re.compile(r"(?:^|[_\-. ])(\d+(?:\.\d+)?)(k|K|)(?:(?<=[kK])|Hz)(?:Hz|sps|SPS)?(?=[_\-. ]|$)")
_BITS = re.compile(r"(?:^|[_\-. ])(\d{1,2})b(?:it|its)?(?=[_\-. ]|$)")
_NUMBERS = re.compile(r"[-+\d.eE,; \t]+\Z", re.ASCII)


def is_counts(head: Sequence[str]) -> bool:
    """Tell such a log by lines of numbers only, equally many on each."""
    rows = [_cells(line) for line in head if _NUMBERS.match(line)]
    widths = {len(row) for row in rows}
    good = all(not np.isnan(number(cell)) for row in rows for cell in row)
    most = len(rows) >= 0.9 * len(head) and _NUMBERS.match(head[0]) is not None
    return most and good and len(widths) == 1 and max(widths) <= MOST_COLUMNS


def _cells(line: str) -> list[str]:
    return [cell for cell in re.split(r"[,;\s]+", line.strip()) if cell]


def name_tells(name: str) -> tuple[float | None, int | None]:
    """Give rate (Hz) and bits as in hammer_2K_24b_fast; None for what it does not tell."""
    rate, bits = _RATE.search(name), _BITS.search(name)
    told = float(rate[1]) * (1000 if rate[2] else 1) if rate else None
    return told or None, int(bits[1]) if bits else None


def read_counts(source: Path, lines: Sequence[str], rate_Hz: float | None) -> Reading:
    """Read each column as counts of a converter; a line that is no number is a gap, so that time goes on.

    rate_Hz : if it is given, that of the name does not count. Raises InputError.
    """
    told_Hz, bits = name_tells(source.stem)
    rate = rate_Hz or told_Hz
    if rate is None:
        reason = "numbers alone, and neither file nor name tells their rate"
        raise refusal(source, "whole file", reason, "give rate_Hz, or name the file as in key_2kHz.txt")
    values = _values(source, lines)
    warnings = ["the numbers are counts of a converter whose scale nobody stated"]
    if rate_Hz is None:
        warnings.append(f"the rate of {rate:g} Hz is that of the file's name")
    bad = int(np.isnan(values).any(axis=1).sum())
    if bad:
        warnings.append(f"{counted(bad, 'line')} of no number read as gaps")
    most = np.nanmax(np.abs(values))
    if bits and most >= 2**bits:
        warnings.append(f"the name tells of {bits} bits, but the numbers reach {most:.0f}")
    t_s = np.arange(values.shape[0]) / rate
    columns = values.T
    names = ["counts"] if len(columns) == 1 else [f"counts {i + 1}" for i in range(len(columns))]
    streams = [
        Stream(name, Quantity.COUNTS, CLOCK, t_s, _whole(column))
        for name, column in zip(names, columns, strict=True)
    ]
    return Reading("counts", streams, (), warnings)


def _values(source: Path, lines: Sequence[str]) -> FloatArray:
    """Read the numbers, a line that holds no number as NaN. InputError if that are too many."""
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
    """Keep whole numbers as such where they fit."""
    if np.isfinite(column).all() and (column == np.round(column)).all() and np.abs(column).max() < 2**31:
        return column.astype(np.int32)
    return np.ascontiguousarray(column)

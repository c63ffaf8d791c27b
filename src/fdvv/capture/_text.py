"""From bytes to lines, and from lines to numbers: fast when all is well, careful when not."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fdvv.capture._record import Notes
from fdvv.errors import InputError
from fdvv.text import cells, decode_lines
from fdvv.units import FloatArray

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d{1,3})?\Z", re.ASCII)
LARGEST = 1e12
"""No column of a bench holds more, in any unit; what is larger is a fault and would overflow."""
LEAST_SAMPLES = 4
"""Fewer samples than coefficients of a cubic are not a curve."""


REMEDY = "give a file of force and displacement"


def decode(source: Path, content: bytes, notes: Notes) -> list[str]:
    """Decode a text file into lines, as decode_lines tells; what was repaired goes to notes. InputError."""
    lines, warnings = decode_lines(source, content, REMEDY)
    for warning in warnings:
        notes.say(warning)
    return lines


def refusal(source: object, place: str, reason: str, remedy: str = "") -> InputError:
    """Make the error for a file that cannot be used."""
    return InputError(source, place, reason, remedy or REMEDY)


@dataclass(frozen=True)
class Table:
    """Cells of a file below its header; ``first_line`` is the line number of rows[0], from 1."""

    source: Path
    rows: list[list[str]]
    first_line: int
    decimal_comma: bool = False

    def columns(self, picks: Sequence[int], notes: Notes, what: str = "") -> list[FloatArray]:
        """Read columns as numbers, one array per pick, all of one length.

        Rows blank in every pick are padding. Rows in which a pick is no usable number (finite,
        below 1e12) are left out and told in notes. Raises InputError if fewer than half of the
        rows, or than four, remain.
        """
        rows = self.rows[: _used_length(self.rows, picks)]
        fast = None if self.decimal_comma else _all_numbers(rows, picks)
        if fast is not None:
            return self._enough(fast, len(rows), what)
        kept: list[list[float]] = []
        bad: list[tuple[int, int, str]] = []
        for offset, row in enumerate(rows):
            texts = [row[i].strip() if i < len(row) else "" for i in picks]
            if not any(texts):
                continue
            numbers = [self._number(text) for text in texts]
            wrong = [i for i, number in enumerate(numbers) if number is None]
            if wrong:
                bad.append((self.first_line + offset, picks[wrong[0]] + 1, texts[wrong[0]]))
            else:
                kept.append([number for number in numbers if number is not None])
        array = np.array(kept, dtype=np.float64).reshape(len(kept), len(picks))
        if bad:
            line, column, text = bad[0]
            told = f"line {line}, column {column}: {_short(text)} is no usable number"
            rest = "the row was" if len(bad) == 1 else f"{len(bad)} such rows of {len(kept) + len(bad)} were"
            notes.say(f"{told}; {rest} left out")
        return self._enough(list(array.T), len(kept) + len(bad), what)

    def _number(self, text: str) -> float | None:
        text = text.replace(",", ".") if self.decimal_comma else text
        if not _NUMBER.match(text):
            return None
        number = float(text)
        return number if abs(number) <= LARGEST else None

    def _enough(self, columns: list[FloatArray], of: int, what: str) -> list[FloatArray]:
        count = columns[0].size
        if count < max(LEAST_SAMPLES, 0.5 * of):
            place = f"from line {self.first_line}" + (f", {what}" if what else "")
            raise refusal(self.source, place, f"only {count} of {of} rows hold numbers")
        return columns


def _used_length(rows: list[list[str]], picks: Sequence[int]) -> int:
    """Count the rows up to the last one with anything in the picked columns."""
    end = len(rows)
    while end and not any(i < len(rows[end - 1]) and rows[end - 1][i].strip() for i in picks):
        end -= 1
    return end


def _all_numbers(rows: list[list[str]], picks: Sequence[int]) -> list[FloatArray] | None:
    """Convert columns that hold usable numbers only, else None."""
    try:
        found = [[row[i] for row in rows] for i in picks]
        # float() takes 1_000 for a number; a file does not
        if any("_" in "".join(column) for column in found):
            return None
        arrays = [np.array(list(map(float, column))) for column in found]
    except (ValueError, IndexError):
        return None
    return arrays if all((np.abs(array) <= LARGEST).all() for array in arrays) else None


def _short(text: str) -> str:
    """Quote a cell so that a message stays one short line."""
    return "a blank" if not text else repr(text if len(text) <= 20 else text[:20] + "...")


def body(source: Path, lines: Sequence[str], start: int, separator: str = ",") -> Table:
    """Make the table of the lines from index start on, blank lines at the end left off."""
    end = len(lines)
    while end > start and not lines[end - 1].strip():
        end -= 1
    return Table(source, [cells(line, separator) for line in lines[start:end]], start + 1)

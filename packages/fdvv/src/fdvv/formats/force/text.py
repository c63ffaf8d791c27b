"""From bytes to lines, and from lines to numbers: fast when all is well, careful when not."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

import numpy as np

from fdvv.errors import InputError
from fdvv.formats.force.types import Notes
from fdvv.io.text import cells, decode_lines
from fdvv.model.curve import Stroke
from fdvv.units import FloatArray, GRAM_FORCE_cN

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d{1,3})?\Z", re.ASCII)

LARGEST = 1e12
"""No column of a bench holds more, in any unit; what is larger is a fault and would overflow."""
LEAST_SAMPLES = 4
"""Fewer samples than coefficients of a cubic are not a curve."""
OTHER_ratio = 0.1  # assumed; fewer are rows cut short, which are left out singly
NO_VALUE = {"nan", "inf", "-inf", "na", "n/a", "#n/a", "null", "none"}
REMEDY = "give a file of force and displacement"


def decode(source: Path, content: bytes, notes: Notes) -> list[str]:
    """Decode a text file into lines, as decode_lines does; repairs go to notes. Raises InputError."""
    lines, warnings = decode_lines(source, content, REMEDY)
    for warning in warnings:
        notes.say(warning)
    return lines


def refusal(source: object, place: str, reason: str, remedy: str = "") -> InputError:
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
        below 1e12) are left out with a note. Raises InputError if fewer than half of the
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
            wrong = [at for at, number in enumerate(numbers) if number != number]
            if wrong:
                self._check_not_header(row, self.first_line + offset)
                bad.append((self.first_line + offset, picks[wrong[0]] + 1, texts[wrong[0]]))
            else:
                kept.append(numbers)
        self._check_not_narrower(rows, picks)
        array = np.array(kept, dtype=np.float64).reshape(len(kept), len(picks))
        if bad:
            line, column, text = bad[0]
            message = f"line {line}, column {column}: {_short(text)} is no usable number"
            rest = "the row was" if len(bad) == 1 else f"{len(bad)} such rows of {len(kept) + len(bad)} were"
            notes.say(f"{message}; {rest} left out")
        return self._enough(list(array.T), len(kept) + len(bad), what)

    def _check_not_header(self, row: list[str], line: int) -> None:
        """Raise InputError at a second header: what follows may be of another button, in other units."""
        if sum(map(_is_word, row)) < 2:
            return
        named = {describe(i, title).quantity for i, title in enumerate(row)}
        if {Quantity.FORCE, Quantity.DISPLACEMENT} <= named or sum(map(_is_haata_title, row)) >= 2:
            reason = "a second header; the file holds more than one measurement"
            raise refusal(self.source, f"line {line}", reason, "split it there into files of their own")

    def _check_not_narrower(self, rows: list[list[str]], picks: Sequence[int]) -> None:
        """Raise InputError where a table of fewer columns goes on in this one."""
        short = [at for at, row in enumerate(rows) if any(row) and min(picks) < len(row) <= max(picks)]
        if len(short) > OTHER_ratio * len(rows):
            reason = f"{len(short)} rows from here on lack cells; another table may go on in this one"
            remedy = "split it there into files of their own"
            raise refusal(self.source, f"line {self.first_line + short[0]}", reason, remedy)

    def check_width(self, names: int) -> None:
        """Raise InputError where most rows hold more filled cells than there are names.

        So they do where decimal commas are also what separates the cells.
        """
        wide = sum(any(cell.strip() for cell in row[names:]) for row in self.rows)
        if wide > 0.5 * len(self.rows):
            cells = max(len(row) for row in self.rows)
            reason = f"rows hold up to {cells} cells under {names} names"
            remedy = "write decimal points, or separate cells with semicolons"
            raise refusal(self.source, f"from line {self.first_line}", reason, remedy)

    def _number(self, text: str) -> float:
        text = text.replace(",", ".") if self.decimal_comma else text
        number = float(text) if _NUMBER.match(text) else np.nan
        return number if abs(number) <= LARGEST else np.nan

    def _enough(self, columns: list[FloatArray], of: int, what: str) -> list[FloatArray]:
        count = columns[0].size
        if count < max(LEAST_SAMPLES, 0.5 * of):
            place = f"from line {self.first_line}" + (f", {what}" if what else "")
            raise refusal(self.source, place, f"only {count} of {of} rows hold numbers")
        return columns


def _is_word(cell: str) -> bool:
    return any(c.isalpha() for c in cell) and cell.strip().lower() not in NO_VALUE


def _is_haata_title(cell: str) -> bool:
    return re.fullmatch(r"(press|release) \d+, [xy]", cell.strip().lower()) is not None


def _used_length(rows: list[list[str]], picks: Sequence[int]) -> int:
    end = len(rows)
    while end and not any(i < len(rows[end - 1]) and rows[end - 1][i].strip() for i in picks):
        end -= 1
    return end


def _all_numbers(rows: list[list[str]], picks: Sequence[int]) -> list[FloatArray] | None:
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
    return "a blank" if not text else repr(text if len(text) <= 20 else text[:20] + "...")


def first_filled(lines: Sequence[str]) -> int:
    """Return the index of the first line that is not blank; 0 if all are."""
    return next((at for at, line in enumerate(lines) if line.strip()), 0)


def body(source: Path, lines: Sequence[str], start: int, separator: str = ",") -> Table:
    """Return the table of the lines from index start on, without blank lines at the end."""
    end = len(lines)
    while end > start and not lines[end - 1].strip():
        end -= 1
    return Table(source, [cells(line, separator) for line in lines[start:end]], start + 1)


class Quantity(StrEnum):
    """What a column measures."""

    DISPLACEMENT = "displacement"
    FORCE = "force"
    TIME = "time"
    CLOSED = "closed"
    OTHER = "other"


LENGTH_mm = {
    "mm": 1.0, "millimeter": 1.0, "millimeters": 1.0, "millimetre": 1.0, "millimetres": 1.0,
    "um": 1e-3, "micron": 1e-3, "microns": 1e-3, "micrometer": 1e-3, "micrometers": 1e-3,
    "micrometre": 1e-3, "micrometres": 1e-3,
    "cm": 10.0, "m": 1000.0, "meter": 1000.0, "meters": 1000.0, "metre": 1000.0, "metres": 1000.0,
    "in": 25.4, "inch": 25.4, "inches": 25.4,
}  # fmt: skip

OUNCE_FORCE_cN = 28.349523125 * GRAM_FORCE_cN

FORCE_cN = {
    "gf": GRAM_FORCE_cN, "g": GRAM_FORCE_cN, "gram": GRAM_FORCE_cN, "grams": GRAM_FORCE_cN,
    "gramforce": GRAM_FORCE_cN, "kgf": 1000 * GRAM_FORCE_cN, "kg": 1000 * GRAM_FORCE_cN,
    "n": 100.0, "newton": 100.0, "newtons": 100.0, "cn": 1.0, "mn": 0.1,
    "oz": OUNCE_FORCE_cN, "ozf": OUNCE_FORCE_cN, "lbf": 16 * OUNCE_FORCE_cN,
}  # fmt: skip

TIME_s = {
    "s": 1.0, "sec": 1.0, "seconds": 1.0, "ms": 1e-3, "millis": 1e-3, "milliseconds": 1e-3, "us": 1e-6,
}  # fmt: skip

WORDS = {
    Quantity.FORCE: {"force", "load", "f", "fz", "weight", "loadcell", "scale"},
    Quantity.DISPLACEMENT: {
        "displacement", "disp", "travel", "distance", "position", "pos", "x", "depth", "deflection",
        "stroke", "compression",
    },
    Quantity.TIME: {"time", "t", "timestamp", "millis"},
    Quantity.CLOSED: {"actuated", "closed", "contact"},
}  # fmt: skip

NOT_MEASURED = {"velocity", "speed", "acceleration", "temperature", "judge", "number", "index", "raw"}
"""Columns that carry a unit or a word of force or travel but are neither."""
UNITS = {Quantity.FORCE: FORCE_cN, Quantity.DISPLACEMENT: LENGTH_mm, Quantity.TIME: TIME_s}

STROKES = {
    Stroke.PRESS: {"press", "down", "downstroke", "loading", "pressing"},
    Stroke.RELEASE: {"release", "up", "upstroke", "unloading", "releasing"},
}

_VELOCITY = re.compile(r"(\d+(?:\.\d+)?)\s*_?mm(?:_|/|\s|\s?per\s)s(?![a-z])")


@dataclass(frozen=True)
class Column:
    """One column as its name describes it; ``scale`` takes it to mm, cN or s (None: no unit given)."""

    index: int
    title: str
    quantity: Quantity
    scale: float | None = None
    stroke: Stroke | None = None
    velocity_mm_s: float | None = None


def describe(index: int, title: str) -> Column:
    """Read one column's name; case, brackets, underscores and order of the words do not matter."""
    text = title.replace("\N{MICRO SIGN}", "u").replace("\N{GREEK SMALL LETTER MU}", "u").lower()
    speed = _VELOCITY.search(text)
    velocity = float(speed.group(1)) if speed else None
    tokens = re.findall(r"[a-z]+", _VELOCITY.sub(" ", text))
    stroke = next((stroke for stroke, names in STROKES.items() if names & set(tokens)), None)
    quantity = _quantity(tokens)
    scale = next((UNITS[quantity][t] for t in reversed(tokens) if t in UNITS.get(quantity, {})), None)
    if quantity is Quantity.CLOSED:
        scale = 1.0
    return Column(index, title.strip(), quantity, scale, stroke, velocity or None)


def _quantity(tokens: list[str]) -> Quantity:
    if NOT_MEASURED & set(tokens) or tokens == ["stroke"]:
        return Quantity.OTHER
    # the last quantity named is the one measured: "press force", "contact force"
    named = (quantity for token in reversed(tokens) for quantity, words in WORDS.items() if token in words)
    # a unit alone names a quantity, unless it is one letter that may stand for anything (n, m, s)
    units = [token for token in reversed(tokens) if len(token) > 1 and token != "in"]
    measured = (quantity for token in units for quantity, known in UNITS.items() if token in known)
    return next(named, None) or next(measured, Quantity.OTHER)


def guess_length_mm(span: float) -> float | None:
    """Guess mm, um or m by the span of a button's travel; None if no unit fits."""
    return next((scale for scale in (1.0, 1e-3, 1000.0) if 0.3 <= span * scale <= 30.0), None)

"""Cells of a table of answers as words and numbers; line and column are told of one that cannot be read."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fdvv.errors import InputError
from fdvv.workflow._study_columns import ColumnMap, coded, is_missing

YES, NO = ("1", "true", "yes", "t", "y"), ("0", "false", "no", "f", "n")


@dataclass(frozen=True)
class Cells:
    """Reads cells of a file, and names line and column where it cannot."""

    path: Path
    heads: Sequence[str]
    asked: ColumnMap
    decimal_comma: bool

    def wrong(self, line: int, place: int, reason: str, remedy: str) -> InputError:
        """Make the error that a cell cannot be used."""
        return InputError(self.path, f"line {line}, column {self.heads[place]!r}", reason, remedy)

    def number(self, line: int, row: Sequence[str], place: int | None) -> float:
        """Read a number; nan where there is none."""
        if place is None or is_missing(row[place], self.asked):
            return np.nan
        word = row[place].replace(",", ".") if self.decimal_comma else row[place]
        if word.lower() in (*YES, *NO):
            return float(word.lower() in YES)
        try:
            found = float(word)
        except ValueError:
            found = np.inf
        if not np.isfinite(found):
            remedy = "correct it, or name a word for a missing value: --missing WORD"
            raise self.wrong(line, place, f"{row[place]!r} is not a number", remedy)
        return found

    def word(self, row: Sequence[str], place: int | None) -> str:
        """Read a name; "" where there is none."""
        return "" if place is None else coded(row[place], self.asked)

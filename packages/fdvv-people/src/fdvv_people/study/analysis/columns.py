"""Which column of a table of answers is what: by the code book, by name, or as a person says."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from fdvv.errors import InputError
from fdvv.model.noticeable import DIMENSIONS
from fdvv_people.study.analysis.code_book import CodeBook, rating_column
from fdvv_people.study.plan.tasks import task_names
from fdvv_people.study.plan.trial import EQUAL

TIMING = "timing"
"""A kind of answers that no plan declares: scores in a unit of time, by button and level, for an ANOVA."""

TEXTS = ("person", "item", "choice", "excluded", "stimulus", "is_chosen")
CHANGES = tuple(f"{one}_ratio" for one in DIMENSIONS)
NUMBERS = ("round", "correct", "ratio", "time_s", "simulated", *CHANGES)
ROLES = (*TEXTS, *NUMBERS)
MISSING = frozenset({"", "na", "n/a", "nan", "null", "none", "."})
"""Words for a missing value, in any case of letters."""

YES, NO = ("1", "true", "yes", "t", "y"), ("0", "false", "no", "f", "n")


@dataclass(frozen=True)
class ColumnMap:
    """How a foreign table is read.

    Attributes
    ----------
    kind : of the study; "": as the code book says, else by the columns.
    stimuli : names, in order; of two, a preference counts for the second. (): as found.
    columns : the file's heading by role. A role is one of `ROLES`, or RATING:STIMULUS where every rendering
        has its own column, or RATING where a row is one rating (then "stimulus" is a column too, and
        "is_chosen" may say 1 where the row's stimulus was the choice).
    codes : what a word in the columns choice and stimulus means: a stimulus or "equal", by the file's word.
    missing : further words for a missing value, as "-99".
    simulated : the answers are those of simulated participants.
    """

    kind: str = ""
    stimuli: tuple[str, ...] = ()
    columns: Mapping[str, str] = field(default_factory=dict)
    codes: Mapping[str, str] = field(default_factory=dict)
    missing: frozenset[str] = frozenset()
    simulated: bool = False

    def __post_init__(self) -> None:
        kinds = (*task_names(), TIMING)
        if self.kind and self.kind not in kinds:
            raise InputError(
                "kind", repr(self.kind), "no such kind of study", f"use one of {', '.join(kinds)}"
            )


@dataclass(frozen=True)
class Layout:
    """The columns of one table.

    Attributes
    ----------
    roles : place of the column by role, without ratings. ratings : places by rating, then by stimulus; the
        stimulus is "" where a column of its own names it.
    """

    roles: Mapping[str, int]
    ratings: Mapping[str, Mapping[str, int]]

    @property
    def long(self) -> bool:
        """Whether a row is one rating of one rendering, rather than a trial."""
        return "stimulus" in self.roles


def layout_of(heads: Sequence[str], column_map: ColumnMap, book: CodeBook | None, source: object) -> Layout:
    """Find every column. InputError on one that is asked for and is not there, or that is there twice."""
    places = places_of(heads, column_map, book, source)
    roles = {role: heads.index(role) for role in ROLES if role in heads}
    ratings = _by_name(heads, column_map.stimuli)
    if book is not None:
        ratings = {}
        for name, (rating, stimulus) in book.rating_columns().items():
            ratings.setdefault(rating, {})[stimulus] = places[name]
    for role, name in column_map.columns.items():
        rating, colon, stimulus = role.partition(":")
        if not colon and role in ROLES:
            roles[role] = places[name]
        else:
            ratings.setdefault(rating, {})[stimulus] = places[name]
    return _checked(Layout(roles, ratings), heads, source)


def places_of(
    heads: Sequence[str], column_map: ColumnMap, book: CodeBook | None, source: object
) -> dict[str, int]:
    """Return the place of every column that a map or a code book names. InputError that names all absent."""
    for name in heads:
        if name and list(heads).count(name) > 1:
            raise InputError(source, "line 1", f"two columns are called {name!r}", "give each its own name")
    wanted = [*(book.rating_columns() if book else ()), *column_map.columns.values()]
    absent = [name for name in dict.fromkeys(wanted) if name not in heads]
    if absent:
        what = f"no column {absent[0]!r}" if len(absent) == 1 else f"none of {_listed(absent)}"
        details = {"absent": absent, "columns": list(heads)}
        remedy = "map another column"
        raise InputError(source, "line 1", f"there is {what} among {_listed(heads)}", remedy, details)
    return {name: heads.index(name) for name in wanted}


def _listed(names: Sequence[str]) -> str:
    return ", ".join(repr(one) for one in names)


def _by_name(heads: Sequence[str], stimuli: Sequence[str]) -> dict[str, dict[str, int]]:
    found: dict[str, dict[str, int]] = {}
    for head in heads:
        rating = head.removesuffix(f"_{stimuli[0]}") if stimuli else head
        wanted = [rating_column(rating, one) for one in stimuli]
        if rating and rating != head and all(one in heads for one in wanted):
            found[rating] = {one: heads.index(rating_column(rating, one)) for one in stimuli}
    return found


def _checked(layout: Layout, heads: Sequence[str], source: object) -> Layout:
    missing = {}
    if "person" not in layout.roles:
        missing["person"] = ("no column says who answered", "--map person=COLUMN")
    if not layout.ratings and not {"choice", "correct", "is_chosen"} & set(layout.roles):
        remedy = "--map choice=COLUMN, correct=COLUMN or RATING:STIMULUS=COLUMN"
        missing["answer"] = ("no column holds an answer", remedy)
    if missing:
        reasons, remedies = zip(*missing.values(), strict=True)
        remedy = f"say which: {' and '.join(remedies)}; there are {_listed(heads)}"
        details = {"missing": list(missing), "columns": list(heads)}
        raise InputError(source, "line 1", " and ".join(reasons), remedy, details)
    stimuli = {stimulus for places in layout.ratings.values() for stimulus in places}
    if layout.long != (stimuli == {""}) and stimuli:
        remedy = "map RATING:STIMULUS=COLUMN for each rendering, or stimulus=COLUMN and RATING=COLUMN"
        raise InputError(source, "line 1", "ratings are mapped half by column, half by row", remedy)
    return layout


def coded(word: str, column_map: ColumnMap) -> str:
    """Return what a word of the columns choice and stimulus means; "" where it says that there is nothing."""
    if word in column_map.codes:
        return column_map.codes[word]
    if is_missing(word, column_map):
        return ""
    return EQUAL if word.lower() == EQUAL else word


def is_missing(word: str, column_map: ColumnMap) -> bool:
    return word in column_map.missing or word.lower() in MISSING


@dataclass(frozen=True)
class Row:
    """One line of a file, whose cells are read by the place of their column, None where there is none.

    heads : of the columns. cells : of the line.
    """

    path: Path
    heads: Sequence[str]
    column_map: ColumnMap
    decimal_comma: bool
    line: int
    cells: Sequence[str]

    def wrong(self, place: int, reason: str, remedy: str) -> InputError:
        return InputError(self.path, f"line {self.line}, column {self.heads[place]!r}", reason, remedy)

    def number(self, place: int | None) -> float:
        """Read a number; nan where there is none."""
        if place is None or is_missing(self.cells[place], self.column_map):
            return np.nan
        word = self.cells[place].replace(",", ".") if self.decimal_comma else self.cells[place]
        if word.lower() in (*YES, *NO):
            return float(word.lower() in YES)
        try:
            found = float(word)
        except ValueError:
            found = np.inf
        if not np.isfinite(found):
            remedy = "correct it, or name a word for a missing value: --missing WORD"
            raise self.wrong(place, f"{self.cells[place]!r} is not a number", remedy)
        return found

    def word(self, place: int | None) -> str:
        """Read a name; "" where there is none."""
        return "" if place is None else coded(self.cells[place], self.column_map)

"""Scores of a validation as rows and as arrays, written and read as a plain table."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from io import StringIO
from pathlib import Path

import numpy as np

from fdvv.errors import InputError
from fdvv.io.files import read_limited
from fdvv.units import FloatArray
from fdvv_people.study.analysis.code_book import csv_text, unescaped
from fdvv_people.study.files.folder import StudyFolder
from fdvv_people.study.files.layout import UNSEALED
from fdvv_people.study.timing.plan import TimingPlan

SCORES_FILE = "scores.csv"
LARGEST_bytes = 64_000_000  # a row takes some 100 bytes: 600 trials each of 1000 people, a plan's most
REMEDY = "unseal the study again"
SIMULATED_HAND = "simulated"


@dataclass(frozen=True)
class ScoreRow:
    """One trial of a validation.

    Attributes
    ----------
    person, level, round, place : where it belongs; place: of the condition within its round, from 0.
    trial, code, condition : number, what its person saw, and what that hid.
    on : what was pressed, see `Surface`. attempts : how often it was begun. rounds : that count.
    score, error : what it scored first, and its standard error; nan where it was given up.
    lost_ratio : share of presses that missed or came too early; nan of tapping.
    strokes_Hz : of tapping, the finger's own strokes a second, see `fdvv_people.task.tapping.strokes_Hz`;
    else nan.
    gap_days : since the end of the training; nan without one. excluded : why it does not count, or empty.
    simulated : a simulated participant pressed.
    """

    person: str
    level: str
    round: int
    place: int
    trial: int
    code: str
    condition: str
    on: str
    attempts: int
    rounds: int
    score: float
    error: float
    lost_ratio: float
    strokes_Hz: float
    gap_days: float
    excluded: str
    simulated: bool

    @property
    def counts(self) -> bool:
        return not self.excluded and math.isfinite(self.score)


@dataclass(frozen=True, eq=False)
class TimingScores:
    """The validation of all people.

    Attributes
    ----------
    plan : of the study. rows : of every trial that was begun.
    """

    plan: TimingPlan
    rows: tuple[ScoreRow, ...]

    @property
    def simulated(self) -> bool:
        return any(row.simulated for row in self.rows)

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why a trial does not count, row by row; empty of one that does."""
        return tuple(row.excluded for row in self.rows)

    @property
    def conditions(self) -> tuple[str, ...]:
        return tuple(one.name for one in self.plan.conditions)

    @property
    def people(self) -> tuple[str, ...]:
        """Everybody with a row, sorted."""
        return tuple(sorted({row.person for row in self.rows}))

    @property
    def complete(self) -> tuple[str, ...]:
        """The people who lack no score: those that an analysis of variance can count."""
        each = len(self.conditions) * len(self.plan.all_levels) * self.plan.rounds
        counted = [row.person for row in self.rows if row.counts]
        return tuple(name for name in self.people if counted.count(name) == each)

    def array(self, people: Sequence[str]) -> FloatArray:
        """Return scores as (people, conditions, levels, rounds), nan where one is missing."""
        plan, levels = self.plan, self.plan.all_levels
        found = np.full((len(people), len(self.conditions), len(levels), plan.rounds), np.nan)
        at = {name: i for i, name in enumerate(people)}
        for row in self.rows:
            if row.counts and row.person in at:
                condition = self.conditions.index(row.condition)
                found[at[row.person], condition, levels.index(row.level), row.round] = row.score
        return found


def scores_text(rows: Sequence[ScoreRow]) -> str:
    """Return rows as the text of scores.csv."""
    heads = [one.name for one in fields(ScoreRow)]
    return csv_text(heads, ([_cell(value) for value in asdict(row).values()] for row in rows))


def _cell(value: object) -> object:
    if isinstance(value, bool):
        return int(value)
    if isinstance(value, float):
        return "" if math.isnan(value) else f"{value:.6g}"
    return value


def unsealed_scores(study: StudyFolder) -> TimingScores:
    """Return what was unsealed of a timing study. InputError where nothing was."""
    path = study.folder / UNSEALED / SCORES_FILE
    if not path.is_file():
        raise InputError(
            study.folder, "study", "is not unsealed", f"unseal it: fdvv study unseal {study.folder}"
        )
    return read_scores(path, study.plan)


def read_scores(path: Path, plan: TimingPlan) -> TimingScores:
    """Read scores.csv. InputError on another file."""
    text = read_limited(path, LARGEST_bytes, REMEDY).decode(errors="replace")
    rows = csv.DictReader(StringIO(text))
    try:
        return TimingScores(plan, tuple(_row(cells) for cells in rows))
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(path, f"line {rows.line_num}", f"is no row of scores ({error})", REMEDY) from error


def _row(cells: dict[str, str]) -> ScoreRow:
    types = {one.name: str(one.type) for one in fields(ScoreRow)}
    read = {"str": unescaped, "int": int, "bool": lambda cell: cell == "1", "float": _number}
    return ScoreRow(**{name: read[kind](cells[name]) for name, kind in types.items()})  # type: ignore[operator]


def _number(cell: str) -> float:
    return float(cell) if cell else math.nan

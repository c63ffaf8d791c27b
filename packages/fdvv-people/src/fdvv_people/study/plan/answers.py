"""Unsealed or foreign answers as columns: what every analysis begins with."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.study.plan.plan import Exclusion
from fdvv_people.study.plan.tasks import task_behind

REFERENCE_SHARE = 0.15
"""Part of the trials in which the hidden reference may be rated too low (ITU-R BS.1534-3, 4.1.2)."""

WIDE_SCALE = 20.0
"""A rating above this implies a scale to 100; the rule on the hidden reference needs one."""


@dataclass(frozen=True, eq=False)
class Answers:
    """A row for every trial that was planned; what a person did not do is missing, not left out.

    Attributes
    ----------
    kind : of the study, see `tasks`. stimuli : names, in the order of rating columns; of two the second is
        the one that a preference counts for.
    person, item : names, (n,) of str. round : (n,) of int.
    choice : (n,) of str: a stimulus's name, "equal", or "" where missing or not asked.
    correct : (n,) 1, 0, or nan where there is no right answer, or none was given.
    ratings : by name, (n, stimuli), nan where missing.
    ratio : (n,) staircase level, nan elsewhere. change : (n, 3) of force, snap and vibration where thresholds
        are measured; None elsewhere. time_s : (n,) nan where unknown.
    excluded : (n,) of str: why a row does not count; "" where it does.
    simulated : the answers are those of simulated participants.

    ModelError where columns differ in length.
    """

    kind: str
    stimuli: tuple[str, ...]
    person: np.ndarray
    item: np.ndarray
    round: np.ndarray
    choice: np.ndarray
    correct: FloatArray
    ratings: dict[str, FloatArray] = field(default_factory=dict)
    ratio: FloatArray | None = None
    time_s: FloatArray | None = None
    excluded: np.ndarray | None = None
    simulated: bool = False
    change: FloatArray | None = None

    def __post_init__(self) -> None:
        n = len(self.person)
        columns = [self.item, self.round, self.choice, self.correct, *self.ratings.values()]
        columns += [one for one in (self.ratio, self.time_s, self.excluded, self.change) if one is not None]
        if any(len(one) != n for one in columns):
            raise ModelError(f"columns of answers differ in length from its {n} persons")

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why a row does not count, row by row; empty of one that does."""
        return ("",) * len(self.person) if self.excluded is None else tuple(self.excluded.tolist())

    @property
    def counts(self) -> np.ndarray:
        """Which rows count, (n,) of bool."""
        return np.ones(len(self.person), bool) if self.excluded is None else self.excluded == ""


def is_answered(answers: Answers) -> np.ndarray:
    """Return which rows hold an answer of any sort, (n,) of bool."""
    rated = [np.isfinite(columns).any(axis=1) for columns in answers.ratings.values()]
    return np.asarray(np.any([answers.choice != "", np.isfinite(answers.correct), *rated], axis=0))


def means_by(values: FloatArray, *keys: np.ndarray) -> FloatArray:
    """Average values over rows that share every key, in order of the keys; nan where all are missing."""
    places = groups_by(*keys)
    there = np.isfinite(values)
    count = np.bincount(places, there)
    with np.errstate(invalid="ignore"):
        return np.asarray(np.bincount(places, np.where(there, values, 0.0)) / np.where(count, count, np.nan))


def groups_by(*keys: np.ndarray) -> np.ndarray:
    """Number the groups of rows that share every key, 0, 1, … in order of the keys, (n,) of int."""
    numbers = np.column_stack([np.unique(key, return_inverse=True)[1] for key in keys])
    return np.asarray(np.unique(numbers, axis=0, return_inverse=True)[1].ravel())


@dataclass(frozen=True)
class Screening:
    """What the rules left.

    Attributes
    ----------
    answers : with the reason of every row that does not count. planned, answered, counted : rows.
    reasons : rows left out, by reason; a row that nobody answered is missing, not left out.
    people : all of them. left_out : why, by person that counts with no row.
    """

    answers: Answers
    planned: int
    answered: int
    counted: int
    reasons: Mapping[str, int]
    people: tuple[str, ...]
    left_out: Mapping[str, str]

    @property
    def people_counted(self) -> int:
        """How many people are left with an answer."""
        counts = self.answers.counts & is_answered(self.answers)
        return len(set(self.answers.person[counts].tolist()))


def screen(answers: Answers, rule: Exclusion | None = None) -> Screening:
    """Leave out people by rule, in addition to the trials that are left out already.

    Who lacks more than rule.share_missing of the trials is left out, and of a MUSHRA-like study who failed to
    find the hidden reference. Rules about trials and labels need telemetry and the labels: they are applied
    where a study is unsealed.
    """
    rule = rule or Exclusion()
    answered = is_answered(answers)
    excluded = np.full(len(answers.person), "", object)
    if answers.excluded is not None:
        excluded[:] = answers.excluded
    left_out: dict[str, str] = {}
    for person in dict.fromkeys(answers.person.tolist()):
        rows = answers.person == person
        reason = _reason(answers, rows, answered & (excluded == ""), rule)
        if reason:
            left_out[person] = reason
            excluded[rows & (excluded == "")] = reason
    names, counts = np.unique(excluded[answered & (excluded != "")].astype(str), return_counts=True)
    return Screening(
        replace(answers, excluded=excluded.astype(str)),
        planned=len(answered),
        answered=int(answered.sum()),
        counted=int(np.sum(answered & (excluded == ""))),
        reasons=dict(zip(names.tolist(), counts.tolist(), strict=True)),
        people=tuple(dict.fromkeys(answers.person.tolist())),
        left_out=left_out,
    )


def _reason(answers: Answers, rows: np.ndarray, valid: np.ndarray, rule: Exclusion) -> str:
    """Return why a person does not count; "" where they do."""
    reasons = Counter[str]([] if answers.excluded is None else answers.excluded[rows].tolist())
    if reasons and not valid[rows].any() and not reasons[""]:
        return str(reasons.most_common(1)[0][0])
    missing = 1.0 - valid[rows].mean()
    if missing > rule.share_missing:
        return f"more than {100 * rule.share_missing:.0f} % of the person's trials are missing"
    rates = task_behind(answers.kind).hides_reference
    if rates and _misses_reference(answers, rows & valid, rule.reference_points):
        return "the person did not find the hidden reference"
    return ""


def _misses_reference(answers: Answers, rows: np.ndarray, least: float) -> bool:
    for columns in answers.ratings.values():
        reference = columns[rows, 0]
        reference = reference[np.isfinite(reference)]
        if np.nanmax(columns, initial=0.0) > WIDE_SCALE and reference.size:
            return bool(np.mean(reference < least) > REFERENCE_SHARE)
    return False

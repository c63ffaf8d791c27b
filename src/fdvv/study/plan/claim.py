"""What a claim is tested on: for every trial how far it speaks for it, and the same person by person."""

from __future__ import annotations

import numpy as np
from msgspec import structs

from fdvv.errors import ModelError
from fdvv.study._answers import Answers
from fdvv.study._plan import Claim
from fdvv.study._trial import EQUAL
from fdvv.units import FloatArray

CHOICE, CORRECT = "choice", "correct"
"""Measures that are no rating: what was chosen, and whether that was right."""


def is_answered(answers: Answers) -> np.ndarray:
    """Tell which rows hold an answer of any sort, (n,) of bool."""
    rated = [np.isfinite(columns).any(axis=1) for columns in answers.ratings.values()]
    return np.asarray(np.any([answers.choice != "", np.isfinite(answers.correct), *rated], axis=0))


def is_about_right(answers: Answers) -> bool:
    """Tell whether the answers of a study are right or wrong rather than a liking."""
    forced = answers.kind in ("abx", "2afc", "staircase")
    return forced and bool(np.isfinite(answers.correct).any())


def usual_claim(answers: Answers) -> Claim | None:
    """Give the claim of a study that declared none: the second stimulus over the first.

    None where nothing was compared in that way: staircases, timing, or more than two stimuli.
    """
    if is_about_right(answers) and answers.kind != "staircase":
        first, second = (*answers.stimuli, "", "")[:2]
        return Claim(more=second or "right", less=first or "wrong", measure=CORRECT)
    if len(answers.stimuli) != 2 or answers.kind in ("staircase", "timing"):
        return None
    measures = [CHOICE] if np.any(answers.choice != "") else list(answers.ratings)
    return Claim(more=answers.stimuli[1], less=answers.stimuli[0], measure=measures[0]) if measures else None


def measured_by(claim: Claim, measure: str) -> Claim:
    """Give the same claim on another measure."""
    return structs.replace(claim, measure=measure)


def measure_of(answers: Answers, claim: Claim) -> str:
    """Give what the claim is measured by: in ABX a choice names no stimulus, and counts as right or wrong."""
    return CORRECT if claim.measure == CHOICE and answers.kind == "abx" else claim.measure


def choice_claim(answers: Answers, claim: Claim) -> Claim:
    """Give the same claim about what was chosen, or was right."""
    if claim.measure == CORRECT or answers.kind == "abx":
        return measured_by(claim, CORRECT)
    return measured_by(claim, CHOICE)


def claim_values(answers: Answers, claim: Claim) -> FloatArray:
    """Tell for every row how far it speaks for the claim, (n,).

    A choice is 1 for it, -1 against it, 0 for equal; a right answer is 1, a wrong one -1; of ratings it is
    their difference. nan where there is no answer. ModelError on a name that the answers do not hold.
    """
    measure = measure_of(answers, claim)
    if measure == CORRECT:
        return np.asarray(2.0 * answers.correct - 1.0)
    for name in (claim.more, claim.less):
        if name not in answers.stimuli:
            raise ModelError(f"the claim is about {name!r}, the answers about {', '.join(answers.stimuli)}")
    if measure == CHOICE:
        sides = [answers.choice == claim.more, answers.choice == claim.less, answers.choice == EQUAL]
        return np.select(sides, [1.0, -1.0, 0.0], np.nan)
    if measure not in answers.ratings:
        there = ", ".join((CHOICE, *answers.ratings))
        raise ModelError(f"the claim is measured by {measure!r}, there are {there}")
    columns = answers.ratings[measure]
    more, less = (answers.stimuli.index(name) for name in (claim.more, claim.less))
    return np.asarray(columns[:, more] - columns[:, less])


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

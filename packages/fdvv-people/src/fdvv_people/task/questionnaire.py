"""A short questionnaire after a trial: how a button is liked, on scales from 1 to 7.

The wording is that of four items of the independent rating scale of ISO 9241-9 (annex C), which has seven
points with named ends. Every item runs from bad to good, so that their mean is a score.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from msgspec import Struct

from fdvv.errors import InputError
from fdvv_people.task.score import Objective, Score

LOWEST, HIGHEST = 1, 7
LIKING = Objective("liking", larger_is_better=True)
ROUNDING = 1 / 12
"""Variance of an answer that is rounded to whole points."""


class Item(Struct, frozen=True):
    """One question.

    Attributes
    ----------
    question : what is rated. lowest, highest : what 1 and 7 mean.
    """

    question: str
    lowest: str
    highest: str


ITEMS = (
    Item("General comfort", "very uncomfortable", "very comfortable"),
    Item("Accuracy", "very inaccurate", "very accurate"),
    Item("Effort required", "very high", "very low"),
    Item("Overall operation", "very difficult to use", "very easy to use"),
)


def check_answers(answers: Sequence[int]) -> tuple[int, ...]:
    """Return the answers to ITEMS, in their order. InputError on too few, too many or beyond the scale."""
    if len(answers) != len(ITEMS):
        raise InputError("answers", "all", f"are {len(answers)}", f"answer {len(ITEMS)} questions")
    for item, answer in zip(ITEMS, answers, strict=True):
        if answer not in range(LOWEST, HIGHEST + 1):
            remedy = f"use a whole number from {LOWEST} to {HIGHEST}"
            raise InputError("answers", item.question, f"is {answer}", remedy)
    return tuple(map(int, answers))


def liking_score(answers: Sequence[int]) -> Score:
    """Return the mean of the answers and its standard error, from how the items differ.

    Items that agree leave at least the error of rounding to whole points. InputError, see check_answers.
    """
    points = np.array(check_answers(answers), dtype=np.float64)
    variance = max(float(np.var(points, ddof=1)), ROUNDING)
    return Score(float(points.mean()), float(np.sqrt(variance / points.size)))

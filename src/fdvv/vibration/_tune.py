"""What tuning by a person shares: what is asked, what was answered, what came out of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol, TypeVar

import numpy as np

from fdvv.errors import ModelError

S = TypeVar("S")


class Preferred(StrEnum):
    """What a person says of two: the first, the second, or neither is closer."""

    FIRST = "first"
    SECOND = "second"
    NEITHER = "neither"


@dataclass(frozen=True)
class Question:
    """What is asked next; the person is shown neither templates nor how often they were chosen.

    Attributes
    ----------
    place : number of the velocity. templates : one to rate, or two to compare in that order.
    number, total : of this question, from 1; the total is the most that it can become.
    """

    place: int
    templates: tuple[int, ...]
    number: int
    total: int


@dataclass(frozen=True)
class Answered:
    """A question's velocity and templates, and the answer: a rating, or who is preferred."""

    place: int
    templates: tuple[int, ...]
    answer: int | Preferred


@dataclass(frozen=True)
class Standing:
    """What answers at one velocity say.

    Attributes
    ----------
    best : the template kept. Where others cannot be told from the one that scored highest, it is still that
        one unless nothing can be told apart: then the first, which is as measured.
    scores, errors : per template, with standard errors: mean rating, or Bradley-Terry log-odds.
    alike : templates that cannot be told from the highest at 95 %, that one among them, rising.
    answers : how many there are.
    """

    best: int
    scores: tuple[float, ...]
    errors: tuple[float, ...]
    alike: tuple[int, ...]
    answers: int

    @property
    def told_apart(self) -> bool:
        """Tell whether anything differs from anything."""
        return len(self.alike) < len(self.scores)


@dataclass(frozen=True)
class Job:
    """What is tuned: how many templates at each velocity."""

    templates: tuple[int, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "templates", tuple(self.templates))
        if not self.templates or min(self.templates) < 2:
            raise ModelError(f"tuning needs 2 templates at every velocity, got {self.templates}")

    @property
    def places(self) -> int:
        """Count the velocities."""
        return len(self.templates)


class Method(Protocol[S]):
    """One shape for ways of asking: settings are the object, all else is in the state."""

    def init(self, job: Job) -> S:
        """Begin."""
        ...

    def ask(self, state: S) -> Question | None:
        """Tell what to ask; the same state asks the same. None when done."""
        ...

    def tell(self, state: S, answer: int | Preferred) -> S:
        """Take the answer to what is asked; ModelError if it is none."""
        ...

    def done(self, state: S) -> bool:
        """Tell whether nothing is left to ask."""
        ...

    def best(self, state: S) -> tuple[Standing, ...]:
        """Say per velocity what the answers so far say."""
        ...


def standing(
    scores: Sequence[float], errors: Sequence[float], alike: Sequence[int], answers: int
) -> Standing:
    """Choose what is kept."""
    told_apart = len(alike) < len(scores)
    best = int(np.argmax(scores)) if told_apart else 0
    return Standing(best, tuple(map(float, scores)), tuple(map(float, errors)), tuple(alike), answers)

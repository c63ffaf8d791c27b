"""Tuning of a vibration by a person's ratings: questions, answers and the ranking of templates."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray

LOWEST, HIGHEST = 1, 7
SCALE = 1.5
"""Ratings per unit of how much a template is liked."""


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
class Ranking:
    """What answers at one velocity say.

    Attributes
    ----------
    best : the template kept. The one that scored highest, even where others cannot be distinguished from
        it; the first, which is as measured, where nothing can be distinguished.
    scores, errors : per template, with standard errors: mean rating, or Bradley-Terry log-odds.
    alike : templates that cannot be distinguished from the highest at 95 %, that one among them, rising.
    answers : how many there are.
    """

    best: int
    scores: tuple[float, ...]
    errors: tuple[float, ...]
    alike: tuple[int, ...]
    answers: int

    @property
    def distinct(self) -> bool:
        """Return whether anything differs from anything."""
        return len(self.alike) < len(self.scores)


@dataclass(frozen=True)
class Job:
    """What is tuned: how many templates at each velocity."""

    templates: tuple[int, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "templates", tuple(self.templates))
        if not self.templates or min(self.templates) < 2:
            raise ModelError(f"tuning needs 2 templates at every velocity, got {self.templates}")


@dataclass(frozen=True)
class TuningState:
    """The answers so far, and of ratings the plan as (velocity, template) in order."""

    job: Job
    plan: tuple[tuple[int, int], ...] = ()
    answers: tuple[Answered, ...] = ()

    def answers_at(self, place: int) -> list[Answered]:
        return [a for a in self.answers if a.place == place]


class Method(ABC):
    """One shape for ways of asking: settings are the object, all else is in the state."""

    def init(self, job: Job) -> TuningState:
        """Begin without answers."""
        return TuningState(job)

    @abstractmethod
    def ask(self, state: TuningState) -> Question | None:
        """Return what to ask; the same state asks the same. None when done."""

    def tell(self, state: TuningState, answer: int | Preferred) -> TuningState:
        """Take the answer to what is asked; ModelError if it is none."""
        question = self.ask(state)
        if question is None:
            raise ModelError("nothing is asked any more")
        self._check(answer)
        return replace(state, answers=(*state.answers, Answered(question.place, question.templates, answer)))

    @abstractmethod
    def _check(self, answer: int | Preferred) -> None:
        """Raise ModelError if it is no answer."""

    def is_done(self, state: TuningState) -> bool:
        return self.ask(state) is None

    def best(self, state: TuningState) -> tuple[Ranking, ...]:
        """Return per velocity what the answers so far say."""
        return tuple(self.ranking(state, place) for place in range(len(state.job.templates)))

    @abstractmethod
    def ranking(self, state: TuningState, place: int) -> Ranking: ...


def standing(scores: FloatArray, errors: FloatArray, alike: Sequence[int], answers: int) -> Ranking:
    distinct = len(alike) < len(scores)
    best = int(np.argmax(scores)) if distinct else 0
    return Ranking(best, tuple(scores.tolist()), tuple(errors.tolist()), tuple(alike), answers)


@dataclass(frozen=True)
class Rating(Method):
    """Rate from 1, unlike the real button, to 7.

    Attributes
    ----------
    repeats : of each template at each velocity; below 2 nothing is known of the answers' spread.
    seed : of the order.
    """

    repeats: int = 3
    seed: int = 0

    def __post_init__(self) -> None:
        if self.repeats < 2 or self.seed < 0:
            raise ModelError(
                f"repeats must be 2 or more and seed 0 or more, got {self.repeats} and {self.seed}"
            )

    def init(self, job: Job) -> TuningState:
        """Draw the order: in every round each velocity once, in it each template, none twice in a row."""
        random = np.random.default_rng(self.seed)
        plan: list[tuple[int, int]] = []
        for _ in range(self.repeats):
            for place in random.permutation(len(job.templates)):
                order = random.permutation(job.templates[place])
                while plan and plan[-1] == (int(place), int(order[0])):
                    order = random.permutation(job.templates[place])
                plan += [(int(place), int(template)) for template in order]
        return TuningState(job, tuple(plan))

    def ask(self, state: TuningState) -> Question | None:
        made = len(state.answers)
        if made >= len(state.plan):
            return None
        place, template = state.plan[made]
        return Question(place, (template,), made + 1, len(state.plan))

    def _check(self, answer: int | Preferred) -> None:
        if not isinstance(answer, int) or not LOWEST <= answer <= HIGHEST:
            raise ModelError(f"a rating is a whole number from {LOWEST} to {HIGHEST}, got {answer!r}")

    def ranking(self, state: TuningState, place: int) -> Ranking:
        """Compare means; alike is what Student's t at 95 %, shared among comparisons, cannot separate."""
        mine, every = state.answers_at(place), range(state.job.templates[place])
        rated = [np.array([float(a.answer) for a in mine if a.templates[0] == i]) for i in every]
        scores = np.array([r.mean() if r.size else np.nan for r in rated])
        errors = _errors(rated)
        if np.isnan(scores).any() or np.isnan(errors).any():
            return standing(np.nan_to_num(scores), np.full(scores.size, np.inf), every, len(mine))
        return standing(scores, errors, _alike(scores, errors, sum(r.size - 1 for r in rated)), len(mine))


def _errors(rated: list[FloatArray]) -> FloatArray:
    """Return standard errors of means with a pooled variance, at least that of rounding to whole ratings."""
    free = sum(max(r.size - 1, 0) for r in rated)
    if not free:
        return np.full(len(rated), np.nan)
    spread = max(sum(float(np.sum((r - r.mean()) ** 2)) for r in rated if r.size) / free, 1 / 12)
    return np.array([np.sqrt(spread / r.size) if r.size else np.nan for r in rated])


def _alike(scores: FloatArray, errors: FloatArray, free: int) -> list[int]:
    from scipy.special import stdtrit

    top = int(np.argmax(scores))
    bound = float(stdtrit(max(free, 1), 1 - 0.05 / 2 / max(scores.size - 1, 1)))
    apart = (scores[top] - scores) > bound * np.hypot(errors[top], errors)
    return [i for i in range(scores.size) if not apart[i]]


@dataclass(frozen=True)
class SimulatedObserver:
    """Answers as someone might whose likes are known; a proxy that shows that the machinery works.

    Attributes
    ----------
    likes : per velocity and template, in units of the noise of a comparison by Thurstone's model.
    unsure : perceived difference below which neither is preferred.
    seed : of the noise. noise : standard deviation of the percept of one template.
    """

    likes: Sequence[Sequence[float]]
    unsure: float = 0.2
    noise: float = 1.0
    seed: int = 0

    def answer(self, question: Question) -> int | Preferred:
        """Rate one template, or compare two; the same question, by its number, is answered the same."""
        random = np.random.default_rng([self.seed, question.number])
        likes = self.likes[question.place]
        perceived = [likes[i] + self.noise * random.normal() for i in question.templates]
        if len(perceived) == 1:
            middle = (LOWEST + HIGHEST) / 2
            return int(np.clip(round(middle + SCALE * perceived[0]), LOWEST, HIGHEST))
        if abs(perceived[0] - perceived[1]) < self.unsure:
            return Preferred.NEITHER
        return Preferred.FIRST if perceived[0] > perceived[1] else Preferred.SECOND

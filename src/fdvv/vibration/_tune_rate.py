"""Rate every template by itself, several times, in balanced random order: the paper's way."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv.vibration._tune import Answered, Job, Preferred, Question, Standing, standing

LOWEST, HIGHEST = 1, 7


@dataclass(frozen=True)
class RatingState:
    """Where it stands: the plan as (velocity, template) in order, and the answers so far."""

    job: Job
    plan: tuple[tuple[int, int], ...]
    answers: tuple[Answered, ...] = ()


@dataclass(frozen=True)
class Rating:
    """Settings.

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

    def init(self, job: Job) -> RatingState:
        """Draw the order: in every round each velocity once, in it each template, none twice in a row."""
        random = np.random.default_rng(self.seed)
        plan: list[tuple[int, int]] = []
        for _ in range(self.repeats):
            for place in random.permutation(job.places):
                order = random.permutation(job.templates[place])
                while plan and plan[-1] == (int(place), int(order[0])):
                    order = random.permutation(job.templates[place])
                plan += [(int(place), int(template)) for template in order]
        return RatingState(job, tuple(plan))

    def ask(self, state: RatingState) -> Question | None:
        """Tell what to rate next."""
        if self.done(state):
            return None
        place, template = state.plan[len(state.answers)]
        return Question(place, (template,), len(state.answers) + 1, len(state.plan))

    def tell(self, state: RatingState, answer: int | Preferred) -> RatingState:
        """Take a rating from 1, unlike the real button, to 7."""
        asked = self.ask(state)
        if asked is None:
            raise ModelError("nothing is asked any more")
        if not isinstance(answer, int) or not LOWEST <= answer <= HIGHEST:
            raise ModelError(f"a rating is a whole number from {LOWEST} to {HIGHEST}, got {answer!r}")
        return replace(state, answers=(*state.answers, Answered(asked.place, asked.templates, answer)))

    def done(self, state: RatingState) -> bool:
        """Tell whether everything was rated as often as planned."""
        return len(state.answers) >= len(state.plan)

    def best(self, state: RatingState) -> tuple[Standing, ...]:
        """Compare means; alike is what Student's t at 95 %, shared among comparisons, cannot tell apart."""
        return tuple(self._standing(state, place) for place in range(state.job.places))

    def _standing(self, state: RatingState, place: int) -> Standing:
        mine = [a for a in state.answers if a.place == place]
        rated = [
            np.array([float(a.answer) for a in mine if a.templates[0] == template])
            for template in range(state.job.templates[place])
        ]
        scores = np.array([r.mean() if r.size else np.nan for r in rated])
        errors = _errors(rated)
        if np.isnan(scores).any() or np.isnan(errors).any():
            every = tuple(range(state.job.templates[place]))
            return standing(np.nan_to_num(scores), np.full(scores.size, np.inf).tolist(), every, len(mine))
        alike = _alike(scores, errors, sum(r.size - 1 for r in rated))
        return standing(scores.tolist(), errors.tolist(), alike, len(mine))


def _errors(rated: list[FloatArray]) -> FloatArray:
    """Give standard errors of means, of one spread for all; never below that of rounding to whole ratings."""
    free = sum(max(r.size - 1, 0) for r in rated)
    if not free:
        return np.full(len(rated), np.nan)
    spread = sum(float(np.sum((r - r.mean()) ** 2)) for r in rated if r.size) / free
    spread = max(spread, 1 / 12)
    return np.array([np.sqrt(spread / r.size) if r.size else np.nan for r in rated])


def _alike(scores: FloatArray, errors: FloatArray, free: int) -> list[int]:
    from scipy.special import stdtrit

    top = int(np.argmax(scores))
    bound = float(stdtrit(max(free, 1), 1 - 0.05 / 2 / max(scores.size - 1, 1)))
    apart = (scores[top] - scores) > bound * np.hypot(errors[top], errors)
    return [i for i in range(scores.size) if not apart[i]]

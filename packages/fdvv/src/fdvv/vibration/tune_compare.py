"""Compare templates in pairs, each the most informative about the best: Bradley and Terry's model."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv.vibration.tune import Job, Method, Preferred, Question, Ranking, TuningState, standing

PRIOR = 1.5
"""Standard deviation of the log-odds before any answer: 3 to 1 is usual, 20 to 1 is rare."""
DRAWS = 512
"""Of the posterior, to see how often each template is the best."""
STEPS = 30
SHARE = {Preferred.FIRST: 1.0, Preferred.SECOND: 0.0, Preferred.NEITHER: 0.5}
"""Of a win that goes to the first."""


@dataclass(frozen=True)
class Comparing(Method):
    """Say which of two is closer.

    Attributes
    ----------
    comparisons : per velocity, the most that are asked; None: three for each template.
    sure : a velocity is done earlier once a template is the best with this probability.
    fewest : comparisons per velocity before that counts; None: one for each template.
    seed : of order and choice among equals.
    """

    comparisons: int | None = None
    sure: float = 0.95
    fewest: int | None = None
    seed: int = 0

    def __post_init__(self) -> None:
        for name in ("comparisons", "fewest"):
            if getattr(self, name) is not None and getattr(self, name) < 1:
                raise ModelError(f"{name} must be at least 1, got {getattr(self, name)}")
        if not 0.5 < self.sure <= 1 or self.seed < 0:
            raise ModelError(
                f"sure must be above 0.5 to 1 and seed 0 or more, got {self.sure} and {self.seed}"
            )

    def ask(self, state: TuningState) -> Question | None:
        """Choose the pair of the first velocity that is not done; the same answers ask the same."""
        places = range(len(state.job.templates))
        place = next((place for place in places if not self._is_settled(state, place)), None)
        if place is None:
            return None
        total = sum(self._most(state.job, each) for each in places)
        return Question(place, self._pair(state, place), len(state.answers) + 1, total)

    def is_done(self, state: TuningState) -> bool:
        return all(self._is_settled(state, place) for place in range(len(state.job.templates)))

    def _check(self, answer: int | Preferred) -> None:
        if not isinstance(answer, Preferred):
            raise ModelError(f"an answer is one of {', '.join(Preferred)}, got {answer!r}")

    def _most(self, job: Job, place: int) -> int:
        return self.comparisons or 3 * job.templates[place]

    def _is_settled(self, state: TuningState, place: int) -> bool:
        made = len(state.answers_at(place))
        if made >= self._most(state.job, place):
            return True
        if made < (self.fewest or state.job.templates[place]):
            return False
        return bool(self._chances(state, place).max() >= self.sure)

    def ranking(self, state: TuningState, place: int) -> Ranking:
        """Return log-odds by the posterior; alike is what has 5 % of the likeliest's chance or more."""
        mean, spread = posterior(wins(state, place))
        chances = self._chances(state, place)
        alike = np.flatnonzero(chances >= 0.05 * chances.max()).tolist()
        return standing(mean, np.sqrt(np.diag(spread)), alike, len(state.answers_at(place)))

    def _random(self, state: TuningState, place: int) -> np.random.Generator:
        """Return a generator seeded by the answers, so that a resumed session asks the same."""
        return np.random.default_rng([self.seed, place, len(state.answers_at(place))])

    def _chances(self, state: TuningState, place: int) -> FloatArray:
        mean, spread = posterior(wins(state, place))
        drawn = self._random(state, place).multivariate_normal(mean, spread, DRAWS, method="cholesky")
        chances: FloatArray = np.bincount(np.argmax(drawn, axis=1), minlength=mean.size) / DRAWS
        return chances

    def _pair(self, state: TuningState, place: int) -> tuple[int, int]:
        """Choose the most informative pair by the spreads of difference and answer, near the best."""
        mean, spread = posterior(wins(state, place))
        chances = self._chances(state, place) + 1 / DRAWS
        odds = 1 / (1 + np.exp(mean[None, :] - mean[:, None]))
        variance = np.diag(spread)[:, None] + np.diag(spread)[None, :] - 2 * spread
        worth = variance * odds * (1 - odds) * (chances[:, None] + chances[None, :])
        random = self._random(state, place)
        worth = worth * (1 + 1e-6 * random.random(worth.shape))
        first, second = np.unravel_index(int(np.argmax(np.triu(worth, 1))), worth.shape)
        return self._order(state, place, int(first), int(second), bool(random.integers(2)))

    @staticmethod
    def _order(state: TuningState, place: int, a: int, b: int, swap: bool) -> tuple[int, int]:
        """Put first what was second more often, so that order favours nobody; chance decides a draw."""
        mine = [x.templates for x in state.answers_at(place)]
        lead = {i: sum(t[0] == i for t in mine) - sum(t[1] == i for t in mine) for i in (a, b)}
        if lead[a] != lead[b]:
            return (a, b) if lead[a] < lead[b] else (b, a)
        return (b, a) if swap else (a, b)


def wins(state: TuningState, place: int) -> FloatArray:
    """Count how often each template (row) was preferred to each other; neither is half for both."""
    size = state.job.templates[place]
    count = np.zeros((size, size))
    for answered in state.answers_at(place):
        first, second = answered.templates
        share = SHARE[Preferred(str(answered.answer))]
        count[first, second] += share
        count[second, first] += 1 - share
    return count


def posterior(won: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return mean and covariance of the log-odds: Newton's steps to the peak, and the curvature there."""
    size = won.shape[0]
    mean = np.zeros(size)
    for _ in range(STEPS):
        odds = 1 / (1 + np.exp(mean[None, :] - mean[:, None]))
        played = (won + won.T) * odds * (1 - odds)
        slope = (won - (won + won.T) * odds).sum(axis=1) - mean / PRIOR**2
        curve = np.diag(played.sum(axis=1)) - played + np.eye(size) / PRIOR**2
        step = np.linalg.solve(curve, slope)
        mean = mean + step
        if np.abs(step).max() < 1e-10:
            break
    return mean, np.asarray(np.linalg.inv(curve), dtype=np.float64)

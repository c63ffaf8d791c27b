"""What a person likes best, from comparisons: a Gaussian process of worth, seen through answers that may err.

Chu and Ghahramani, Preference learning with Gaussian processes (2005): an answer is the sign of a
difference of worths plus noise; Laplace's approximation about the most probable worths. Worth has a variance
of 1, larger is better.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import islice
from typing import Any, ClassVar

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.optimize.engines.search import draw_feasible, fresh, generator, missing, tried_places
from fdvv_people.optimize.problem import Problem, Trial
from fdvv_people.optimize.space import DesignSpace

LENGTH, LINE_LENGTH = 0.4, 0.3
"""Over which worth changes, ranges times the root of d: few answers cannot tell lengths, so it is given; of
lines it is shorter, because a line tells more of it than a pair."""
LINE_WEIGHT = 0.4
"""Of each design of a line that was not chosen, in answers: all of them share the error of the best one."""
NOISE = 0.3
"""SD of an answer's noise, parts of worth's own."""
STEPS = 50  # a bound, assumed: Newton's method, quadratic on a log-concave likelihood, ends at 1e-9
Rows = np.ndarray[tuple[int], np.dtype[np.intp]]


@dataclass(frozen=True, eq=False)
class PreferenceBelief:
    """Worth after some answers.

    Attributes
    ----------
    places : (n, d) that were compared. pairs : (m, 2) rows of places, the preferred one first.
    counts : (m,) of each answer; an "equal" is half an answer either way.
    """

    places: FloatArray
    pairs: np.ndarray[tuple[int, int], np.dtype[np.intp]]
    counts: FloatArray
    _kernel: Any = field(repr=False)

    @cached_property
    def _solved(self) -> dict[str, FloatArray]:
        K = self._kernel(self.places) + 1e-8 * np.eye(len(self.places))
        worth = np.zeros(len(K))
        for _ in range(STEPS):
            slope, W = self._bend(worth)
            step = np.linalg.solve(np.eye(len(K)) + K @ W, K @ (W @ worth + slope)) - worth
            worth = worth + step
            if np.abs(step).max() < 1e-9:
                break
        slope, W = self._bend(worth)
        # (K + W^-1)^-1 without inverting W, which is singular: only differences are seen
        inner = np.linalg.solve(np.eye(len(K)) + W @ K, W)
        return {"a": slope, "B": 0.5 * (inner + inner.T), "worth": worth}

    def _bend(self, worth: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the gradient (n,) and negative Hessian (n, n) of the log likelihood at worths (n,)."""
        from scipy.special import log_ndtr

        first, second = self.pairs.T
        z = (worth[first] - worth[second]) / (np.sqrt(2) * NOISE)
        ratio = np.exp(-0.5 * z**2 - 0.5 * np.log(2 * np.pi) - log_ndtr(z))
        g = self.counts * ratio / (np.sqrt(2) * NOISE)
        h = self.counts * ratio * (z + ratio) / (2 * NOISE**2)
        D = np.zeros((len(z), len(worth)))
        D[np.arange(len(z)), first], D[np.arange(len(z)), second] = 1.0, -1.0
        return D.T @ g, D.T @ (h[:, None] * D)

    def predict(self, places: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return mean (n,) and covariance (n, n) of the worth of places."""
        cross = self._kernel(places, self.places)
        cov = self._kernel(places) - cross @ self._solved["B"] @ cross.T
        return cross @ self._solved["a"], np.asarray(cov)

    def mean(self, places: FloatArray) -> FloatArray:
        return np.asarray(self._kernel(places, self.places) @ self._solved["a"])

    def most_liked(self, places: FloatArray) -> FloatArray:
        """Return the one of places (n, d) whose mean worth is largest."""
        return np.asarray(places[int(np.argmax(self.mean(places)))])


def kernel_of(dimensions: int, length: float = LENGTH) -> Any:
    """Return worth's covariance; length : ranges times the root of d. BuildError without scikit-learn."""
    try:
        from sklearn.gaussian_process.kernels import Matern
    except ImportError as error:
        raise missing("preference", "optimize", error) from error
    return Matern(length * np.sqrt(dimensions), nu=2.5)


def distinct(places: FloatArray) -> tuple[FloatArray, Rows]:
    """Return each place of (n, d) once, (m, d), and which of these each is, (n,)."""
    once = fresh(places, np.empty((0, places.shape[1])))
    return once, np.abs(places[:, None] - once[None]).max(axis=2).argmin(axis=1)


def believe_choices(
    space: DesignSpace, trials: Sequence[Trial], of_lines: bool = False
) -> PreferenceBelief | None:
    """Learn from answered choices: the best design beat each other one. None without any, else BuildError.

    of_lines : the designs of a trial are along a line, and all share the error of the best one.
    """
    answered = [trial for trial in trials if trial.best]
    if not answered:
        return None
    weight, length = (LINE_WEIGHT, LINE_LENGTH) if of_lines else (1.0, LENGTH)
    places, rows = distinct(tried_places(space, answered))
    row, pairs, counts = iter(rows.tolist()), list[tuple[int, int]](), list[float]()
    for trial in answered:
        tried = list(islice(row, len(trial.designs)))
        liked = [tried[place] for place in trial.best or ()]
        wins = [(best, other) for best in liked for other in tried if other != best]
        pairs += wins
        counts += [weight / len(liked)] * len(wins)
    table = np.array(pairs, dtype=np.intp).reshape(-1, 2)
    return PreferenceBelief(places, table, np.array(counts), kernel_of(places.shape[1], length))


def favourite(belief: PreferenceBelief | None, space: DesignSpace) -> dict[str, float]:
    """Return the most liked design that was tried. ModelError where nothing is known."""
    if belief is None:
        raise ModelError("nothing is answered yet, so there is no favourite")
    return space.of_unit(belief.most_liked(belief.places))[0]


@dataclass(frozen=True)
class PreferenceEngine:
    """Compare the favourite so far with the most promising of some designs drawn at random.

    A person always compares with what they know; chance in the draw is what explores. In few answers and
    eight dimensions this found more than looking everywhere for the largest expected worth of the better
    one, which leads to the corners, where least is known (docs/explanation/optimisation.md).

    Parameters
    ----------
    drawn : designs that the challenger is chosen from; more of them trust the belief more.
    """

    trial_size: ClassVar[int] = 2
    drawn: int = 128
    name: str = field(default="preference", init=False)

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        rng, d = generator(problem, trials, 9), len(problem.space.names)
        belief = believe_choices(problem.space, trials)
        drawn = 2 if belief is None else self.drawn
        net = draw_feasible(problem, lambda n: rng.random((n, d)), tried_places(problem.space, trials), drawn)
        if belief is not None:
            net = np.vstack([belief.most_liked(belief.places), belief.most_liked(net)])
        # neither place of the two is always the favourite's
        return problem.space.of_unit(net if rng.random() < 0.5 else net[::-1])

    def best(self, problem: Problem, trials: Sequence[Trial]) -> dict[str, float]:
        return favourite(believe_choices(problem.space, trials), problem.space)

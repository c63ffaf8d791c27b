"""What a person likes best, from comparisons: a Gaussian process of worth, seen through answers that may err.

Chu and Ghahramani, Preference learning with Gaussian processes (2005): an answer is the sign of a
difference of worths plus noise; Laplace's approximation about the most probable worths. Worth has a variance
of 1, larger is better.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.optimize.engines.search import draw_feasible, fresh, generator, missing
from fdvv.optimize.problem import Answer, Comparison, Problem
from fdvv.optimize.space import DesignSpace
from fdvv.units import FloatArray

LENGTH = 0.4
"""Over which worth changes, ranges times the root of d: few answers cannot tell lengths, so it is given."""
NOISE = 0.3
"""SD of an answer's noise, parts of worth's own."""
STEPS = 50
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


def believe_answers(space: DesignSpace, comparisons: Sequence[Comparison]) -> PreferenceBelief | None:
    """Learn from answered comparisons; None without any. Raises BuildError without scikit-learn."""
    answered = [one for one in comparisons if one.answer is not None]
    if not answered:
        return None
    both = space.to_unit([design for one in answered for design in (one.first, one.second)])
    places, rows = distinct(both)
    pairs, counts = [], []
    for (first, second), one in zip(rows.reshape(-1, 2).tolist(), answered, strict=True):
        if first == second:
            continue
        share = {Answer.FIRST: 1.0, Answer.SECOND: 0.0, Answer.EQUAL: 0.5}[one.answer or Answer.EQUAL]
        pairs += [(first, second), (second, first)]
        counts += [share, 1.0 - share]
    table = np.array(pairs, dtype=np.intp).reshape(-1, 2)
    return PreferenceBelief(places, table, np.array(counts), kernel_of(both.shape[1]))


Pair = tuple[dict[str, float], dict[str, float]]


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

    drawn: int = 128
    name: str = field(default="preference", init=False)

    def pair(self, problem: Problem, comparisons: Sequence[Comparison]) -> Pair:
        rng, d = generator(problem, comparisons, 9), len(problem.space.names)
        tried = compared_places(problem, comparisons)
        belief = believe_answers(problem.space, comparisons)
        count = 2 if belief is None else self.drawn
        net = draw_feasible(problem, lambda n: rng.random((n, d)), tried, count)
        if belief is not None:
            net = np.vstack([belief.most_liked(belief.places), belief.most_liked(net)])
        first, second = problem.space.of_unit(net)
        # neither place of the two is always the favourite's
        return (first, second) if rng.random() < 0.5 else (second, first)

    def best(self, problem: Problem, comparisons: Sequence[Comparison]) -> dict[str, float]:
        """Recommend the most liked design that was compared, see PairEngine."""
        belief = believe_answers(problem.space, comparisons)
        if belief is None:
            raise ModelError("no comparison is answered yet, so there is no favourite")
        return problem.space.of_unit(belief.most_liked(belief.places))[0]


def compared_places(problem: Problem, comparisons: Sequence[Comparison]) -> FloatArray:
    """Return the places, (2 n, d), of compared designs, pair by pair."""
    return problem.space.to_unit([design for one in comparisons for design in (one.first, one.second)])

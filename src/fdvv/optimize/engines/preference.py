"""What comparisons say of designs: a Gaussian process of worth, seen through answers that may err.

Chu and Ghahramani, Preference learning with Gaussian processes (2005): an answer is the sign of a
difference of worths plus noise; Laplace's approximation about the most probable worths. Worth has a variance
of 1, larger is better.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from fdvv.optimize._places import fresh, missing
from fdvv.optimize._space import DesignSpace
from fdvv.optimize._trial import Answer, Comparison
from fdvv.units import FloatArray

LENGTH = 0.4
"""Over which worth changes, ranges times the root of d: few answers cannot tell lengths, so it is given."""
NOISE = 0.3
"""SD of an answer's noise, parts of worth's own."""
STEPS = 50


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
    _solved: dict[str, FloatArray] = field(init=False, repr=False)

    def __post_init__(self) -> None:
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
        object.__setattr__(self, "_solved", {"a": slope, "B": 0.5 * (inner + inner.T), "worth": worth})

    def _bend(self, worth: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Give the gradient (n,) and negative Hessian (n, n) of the log likelihood at worths (n,)."""
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
        """Give mean (n,) and covariance (n, n) of the worth of places."""
        cross = self._kernel(places, self.places)
        cov = self._kernel(places) - cross @ self._solved["B"] @ cross.T
        return cross @ self._solved["a"], np.asarray(cov)

    def mean(self, places: FloatArray) -> FloatArray:
        """Give the mean worth of places, (n,)."""
        return np.asarray(self._kernel(places, self.places) @ self._solved["a"])


def believe_answers(space: DesignSpace, comparisons: Sequence[Comparison]) -> PreferenceBelief | None:
    """Learn from answered comparisons; None without any. BuildError without scikit-learn."""
    answered = [one for one in comparisons if one.answer is not None]
    if not answered:
        return None
    try:
        from sklearn.gaussian_process.kernels import Matern
    except ImportError as error:
        raise missing("preference", "optimize", error) from error
    both = space.to_unit([design for one in answered for design in (one.first, one.second)])
    places = fresh(both, np.empty((0, both.shape[1])))
    rows = np.abs(both[:, None] - places[None]).max(axis=2).argmin(axis=1).reshape(-1, 2)
    pairs, counts = [], []
    for (first, second), one in zip(rows.tolist(), answered, strict=True):
        if first == second:
            continue
        share = {Answer.FIRST: 1.0, Answer.SECOND: 0.0, Answer.EQUAL: 0.5}[one.answer or Answer.EQUAL]
        pairs += [(first, second), (second, first)]
        counts += [share, 1.0 - share]
    kernel = Matern(LENGTH * np.sqrt(both.shape[1]), nu=2.5)
    table = np.array(pairs, dtype=np.intp).reshape(-1, 2)
    return PreferenceBelief(places, table, np.array(counts), kernel)

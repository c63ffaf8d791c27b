"""Standard errors, sphericity and effect sizes from their definitions: slow, and nothing of fdvv in it."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import stats
from scipy.special import loggamma

Array = npt.NDArray[np.float64]


def mauchly(values: Array) -> tuple[float, float]:
    """Return W of (people, levels) and its exact p.

    W is the product of the eigenvalues of the double-centred covariance, over the power of their mean. Its
    moments under sphericity are known (Anderson 2003, 10.7): those of imaginary order are the characteristic
    function of log W, which is inverted (Gil-Pelaez 1951). Of three levels p is a power of W.
    """
    people, levels = values.shape
    df, n = levels - 1, people - 1
    middle = np.eye(levels) - 1 / levels
    roots = np.linalg.eigvalsh(middle @ np.cov(values, rowvar=False) @ middle)[1:]
    log_W = float(np.sum(np.log(roots)) - df * np.log(roots.mean()))
    if df == 2:
        return float(np.exp(log_W)), float(np.exp(log_W * (n - 1) / 2))
    step = 0.02
    at = (np.arange(30_000) + 0.5) * step
    h = 1j * at
    log_moment = df * h * np.log(df) + loggamma(n * df / 2) - loggamma(n * df / 2 + df * h)
    for i in range(df):
        log_moment += loggamma((n - i) / 2 + h) - loggamma((n - i) / 2)
    waves = np.imag(np.exp(log_moment - h * log_W)) / at
    return float(np.exp(log_W)), float(0.5 - np.sum(waves) * step / np.pi)


def generalized_eta2(scores: Array, effect: str) -> float:
    """Return that of "a", "b" or "ab" of (people, a, b): the effect over all but the other effects.

    Olejnik and Algina (2003): what lies below is the total less the sums of squares of the other effects.
    """
    grand, people = scores.mean(), len(scores)
    cells = scores.mean(axis=0)
    a, b = cells.mean(axis=1, keepdims=True) - grand, cells.mean(axis=0, keepdims=True) - grand
    parts = {"a": a + 0 * b, "b": b + 0 * a, "ab": cells - grand - a - b}
    squares = {name: people * float(np.sum(part**2)) for name, part in parts.items()}
    total = float(np.sum((scores - grand) ** 2))
    return squares[effect] / (total - sum(s for name, s in squares.items() if name != effect))


class OrdinalOnGrid:
    """A cumulative probit likelihood, people's intercepts and slopes summed on a fixed fine grid."""

    def __init__(self, ratings: Array, person: Any, x: Array, slope: bool, reach: float = 6.0) -> None:
        self.slope = slope
        used, category = np.unique(ratings, return_inverse=True)
        _, who = np.unique(person, return_inverse=True)
        self.cuts = used.size - 1
        self.counts = np.zeros((who.max() + 1, 2, used.size))
        np.add.at(self.counts, (who, x.astype(int), category), 1.0)
        at = np.linspace(-reach, reach, 49 if slope else 241)
        self.a, self.b = np.meshgrid(at, at if slope else np.zeros(1), indexing="ij")
        weight = stats.norm.pdf(at) * (at[1] - at[0])
        self.weight = np.outer(weight, weight if slope else np.ones(1))

    def __call__(self, flat: Array) -> float:
        """Return the log-likelihood of thresholds, the effect, and the lower triangle of the root's rows."""
        edges = np.concatenate([[-np.inf], flat[: self.cuts], [np.inf]])
        effect, root = flat[self.cuts], flat[self.cuts + 1 :]
        own = root[0] * self.a
        more = effect + (root[1] * self.a + root[2] * self.b if self.slope else 0.0)
        logs = []
        for x in (0.0, 1.0):
            bounds = edges[:, None, None] - (own + x * more)
            # the smaller tail of the two: no digits are lost
            share = np.where(
                bounds[:-1] > 0,
                stats.norm.sf(bounds[:-1]) - stats.norm.sf(bounds[1:]),
                stats.norm.cdf(bounds[1:]) - stats.norm.cdf(bounds[:-1]),
            )
            logs.append(np.log(np.maximum(share, 1e-300)))
        total = np.tensordot(self.counts, np.array(logs), axes=([1, 2], [0, 1]))
        peak = total.max(axis=(1, 2), keepdims=True)
        mass = (np.exp(total - peak) * self.weight).sum(axis=(1, 2))
        return float(np.sum(np.log(mass) + peak[:, 0, 0]))

    def slope_at(self, flat: Array, step: float = 1e-5) -> Array:
        places = np.eye(flat.size) * step
        return np.array([self(flat + one) - self(flat - one) for one in places]) / (2 * step)

    def error(self, flat: Array, step: float = 3e-4) -> float:
        """Return the standard error of the effect: the root of its place in the inverse of the Hessian."""
        # a step and half of it leave nothing of the third derivatives
        bend = (4 * self._bend(flat, step / 2) - self._bend(flat, step)) / 3
        variance = np.linalg.inv(-bend)[self.cuts, self.cuts]
        return float(np.sqrt(variance)) if variance > 0 else np.nan

    def _bend(self, flat: Array, step: float) -> Array:
        places = np.eye(flat.size) * step
        size, middle = flat.size, self(flat)
        bend = np.empty((size, size))
        for i in range(size):
            for j in range(i + 1):
                if i == j:
                    both = self(flat + places[i]) + self(flat - places[i])
                    bend[i, i] = (both - 2 * middle) / step**2
                    continue
                p, q = places[i], places[j]
                value = self(flat + p + q) - self(flat + p - q) - self(flat - p + q) + self(flat - p - q)
                bend[i, j] = bend[j, i] = value / (4 * step**2)
        return bend

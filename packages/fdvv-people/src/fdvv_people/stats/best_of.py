"""One condition against the best of several, when which is the best is itself not known."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray

LEVEL = 0.95
NODES = 48
"""Of the integral over the judged condition's own mean."""
DRAWS = 200
"""Of the unknown error, each as likely as the next."""


@dataclass(frozen=True)
class AgainstBest:
    """How much better one condition is than the best of the others.

    Attributes
    ----------
    blocks : in which each condition was measured once. best : which of the others had the best mean, from 0.
    difference : to that one, positive where the judged one is better. low, high : 95 % interval of the
        difference to whichever is the best in truth. chance : that none of the others is better.
    """

    blocks: int
    best: int
    difference: float
    low: float
    high: float
    chance: float


def against_best(scores: FloatArray) -> AgainstBest | None:
    """Compare a condition with the best of others measured in the same blocks; None below two blocks.

    scores : (blocks, 1 + others), larger is better; the first column is judged.

    Blocks may differ as a whole; what is left is taken as normal, with one error for all. The lower bound is
    the smallest of those against each other condition alone: the true best is one of them, so it errs in
    2.5 % at most (intersection-union, Berger 1982). The upper bound allows for the luckiest of them
    (one-sided Dunnett 1955, as in Hsu's comparisons with the best). The chance is the posterior probability
    under a flat prior for all means. With one other, all three are those of the paired t test.
    ModelError without another condition.
    """
    from scipy.stats import t as student

    blocks, conditions = scores.shape
    if conditions < 2:
        raise ModelError("a comparison with the best needs at least one other condition")
    if blocks < 2:
        return None
    means = scores.mean(axis=0)
    behind = means[0] - means[1:]
    best = int(np.argmin(behind))
    left = scores - scores.mean(axis=1, keepdims=True) - means + scores.mean()
    freedom = (blocks - 1) * (conditions - 1)
    error = float(np.sqrt(2 * np.sum(left**2) / freedom / blocks))
    nearest = float(behind[best])
    if error < 1e-12 * max(1.0, float(np.abs(means).max())):
        return AgainstBest(blocks, best, nearest, nearest, nearest, float(np.heaviside(nearest, 0.5)))
    low = nearest - float(student.ppf(0.5 + LEVEL / 2, freedom)) * error
    high = nearest + luckiest(conditions - 1, freedom) * error
    return AgainstBest(blocks, best, nearest, low, high, _all_below(behind / error, freedom))


@lru_cache(maxsize=64)
def luckiest(others: int, freedom: int) -> float:
    """Return what the largest of so many t statistics against one condition exceeds in 2.5 % of cases."""
    from scipy.optimize import brentq

    wanted = 0.5 + LEVEL / 2
    return float(brentq(lambda t: _all_below(np.full(others, t), freedom) - wanted, 0.0, 200.0))


def _all_below(t: FloatArray, freedom: int) -> float:
    """Return the chance that t statistics against one common condition are all below their limits, (n,)."""
    from scipy.special import ndtr, roots_hermitenorm
    from scipy.stats import chi2

    if t.size == 1:
        from scipy.stats import t as student

        return float(student.cdf(t[0], freedom))
    z, weight = roots_hermitenorm(NODES)
    error = np.sqrt(chi2.ppf((np.arange(DRAWS) + 0.5) / DRAWS, freedom) / freedom)
    limits = np.sqrt(2.0) * np.multiply.outer(error, t)
    below = np.ones((DRAWS, NODES))
    for limit in limits.T:
        below *= ndtr(limit[:, None] + z)
    return float(np.mean(below @ weight) / weight.sum())

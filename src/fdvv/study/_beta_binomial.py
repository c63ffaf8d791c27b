"""Counts of people whose own shares are drawn from a beta distribution, by maximum likelihood."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.study._effect_size import CONFIDENCE
from fdvv.units import FloatArray

MOST_ALIKE = 1.0 - 1e-9
"""Likeness of answers that is as good as 1: every person always says the same."""


@dataclass(frozen=True, eq=False)
class _Counts:
    """How many people had more than 0, 1, ... successes, failures and answers."""

    successes: FloatArray
    failures: FloatArray
    answers: FloatArray

    def log_likelihood(self, mean: float, alike: float) -> float:
        """Give it without the binomial coefficients; alike : 1 / (1 + a + b) of the beta distribution."""
        steps = np.arange(self.answers.size) * alike
        rest = 1.0 - alike
        with np.errstate(divide="ignore", invalid="ignore"):
            parts = (
                _times(self.successes, np.log(mean * rest + steps))
                + _times(self.failures, np.log((1 - mean) * rest + steps))
                - _times(self.answers, np.log(rest + steps))
            )
        return float(parts)


def beta_binomial_interval(successes: FloatArray, n: FloatArray) -> tuple[float, float]:
    """Give the bounds of the mean share by profile likelihood; 0 or 1 where nothing bounds it."""
    from scipy.optimize import brentq
    from scipy.stats import chi2

    counts = _counts(successes, n)
    mean = beta_binomial_fit(successes, n)[0]
    best = max(_profile(counts, mean), _profile(counts, float(np.sum(successes) / np.sum(n))))
    limit = float(chi2.ppf(CONFIDENCE, 1)) / 2

    def beyond(at: float) -> float:
        return best - _profile(counts, at) - limit

    edge = 1e-9
    low = 0.0 if mean <= edge or beyond(edge) < 0 else float(brentq(beyond, edge, mean, xtol=1e-10))
    high = 1.0 if mean >= 1 - edge or beyond(1 - edge) < 0 else float(brentq(beyond, mean, 1 - edge))
    return low, high


def beta_binomial_fit(successes: FloatArray, n: FloatArray) -> tuple[float, float]:
    """Give the most likely mean share and likeness of one person's answers (the beta's 1 / (1 + a + b))."""
    from scipy.optimize import minimize_scalar

    counts, total = _counts(successes, n), float(np.sum(successes) / np.sum(n))
    if total in (0.0, 1.0):
        return total, 0.0
    found = minimize_scalar(
        lambda mean: -_profile(counts, mean), bounds=(0.0, 1.0), method="bounded", options={"xatol": 1e-10}
    )
    mean = float(found.x)
    return mean, _best_alike(counts, mean)


def _profile(counts: _Counts, mean: float) -> float:
    return counts.log_likelihood(mean, _best_alike(counts, mean))


def _best_alike(counts: _Counts, mean: float) -> float:
    from scipy.optimize import minimize_scalar

    found = minimize_scalar(
        lambda alike: -counts.log_likelihood(mean, alike),
        bounds=(0.0, MOST_ALIKE),
        method="bounded",
        options={"xatol": 1e-10},
    )
    ends = (0.0, MOST_ALIKE, float(found.x))
    return max(ends, key=lambda alike: counts.log_likelihood(mean, alike))


def _counts(successes: FloatArray, n: FloatArray) -> _Counts:
    places = np.arange(int(np.max(n)))
    more = [np.sum(column[:, np.newaxis] > places, axis=0) for column in (successes, n - successes, n)]
    return _Counts(*(np.asarray(one, dtype=np.float64) for one in more))


def _times(count: FloatArray, log: FloatArray) -> float:
    """Sum logarithms, of which those that nobody needs may be infinite."""
    return float(np.sum(count * np.where(count > 0, log, 0.0)))

"""Two alternatives with "equal" allowed: d' and how wide "equal" is, by maximum likelihood.

The felt difference of two stimuli is normal about d' with variance 2. Beyond tau on either side a stimulus is
named, between it is called equal (Braun, Rogeaux, Schneid, O'Mahony and Rousseau 2004; Christensen, Lee and
Brockhoff 2012). Three shares, two unknowns: the model fits every table.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fdvv.errors import ModelError
from fdvv.study._effect_size import CONFIDENCE
from fdvv.study._share import sign_p
from fdvv.study._thurstone import DPrime

if TYPE_CHECKING:
    from collections.abc import Callable

ROOT_2 = math.sqrt(2)
WIDEST = 40.0
"""Distance, in d', that is as good as infinite."""


def two_ac(first: float, equal: float, second: float) -> DPrime:
    """Give d' of a 2-AC task: how often the first, neither, and the second was named.

    d' is positive where the second is named more often. The interval is that of the profile likelihood; a
    bound that the answers do not set is infinite. p is the exact binomial one of the answers that named
    either, which holds whatever tau is. With nobody naming the first d' is infinite and only low tells
    something; with all equal d' is nan between infinities. ModelError on counts that cannot be.
    """
    counts = (first, equal, second)
    n = sum(counts)
    if min(counts) < 0 or n == 0:
        raise ModelError(f"a 2-AC task needs at least one answer, got {first}, {equal} and {second}")
    d, tau = _most_likely(*counts)
    low, high = _profile_bounds(counts, d)
    p = sign_p(round(second), round(first))
    return DPrime(d, low, high, p, round(second), round(n), "2ac, profile likelihood", tau)


def shares_2ac(d: float, tau: float) -> tuple[float, float, float]:
    """Give the shares that name the first, neither and the second."""
    # of the two ways to write the middle the one whose parts are small, so that nothing is lost
    return _tail(tau + d), _tail(abs(d) - tau) - _tail(abs(d) + tau), _tail(tau - d)


def _most_likely(first: float, equal: float, second: float) -> tuple[float, float]:
    """Solve the two shares of the ends for d' and tau."""
    from scipy.special import ndtri

    n = first + equal + second
    lower, upper = (ROOT_2 * float(ndtri(one / n)) for one in (first, second))
    if math.isinf(lower) and math.isinf(upper):
        # one end alone, or none: what is not named is as far as one likes, on which side nobody can say
        return (math.nan, math.inf) if equal == n else (math.inf if second else -math.inf, 0.0)
    tau = 0.0 if equal == 0 else -(lower + upper) / 2
    return (upper - lower) / 2, tau


def _profile_bounds(counts: tuple[float, float, float], d: float) -> tuple[float, float]:
    """Give where the likelihood, at its best tau, has fallen by half the quantile of chi-squared."""
    from scipy.stats import chi2

    if math.isnan(d):
        return -math.inf, math.inf
    limit = float(chi2.ppf(CONFIDENCE, 1))

    def beyond(at: float) -> float:
        return _deviance(counts, at) - limit

    start = min(max(d, -WIDEST), WIDEST)
    return _bound(beyond, start, -1), _bound(beyond, start, 1)


def _bound(beyond: Callable[[float], float], start: float, way: int) -> float:
    from scipy.optimize import brentq

    if abs(start) >= WIDEST and start * way > 0:
        return start * math.inf
    step = 1.0
    while beyond(start + way * step) < 0:
        step *= 2
        if step > 4 * WIDEST:
            return way * math.inf
    low, high = sorted((start, start + way * step))
    return float(brentq(beyond, low, high, xtol=1e-10))


def _deviance(counts: tuple[float, float, float], d: float) -> float:
    """Give twice what the likelihood at d' and its best tau lacks of the best there is."""
    from scipy.optimize import minimize_scalar

    n = sum(counts)
    best = sum(one * math.log(one / n) for one in counts if one)
    if counts[1] == 0:
        return 2 * (best - _log_likelihood(counts, d, 0.0))
    found = minimize_scalar(
        lambda log_tau: -_log_likelihood(counts, d, math.exp(log_tau)),
        bounds=(-12.0, math.log(abs(d) + 12.0)),
        method="bounded",
        options={"xatol": 1e-9},
    )
    return 2 * (best + float(found.fun))


def _log_likelihood(counts: tuple[float, float, float], d: float, tau: float) -> float:
    from scipy.special import log_ndtr

    first, equal, second = counts
    total = 0.0
    if first:
        total += first * float(log_ndtr((-tau - d) / ROOT_2))
    if equal:
        total += equal * math.log(max(shares_2ac(d, tau)[1], 1e-300))
    if second:
        total += second * float(log_ndtr((d - tau) / ROOT_2))
    return total


def _tail(x: float) -> float:
    """Give the chance that the felt difference lies x above its middle."""
    return 0.5 * math.erfc(x / 2)

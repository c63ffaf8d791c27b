"""Two alternatives with "equal" allowed: d' and how wide "equal" is, by maximum likelihood.

The felt difference of two stimuli is normal about d' with variance 2. Beyond tau on either side a stimulus is
named, between it is called equal (Braun, Rogeaux, Schneid, O'Mahony and Rousseau 2004; Christensen, Lee and
Brockhoff 2012). Three shares, two unknowns: the model fits every table.

Several people who gave many answers each have their own d', normal about the population's, and share one tau
(Christensen, Lee and Brockhoff 2012: a cumulative probit model with a person's intercept).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.stats.effect_size import CONFIDENCE
from fdvv_people.stats.ordinal_fit import FLATTEST, fitted, gathered
from fdvv_people.stats.share import effective_answers, sign_p
from fdvv_people.stats.thurstone import DPrime

if TYPE_CHECKING:
    from collections.abc import Callable

ROOT_2 = math.sqrt(2)
WIDEST = 40.0
"""Distance, in d', that is as good as infinite."""

NODES = 15  # as `ordinal.NODES`, of the same fit: with 9 an error was off by up to 3 % where answers are few


def two_ac(first: float, equal: float, second: float) -> DPrime:
    """Return d' of a 2-AC task: how often the first, neither, and the second was named.

    d' is positive where the second is named more often. The interval is that of the profile likelihood; a
    bound that the answers do not set is infinite. p is the exact binomial one of the answers that named
    either, which holds whatever tau is. With nobody naming the first d' is infinite and only low says
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
    """Return the shares that name the first, neither and the second."""
    # the form of the middle share whose parts are small, so that no digits cancel
    return _tail(tau + d), _tail(abs(d) - tau) - _tail(abs(d) + tau), _tail(tau - d)


def _most_likely(first: float, equal: float, second: float) -> tuple[float, float]:
    from scipy.special import ndtri

    n = first + equal + second
    lower, upper = (ROOT_2 * float(ndtri(one / n)) for one in (first, second))
    if math.isinf(lower) and math.isinf(upper):
        # one end alone, or none: what is not named is as far as one likes, on which side nobody can say
        return (math.nan, math.inf) if equal == n else (math.inf if second else -math.inf, 0.0)
    tau = 0.0 if equal == 0 else -(lower + upper) / 2
    return (upper - lower) / 2, tau


def _profile_bounds(counts: tuple[float, float, float], d: float) -> tuple[float, float]:
    """Return where the likelihood, at its best tau, has fallen by half the quantile of chi-squared."""
    from scipy.stats import chi2

    if math.isnan(d):
        return -math.inf, math.inf
    limit = float(chi2.ppf(CONFIDENCE, 1))

    start = min(max(d, -WIDEST), WIDEST)
    low, high = (_bound(lambda at: _deviance(counts, at) - limit, start, direction) for direction in (-1, 1))
    return low, high


def _bound(beyond: Callable[[float], float], start: float, direction: int) -> float:
    from scipy.optimize import brentq

    if abs(start) >= WIDEST and start * direction > 0:
        return start * math.inf
    step = 1.0
    while beyond(start + direction * step) < 0:
        step *= 2
        if step > 4 * WIDEST:
            return direction * math.inf
    low, high = sorted((start, start + direction * step))
    return float(brentq(beyond, low, high, xtol=1e-10))


def _deviance(counts: tuple[float, float, float], d: float) -> float:
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

    first, second = (float(log_ndtr(at / ROOT_2)) for at in (-tau - d, d - tau))
    logs = first, math.log(max(shares_2ac(d, tau)[1], 1e-300)), second
    # an answer that nobody gave counts nothing, though its log may be infinite
    return sum(count * log for count, log in zip(counts, logs, strict=True) if count)


def _tail(x: float) -> float:
    return 0.5 * math.erfc(x / 2)


@dataclass(frozen=True)
class PeopleDPrime:
    """d' of a population from its people's 2-AC answers.

    Attributes
    ----------
    all : of the population; its p is the sign test of people who named the second more often, or less.
    person_sd : standard deviation of people's own d'; nan where it could not be estimated. each : their d'.
    """

    all: DPrime
    person_sd: float
    each: tuple[DPrime, ...]


def two_ac_people(counts: npt.ArrayLike) -> PeopleDPrime:
    """Fit counts (people, 3) of naming the first, neither, and the second; who gave none is left out.

    The interval is Wald's. Where some kind of answer is never given the mixed model does not bound d': then
    two_ac of as many answers as the spread between people leaves. ModelError below 2 people.
    """
    found = np.asarray(counts, dtype=np.float64)
    if found.ndim != 2 or found.shape[1] != 3 or np.any(found < 0):
        raise ModelError(f"2-AC counts are (people, 3) and not negative, got the shape {found.shape}")
    found = found[found.sum(axis=1) > 0]
    if len(found) < 2:
        raise ModelError(f"d' of a population needs at least 2 people with answers, got {len(found)}")
    each = tuple(two_ac(*(int(one) for one in row)) for row in found)
    p = sign_p(int(np.sum(found[:, 2] > found[:, 0])), int(np.sum(found[:, 2] < found[:, 0])))
    mixed = _mixed(found, p) if np.all(found.sum(axis=0) > 0) else None
    return PeopleDPrime(*(mixed or (_counted(found, p), math.nan)), each)


def _mixed(counts: FloatArray, p: float) -> tuple[DPrime, float] | None:
    """Fit the mixed model; None where it has no maximum that bends."""
    from scipy.special import ndtri

    people, answers = (np.repeat(at.ravel(), counts.ravel().astype(int)) for at in np.indices(counts.shape))
    fit = fitted(gathered(answers, people, np.empty((len(answers), 0))), NODES)
    lower, upper = fit.point.thresholds
    variance = float(fit.covariance[:2, :2].sum()) / 2
    if fit.slope > FLATTEST or not variance > 0:
        return None
    d, half = -(lower + upper) / ROOT_2, float(ndtri(0.5 + CONFIDENCE / 2)) * math.sqrt(variance)
    method = "2ac, mixed model, Wald"
    first, equal, second = (int(one) for one in counts.sum(axis=0))
    n, tau = first + equal + second, float(upper - lower) / ROOT_2
    found = DPrime(float(d), float(d - half), float(d + half), p, second, n, method, tau, len(counts))
    return found, ROOT_2 * abs(float(fit.point.factor[0, 0]))


def _counted(counts: FloatArray, p: float) -> DPrime:
    n, totals = counts.sum(axis=1), counts.sum(axis=0)
    part = min(effective_answers(column, n) for column in counts.T if column.any()) / float(n.sum())
    plain = two_ac(*totals.tolist())
    fewer = two_ac(*(totals * part).tolist())
    method = "2ac, profile likelihood of the answers that people leave"
    return DPrime(
        plain.d, fewer.low, fewer.high, p, int(totals[2]), int(n.sum()), method, plain.tau, len(counts)
    )

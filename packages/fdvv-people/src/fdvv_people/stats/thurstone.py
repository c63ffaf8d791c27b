"""How far apart two stimuli feel: Thurstone's d' from shares of correct answers.

d' is the distance of two stimuli on the felt dimension in standard deviations of one feeling. Each protocol
turns it into a share of correct answers by what a person has to compare.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from fdvv_people.stats.share import Share, binomial_p, share

AbxRule = Literal["differencing", "independent"]
"""differencing: X is said to be whichever of A and B it is nearer to. independent: each of A, B and X is held
against the middle between the two, the best that can be done where both are known well."""

FARTHEST = 12.0
"""d' beyond which every protocol's share of correct answers is 1 in double precision."""


@dataclass(frozen=True)
class DPrime:
    """A sensory difference.

    Attributes
    ----------
    d : maximum likelihood; infinite where every answer is correct. low, high : bounds of the 95 % interval;
        high is infinite where the answers set no bound, and the interval is then one-sided in effect.
    p : exact and two-sided for 2-AFC and 2-AC; exact against guessing, one-sided, where d' has no sign.
    correct, n : answers it rests on. method : protocol and interval.
    tau : 2-AC: what may differ and still be called equal, in the unit of d; else None.
    people : counted as such, else None.
    """

    d: float
    low: float
    high: float
    p: float
    correct: int
    n: int
    method: str
    tau: float | None = None
    people: int | None = None


def d_prime_2afc(correct: int, n: int) -> DPrime:
    """Return d' of two-alternative forced choice, with its sign: pc = Φ(d' / √2) (Green and Swets 1966).

    The interval is Clopper and Pearson's of the share. Also for a preference: d' is then the distance in what
    is preferred.
    """
    return _transformed(correct, n, share_2afc, "2afc", signed=True)


def d_prime_abx(correct: int, n: int, rule: AbxRule = "differencing") -> DPrime:
    """Return d' of strict ABX: X is A or B (Macmillan and Creelman 2005, chapter 9).

    differencing : pc = Φ(d'/√2) Φ(d'/√6) + Φ(-d'/√2) Φ(-d'/√6). independent : with d'/2 in place of d'/√6.
    Below one half d' is 0: this task has no direction.
    """
    function = share_duo_trio if rule == "differencing" else share_abx_independent
    return _transformed(correct, n, function, f"abx, {rule}", signed=False)


def d_prime_duo_trio(correct: int, n: int) -> DPrime:
    """Return d' of duo-trio: which of two is the reference? The same function as ABX by differencing."""
    return _transformed(correct, n, share_duo_trio, "duo-trio", signed=False)


def share_2afc(d: float) -> float:
    return _phi(d / math.sqrt(2))


def share_duo_trio(d: float) -> float:
    """Return the share of correct answers of duo-trio and of ABX by differencing."""
    return _both_or_neither(d / math.sqrt(2), d / math.sqrt(6))


def share_abx_independent(d: float) -> float:
    """Return the share of correct answers of ABX where A, B and X are judged each for itself."""
    return _both_or_neither(d / math.sqrt(2), d / 2)


def d_prime_of_share(correct: float, function: Callable[[float], float], signed: bool = False) -> float:
    """Turn a share of correct answers into d'; infinite at 1, and 0 below one half where it has no sign."""
    from scipy.optimize import brentq

    if correct < 0.5:
        return -d_prime_of_share(1.0 - correct, function) if signed else 0.0
    if correct >= function(FARTHEST):
        return math.inf
    return float(brentq(lambda d: function(d) - correct, 0.0, FARTHEST, xtol=1e-12))


def d_prime_of_people(found: Share, protocol: Literal["2afc", "abx", "duo-trio"]) -> DPrime:
    """Turn a share whose interval counts people as people (clustered_share) into d', bound by bound.

    p is nan: test people's own shares, as signed_rank or sign_test of them less one half.
    """
    function = share_2afc if protocol == "2afc" else share_duo_trio
    d, low, high = (
        d_prime_of_share(one, function, protocol == "2afc") for one in (found.share, found.low, found.high)
    )
    return DPrime(
        d, low, high, math.nan, found.successes, found.n, f"{protocol}, {found.method}", None, found.people
    )


def _transformed(correct: int, n: int, function: Callable[[float], float], name: str, signed: bool) -> DPrime:
    from scipy.stats import binom

    found = share(correct, n, "clopper-pearson")
    d, low, high = (d_prime_of_share(one, function, signed) for one in (found.share, found.low, found.high))
    # without a sign fewer correct answers than by guessing speak for no difference
    p = float(binomial_p(correct, n) if signed else binom.sf(correct - 1, n, 0.5))
    return DPrime(d, low, high, p, int(correct), int(n), f"{name}, Clopper-Pearson")


def _both_or_neither(a: float, b: float) -> float:
    """Return the chance that two judgements are both right, or both wrong: then the answer is right too."""
    return _phi(a) * _phi(b) + _phi(-a) * _phi(-b)


def _phi(x: float) -> float:
    return 0.5 * math.erfc(-x / math.sqrt(2))

"""A share of answers with its interval and its exact test, every answer counted as independent."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.stats.effect_size import CONFIDENCE, bca

ShareMethod = Literal["wilson", "clopper-pearson"]
MOST_ALIKE = 1.0 - 1e-9
"""Likeness of answers that is as good as 1: every person always says the same."""

ClusteredMethod = Literal["korn-graubard", "beta-binomial", "bootstrap"]


@dataclass(frozen=True)
class Share:
    """A share with its 95 % interval.

    Attributes
    ----------
    share : successes / n. method : how the interval was made. people : counted as such; None where every
        answer counts as independent. icc : how alike the answers of one person are, 0 to 1, where judged.
    """

    share: float
    low: float
    high: float
    method: str
    successes: int
    n: int
    people: int | None = None
    icc: float | None = None


@dataclass(frozen=True)
class SignTest:
    """How many differ upwards and downwards; p : exact, two-sided, who does not differ left out."""

    plus: int
    minus: int
    zeros: int
    p: float


def share(successes: int, n: int, method: ShareMethod = "wilson") -> Share:
    """Return a share of n independent answers. ModelError on counts that cannot be."""
    low, high = (wilson if method == "wilson" else clopper_pearson)(successes, n)
    return Share(successes / n, float(low), float(high), method, int(successes), int(n))


def wilson(successes: npt.ArrayLike, n: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Return the score interval (Wilson 1927): near 95 % on average. Arrays of any one shape."""
    from scipy.special import ndtri

    k, n = _counts(successes, n)
    z = float(ndtri(0.5 + CONFIDENCE / 2))
    middle = (k + z**2 / 2) / (n + z**2)
    half = z * np.sqrt(k * (n - k) / n + z**2 / 4) / (n + z**2)
    return np.where(k == 0, 0.0, middle - half), np.where(k == n, 1.0, middle + half)


def clopper_pearson(successes: npt.ArrayLike, n: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Return the exact interval (Clopper and Pearson 1934): never below 95 %. Counts may be fractional."""
    from scipy.special import betaincinv

    k, n = _counts(successes, n)
    tail = (1 - CONFIDENCE) / 2
    with np.errstate(invalid="ignore"):
        low = np.where(k > 0, betaincinv(np.where(k > 0, k, 1), n - k + 1, tail), 0.0)
        high = np.where(k < n, betaincinv(k + 1, np.where(k < n, n - k, 1), 1 - tail), 1.0)
    return low, high


def binomial_p(successes: npt.ArrayLike, n: npt.ArrayLike, chance: float = 0.5) -> FloatArray:
    """Return the exact two-sided p: all counts no likelier than the observed one, as in R and SciPy.

    Arrays of any one shape. 1 where n is 0: no answer speaks against chance.
    """
    k, n = np.broadcast_arrays(np.asarray(successes), np.asarray(n))
    pairs, back = np.unique(np.column_stack([k.ravel(), n.ravel()]), axis=0, return_inverse=True)
    p = np.array([_binomial_p(int(a), int(b), chance) for a, b in pairs])
    return np.asarray(p[back.ravel()].reshape(k.shape))


def sign_test(differences: npt.ArrayLike) -> SignTest:
    """Test whether more people differ upwards than downwards; nan where missing."""
    found = np.asarray(differences, dtype=np.float64)
    plus, minus = int(np.sum(found > 0)), int(np.sum(found < 0))
    return SignTest(plus, minus, int(np.sum(found == 0)), sign_p(plus, minus))


def sign_p(plus: int, minus: int) -> float:
    """Return the exact two-sided chance of so uneven a toss of signs; 1 where there is none."""
    return float(binomial_p(plus, plus + minus))


def _binomial_p(successes: int, n: int, chance: float) -> float:
    from scipy.stats import binom

    if not 0 <= successes <= n:
        raise ModelError(f"{successes} of {n} is no count of answers")
    chances = binom.pmf(np.arange(n + 1), n, chance)
    # equal chances may differ in the last digits
    return min(1.0, float(np.sum(chances[chances <= chances[successes] * (1 + 1e-7)])))


def _counts(successes: npt.ArrayLike, n: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
    k, n = np.asarray(successes, dtype=np.float64), np.asarray(n, dtype=np.float64)
    if np.any(n <= 0) or np.any(k < 0) or np.any(k > n):
        raise ModelError(f"a share needs 0 to n successes of at least 1 answer, got {successes!r} of {n!r}")
    return k, n


def beta_binomial_interval(successes: FloatArray, n: FloatArray) -> tuple[float, float]:
    """Return the bounds of the mean share by profile likelihood; 0 or 1 where nothing bounds it."""
    from scipy.optimize import brentq
    from scipy.stats import chi2

    counts = _counts_above(successes, n)
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
    """Return the most likely mean share and likeness of one person's answers (the beta's 1 / (1 + a + b))."""
    from scipy.optimize import minimize_scalar

    counts, total = _counts_above(successes, n), float(np.sum(successes) / np.sum(n))
    if total in (0.0, 1.0):
        return total, 0.0
    found = minimize_scalar(
        lambda mean: -_profile(counts, mean), bounds=(0.0, 1.0), method="bounded", options={"xatol": 1e-10}
    )
    mean = float(found.x)
    return mean, _best_alike(counts, mean)


def _profile(counts: FloatArray, mean: float) -> float:
    return _log_likelihood(counts, mean, _best_alike(counts, mean))


def _best_alike(counts: FloatArray, mean: float) -> float:
    from scipy.optimize import minimize_scalar

    def falling(alike: float) -> float:
        return -_log_likelihood(counts, mean, alike)

    found = minimize_scalar(falling, bounds=(0.0, MOST_ALIKE), method="bounded", options={"xatol": 1e-10})
    # a bounded search never tries its ends, where all answers are independent, or one person's all alike
    return min((0.0, MOST_ALIKE, float(found.x)), key=falling)


def _counts_above(successes: FloatArray, n: FloatArray) -> FloatArray:
    """Count the people who had more than 0, 1, ... successes, failures and answers, (3, most answers)."""
    places = np.arange(int(np.max(n)))
    return np.array([np.sum(c[:, np.newaxis] > places, axis=0) for c in (successes, n - successes, n)], float)


def _log_likelihood(counts: FloatArray, mean: float, alike: float) -> float:
    """Return it without the binomial coefficients; alike : 1 / (1 + a + b) of the beta distribution."""
    steps, rest = np.arange(counts.shape[1]) * alike, 1.0 - alike
    with np.errstate(divide="ignore", invalid="ignore"):
        logs = np.log([mean * rest + steps, (1 - mean) * rest + steps, rest + steps])
    # a step that nobody reached counts nothing, though its log may be infinite
    successes, failures, answers = np.sum(counts * np.where(counts > 0, logs, 0.0), axis=1)
    return float(successes + failures - answers)


def clustered_share(
    successes: npt.ArrayLike, n: npt.ArrayLike, method: ClusteredMethod = "korn-graubard", seed: int = 0
) -> Share:
    """Return a share of all answers with an interval over people.

    successes, n : (people,) each; who gave no answer is left out.

    - korn-graubard: Clopper and Pearson's interval of as many answers as the spread between people leaves,
      never more than there are (Korn and Graubard 1998). Where all answers are alike people alone count.
    - beta-binomial: people's own shares spread as a beta distribution; profile likelihood of their mean.
      share stays the plain one.
    - bootstrap: people drawn again and again, BCa; too narrow below some 20 people.

    ModelError below 2 people.
    """
    k, n = np.asarray(successes, dtype=np.float64), np.asarray(n, dtype=np.float64)
    if k.shape != n.shape or k.ndim != 1 or np.any(k < 0) or np.any(k > n):
        raise ModelError("a clustered share needs 0 to n successes for each person")
    k, n = k[n > 0], n[n > 0]
    if k.size < 2:
        raise ModelError(f"a clustered share needs at least 2 people with answers, got {k.size}")
    found = float(k.sum() / n.sum())
    low, high = _interval(k, n, method, seed)
    return Share(found, low, high, method, int(k.sum()), int(n.sum()), k.size, intraclass_correlation(k, n))


def share_of_totals(successes: int, n: int, people: int, icc: float) -> Share:
    """Return a share of which only totals are printed, for an assumed likeness of one person's answers.

    icc : 0 counts all n answers, 1 counts people; 1 + (n / people - 1) icc answers count as one (Kish 1965).
    """
    counted = n / (1.0 + (n / people - 1.0) * icc)
    low, high = clopper_pearson(successes / n * counted, counted)
    return Share(successes / n, float(low), float(high), "design effect", successes, n, people, icc)


def intraclass_correlation(successes: npt.ArrayLike, n: npt.ArrayLike) -> float:
    """Estimate how alike one person's answers are from the analysis of variance, cut to 0 to 1 (Fleiss 1981).

    nan where every person gave one answer only.
    """
    k, n = np.asarray(successes, dtype=np.float64), np.asarray(n, dtype=np.float64)
    people, total = k.size, n.sum()
    if total == people:
        return float("nan")
    between = np.sum(n * (k / n - k.sum() / total) ** 2) / (people - 1)
    within = np.sum(k * (n - k) / n) / (total - people)
    typical = (total - np.sum(n**2) / total) / (people - 1)
    spread = between + (typical - 1) * within
    return float(np.clip((between - within) / spread, 0.0, 1.0)) if spread > 0 else 0.0


def _interval(k: FloatArray, n: FloatArray, method: ClusteredMethod, seed: int) -> tuple[float, float]:
    if method == "beta-binomial":
        return beta_binomial_interval(k, n)
    if method == "bootstrap":
        found = bca(lambda k, n, axis: np.sum(k, axis=axis) / np.sum(n, axis=axis), (k, n), seed)
        if found.low is not None and found.high is not None:
            return found.low, found.high
        # people too few or too alike to resample: the default method always has bounds
    counted = effective_answers(k, n)
    low, high = clopper_pearson(k.sum() / n.sum() * counted, counted)
    return float(low), float(high)


def effective_answers(successes: FloatArray, n: FloatArray) -> float:
    """Return how many independent answers say as much as these of people, from how people spread.

    Never more than there are; as many as people where all answers are alike, for that shows no spread.
    """
    from scipy.stats import t as student

    people, total = successes.size, float(n.sum())
    found = float(successes.sum()) / total
    if found in (0.0, 1.0):
        return float(people)
    variance = people / (people - 1) * float(np.sum((successes - found * n) ** 2)) / total**2
    if variance == 0 or total == people:
        return total
    tail = 0.5 + CONFIDENCE / 2
    fewer = float(student.ppf(tail, total - 1) / student.ppf(tail, people - 1)) ** 2
    return min(total, found * (1 - found) / variance * fewer)

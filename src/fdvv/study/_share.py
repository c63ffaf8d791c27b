"""A share of answers with its interval and its exact test, every answer counted as independent."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.study._effect_size import CONFIDENCE
from fdvv.units import FloatArray

ShareMethod = Literal["wilson", "clopper-pearson"]


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
    """Give a share of n independent answers. ModelError on counts that cannot be."""
    low, high = (wilson if method == "wilson" else clopper_pearson)(successes, n)
    return Share(successes / n, float(low), float(high), method, int(successes), int(n))


def wilson(successes: npt.ArrayLike, n: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Give the score interval (Wilson 1927): near 95 % on average. Arrays of any one shape."""
    from scipy.special import ndtri

    k, n = _counts(successes, n)
    z = float(ndtri(0.5 + CONFIDENCE / 2))
    middle = (k + z**2 / 2) / (n + z**2)
    half = z * np.sqrt(k * (n - k) / n + z**2 / 4) / (n + z**2)
    return np.where(k == 0, 0.0, middle - half), np.where(k == n, 1.0, middle + half)


def clopper_pearson(successes: npt.ArrayLike, n: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Give the exact interval (Clopper and Pearson 1934): never below 95 %. Counts may be broken numbers."""
    from scipy.special import betaincinv

    k, n = _counts(successes, n)
    tail = (1 - CONFIDENCE) / 2
    with np.errstate(invalid="ignore"):
        low = np.where(k > 0, betaincinv(np.where(k > 0, k, 1), n - k + 1, tail), 0.0)
        high = np.where(k < n, betaincinv(k + 1, np.where(k < n, n - k, 1), 1 - tail), 1.0)
    return low, high


def binomial_p(successes: npt.ArrayLike, n: npt.ArrayLike, chance: float = 0.5) -> FloatArray:
    """Give the exact two-sided p: all counts that are no likelier than the one found, as R and SciPy have it.

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
    """Give the exact two-sided chance of so uneven a toss of signs; 1 where there is none."""
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

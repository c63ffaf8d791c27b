"""Wilcoxon's signed-rank test of people's differences, with ties, zeros and missing people done right.

Everything follows from the ranks that a sign may turn: their sum of squares is the variance with its
correction for ties, and their subset sums are the exact distribution. No table without ties is used anywhere.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.study._effect_size import CONFIDENCE
from fdvv.study._signed_rank_exact import lower_tail, untied_quantile
from fdvv.units import FloatArray

Zeros = Literal["wilcoxon", "pratt"]
"""wilcoxon: who does not differ is left out before ranking (1945; SPSS, R). pratt: ranked, then left out
(1959), so that many who do not differ weaken what the others say."""

SAME = 1e-9
"""Part of the largest difference below which two of them are the same: means of ratings carry rounding."""


@dataclass(frozen=True)
class SignedRank:
    """One test, two-sided.

    Attributes
    ----------
    n : people with a difference, those of 0 included. zeros : of them differ by 0. missing : have none.
    w_plus, w_minus : sums of the ranks of positive and of negative differences. statistic : the smaller.
    z : of the smaller sum, so never positive, with the correction for ties and none for continuity: as SPSS
        prints it. p_asymptotic : of z. p_corrected : of z with half a rank for continuity, as R has it.
    p_exact : share of all 2^k turns of the k signs whose sums lie as far apart, ties and zeros as they are.
    effect : matched-pairs rank-biserial correlation, (w_plus - w_minus) / (w_plus + w_minus) (Kerby 2014);
        1 where everybody differs upwards. 0 where nobody differs.
    shift : Hodges and Lehmann's: median of all means of two differences. low, high : of the shift, at least
        95 % by the exact distribution (Hollander, Wolfe and Chicken 2014, 3.23); None below 6 people.
    """

    n: int
    zeros: int
    missing: int
    w_plus: float
    w_minus: float
    statistic: float
    z: float
    p_asymptotic: float
    p_corrected: float
    p_exact: float
    effect: float
    shift: float
    low: float | None
    high: float | None


@dataclass(frozen=True, eq=False)
class SignedRanks:
    """The tests of many studies, (studies,) each; see SignedRank. p_exact is nan where not asked for."""

    w_plus: FloatArray
    w_minus: FloatArray
    z: FloatArray
    p_asymptotic: FloatArray
    p_corrected: FloatArray
    p_exact: FloatArray
    effect: FloatArray


def signed_rank(differences: npt.ArrayLike, zeros: Zeros = "wilcoxon") -> SignedRank:
    """Test whether people's differences lie to one side of 0.

    differences : (people,), nan where missing. One number a person: average rounds before. Raises ModelError
    where nobody has a difference.
    """
    found = np.asarray(differences, dtype=np.float64)
    if found.ndim != 1:
        raise ModelError(f"a signed-rank test needs one difference a person, got the shape {found.shape}")
    there = found[~np.isnan(found)]
    if there.size == 0 or np.isinf(there).any():
        raise ModelError(
            "a signed-rank test needs at least one person with a difference, none of it infinite"
        )
    many = signed_ranks(there[np.newaxis], zeros)
    shift, low, high = _shift(there)
    return SignedRank(
        n=there.size,
        zeros=int(np.sum(_snapped(there) == 0)),
        missing=found.size - there.size,
        w_plus=float(many.w_plus[0]),
        w_minus=float(many.w_minus[0]),
        statistic=float(min(many.w_plus[0], many.w_minus[0])),
        z=float(many.z[0]),
        p_asymptotic=float(many.p_asymptotic[0]),
        p_corrected=float(many.p_corrected[0]),
        p_exact=float(many.p_exact[0]),
        effect=float(many.effect[0]),
        shift=shift,
        low=low,
        high=high,
    )


def signed_ranks(differences: npt.ArrayLike, zeros: Zeros = "wilcoxon", exact: bool = True) -> SignedRanks:
    """Test many studies at once: differences (studies, people), nan where missing.

    A study in which nobody differs has z 0 and p 1. exact : False leaves out the slower p_exact.
    """
    from scipy.special import ndtr

    found = np.asarray(differences, dtype=np.float64)
    if found.ndim != 2:
        raise ModelError(f"differences of many studies are (studies, people), got the shape {found.shape}")
    found = _snapped(found)
    ranks = turnable_ranks(found, zeros)
    plus, minus = np.sum(ranks * (found > 0), axis=1), np.sum(ranks * (found < 0), axis=1)
    smaller, spread = np.minimum(plus, minus), 0.5 * np.sqrt(np.sum(ranks**2, axis=1))
    below = smaller - 0.5 * (plus + minus)
    with np.errstate(invalid="ignore", divide="ignore"):
        z = np.where(spread > 0, below / spread, 0.0)
        corrected = np.where(spread > 0, np.minimum(below + 0.5, 0.0) / spread, 0.0)
        effect = np.where(spread > 0, (plus - minus) / (plus + minus), 0.0)
    p_exact = np.minimum(1.0, 2.0 * lower_tail(ranks, smaller)) if exact else np.full(len(z), np.nan)
    return SignedRanks(plus, minus, z, 2 * ndtr(z), 2 * ndtr(corrected), p_exact, effect)


def turnable_ranks(differences: FloatArray, zeros: Zeros = "wilcoxon") -> FloatArray:
    """Rank the sizes of differences along the last axis, ties in the middle; 0 where no sign can turn."""
    from scipy.stats import rankdata

    sizes = np.abs(differences)
    # what must not be counted is ranked last, where it moves no other
    left_out = np.isnan(sizes) | ((sizes == 0) & (zeros == "wilcoxon"))
    ranks = rankdata(np.where(left_out, np.inf, sizes), axis=-1)
    return np.where(left_out | (sizes == 0), 0.0, ranks)


def _snapped(differences: FloatArray) -> FloatArray:
    """Make differences that are the same but for rounding the same, row by row."""
    if differences.size == 0:
        return differences
    largest = np.nanmax(np.abs(differences), axis=-1, keepdims=True, initial=0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.where(largest > 0, np.round(differences / (SAME * largest)), differences))


def _shift(differences: FloatArray) -> tuple[float, float | None, float | None]:
    """Give the median of the means of two differences and the bounds that the exact test does not reject."""
    n = differences.size
    first, second = np.triu_indices(n)
    means = np.sort((differences[first] + differences[second]) / 2)
    below = untied_quantile(n, (1 - CONFIDENCE) / 2)
    middle = float(np.median(means))
    if below is None or not math.isfinite(middle):
        return middle, None, None
    return middle, float(means[below]), float(means[-1 - below])

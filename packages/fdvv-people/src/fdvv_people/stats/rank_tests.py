"""Several conditions rated by the same people: Friedman's test, and every pair with Holm's correction.

Wilcoxon's signed-rank test follows from the ranks whose sign may turn: their sum of squares is the variance
with its correction for ties, and their subset sums are the exact distribution. Ties, zeros and missing people
need no table.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.stats.effect_size import CONFIDENCE, complete_scores
from fdvv_people.stats.post_hoc import holm, pairs_of

CHUNK_BYTES = 64_000_000
"""Room that the sums of as many studies as go together may take."""

Zeros = Literal["wilcoxon", "pratt"]
"""wilcoxon: who does not differ is left out before ranking (1945; SPSS, R). pratt: ranked, then left out
(1959), so that many who do not differ weaken what the others say."""

SAME = 1e-9
"""Part of the largest difference below which two of them are the same: means of ratings carry rounding."""


def lower_tail(ranks: FloatArray, sums: FloatArray) -> FloatArray:
    """Return the chance of a sum of positive ranks as small or smaller, all signs being tossed.

    ranks : (studies, people), whole or half; 0 for who has no sign to toss. sums : (studies,).
    """
    doubled = np.sort(np.rint(2 * ranks).astype(np.int64), axis=1)
    tops = np.rint(2 * sums).astype(np.int64)
    # studies with like sums go together: none has to count beyond the largest
    order = np.argsort(tops, kind="stable")
    tail = np.empty(len(tops))
    start = 0
    while start < len(order):
        size = max(1, CHUNK_BYTES // (8 * (int(tops[order[-1]]) + 1)))
        rows = order[start : start + size]
        tail[rows] = _chunk(doubled[rows], tops[rows])
        start += size
    return tail


def _chunk(ranks: np.ndarray, tops: np.ndarray) -> FloatArray:
    """Count (studies, 0 to the largest top) subset sums, halving at each toss so that no count overflows."""
    chance = np.zeros((len(ranks), int(tops.max(initial=0)) + 1))
    chance[:, 0] = 1.0
    for column in ranks.T:
        for rank in np.unique(column[column > 0]):
            rows = np.flatnonzero(column == rank)
            part = 0.5 * (chance if rows.size == len(ranks) else chance[rows])
            moved = part[:, : part.shape[1] - min(rank, part.shape[1])].copy()
            part[:, part.shape[1] - moved.shape[1] :] += moved
            chance[rows] = part
    counted = np.arange(chance.shape[1]) <= tops[:, np.newaxis]
    return np.asarray(np.sum(chance * counted, axis=1))


@lru_cache(maxsize=256)
def untied_quantile(n: int, level: float) -> int | None:
    """Return the largest sum of n ranks without ties whose lower tail is at most level; None without one."""
    chance = np.zeros(n * (n + 1) // 2 + 1)
    chance[0] = 1.0
    for rank in range(1, n + 1):
        moved = chance[: chance.size - rank].copy()
        chance[rank:] += moved
        chance *= 0.5
    below = int(np.searchsorted(np.cumsum(chance), level, side="right")) - 1
    return below if below >= 0 else None


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
    tests = {name: float(column[0]) for name, column in vars(signed_ranks(there[np.newaxis], zeros)).items()}
    shift, low, high = _shift(there)
    return SignedRank(
        n=there.size,
        zeros=int(np.sum(_snapped(there) == 0)),
        missing=found.size - there.size,
        statistic=min(tests["w_plus"], tests["w_minus"]),
        shift=shift,
        low=low,
        high=high,
        **tests,
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
    if differences.size == 0:
        return differences
    largest = np.nanmax(np.abs(differences), axis=-1, keepdims=True, initial=0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.where(largest > 0, np.round(differences / (SAME * largest)), differences))


def _shift(differences: FloatArray) -> tuple[float, float | None, float | None]:
    n = differences.size
    first, second = np.triu_indices(n)
    means = np.sort((differences[first] + differences[second]) / 2)
    below = untied_quantile(n, (1 - CONFIDENCE) / 2)
    middle = float(np.median(means))
    if below is None or not math.isfinite(middle):
        return middle, None, None
    return middle, float(means[below]), float(means[-1 - below])


@dataclass(frozen=True)
class Friedman:
    """Friedman's test.

    Attributes
    ----------
    chi2, df, p : with the correction for ties; p asymptotic.
    F, F_df, F_p : Iman and Davenport's (1980), which keeps its level better with few people.
    W : Kendall's coefficient of concordance, 0 to 1. mean_ranks : of the conditions, 1 the lowest.
    """

    people: int
    chi2: float
    df: int
    p: float
    F: float
    F_df: tuple[float, float]
    F_p: float
    W: float
    mean_ranks: tuple[float, ...]


@dataclass(frozen=True)
class RankPair:
    """One pair of conditions, first minus second. holm_p : of test.p_exact, for all pairs of the table."""

    first: str
    second: str
    test: SignedRank
    holm_p: float


def friedman(scores: npt.ArrayLike) -> Friedman:
    """Test whether conditions are ranked alike: scores (people, conditions), without missing ones.

    Raises ModelError on missing cells, and where every person rates all conditions alike.
    """
    from scipy.stats import chi2 as chi_squared
    from scipy.stats import f, rankdata

    found = complete_scores(scores, ("person", "condition"))
    people, conditions = found.shape
    # means of equal ratings may differ in the last digit, and are ties
    ranks = rankdata(_snapped(found), axis=1)
    means = ranks.mean(axis=0)
    between = people * float(np.sum((means - (conditions + 1) / 2) ** 2))
    # of what ranks spread within people, ties and all
    spread = float(np.sum((ranks - (conditions + 1) / 2) ** 2))
    if spread == 0:
        raise ModelError("every person rates all conditions alike, so there are no ranks to test")
    W, df = between / spread, conditions - 1
    chi2 = people * df * W
    F = (people - 1) * W / (1 - W) if W < 1 else float("inf")
    F_df = (float(df), float(df * (people - 1)))
    p, F_p = float(chi_squared.sf(chi2, df)), float(f.sf(F, *F_df))
    return Friedman(people, chi2, df, p, F, F_df, F_p, W, tuple(means.tolist()))


def ranked_pairs(
    scores: npt.ArrayLike, names: Sequence[str], against: str | None = None, zeros: Zeros = "wilcoxon"
) -> tuple[RankPair, ...]:
    """Test pairs of conditions by signed_rank, Holm's correction over their exact p.

    scores : (people, conditions), nan where missing: a pair leaves out only who lacks one of the two.
    against : only pairs of this one, as the first. Raises ModelError on unknown names.
    """
    found = np.asarray(scores, dtype=np.float64)
    if found.ndim != 2 or len(names) != found.shape[1] or len(set(names)) != len(names):
        raise ModelError(f"scores of shape {found.shape} need as many different names, got {list(names)}")
    column = dict(zip(names, found.T, strict=True))
    pairs = pairs_of(names, against)
    return rank_pairs({pair: column[pair[0]] - column[pair[1]] for pair in pairs}, zeros)


def rank_pairs(
    differences: Mapping[tuple[str, str], npt.ArrayLike], zeros: Zeros = "wilcoxon"
) -> tuple[RankPair, ...]:
    """Test people's differences (people,) of each pair by signed_rank; Holm's correction of their exact p."""
    tests = [signed_rank(values, zeros) for values in differences.values()]
    corrected = holm([test.p_exact for test in tests])
    return tuple(
        RankPair(*pair, test, p) for pair, test, p in zip(differences, tests, corrected, strict=True)
    )

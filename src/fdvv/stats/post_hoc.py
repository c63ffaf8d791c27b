"""Which conditions differ: paired tests of people's means, corrected for how many there are."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.stats.effect_size import CONFIDENCE, Estimate, cohen_dz, complete_scores, reduction
from fdvv.units import FloatArray


@dataclass(frozen=True)
class PairedTest:
    """One pair of conditions, first minus second.

    Attributes
    ----------
    difference : mean over people with the interval of the t distribution, in the scores' unit.
    t, df, p : paired t test, two-sided. bonferroni_p, holm_p : corrected for all pairs of the table.
    dz : Cohen's, with its BCa interval.
    reduction_ratio : by which part the first mean is below the second, with its BCa interval.
    """

    first: str
    second: str
    difference: Estimate
    t: float
    df: int
    p: float
    bonferroni_p: float
    holm_p: float
    dz: Estimate
    reduction_ratio: Estimate


def post_hoc(
    scores: npt.ArrayLike, names: Sequence[str], against: str | None = None, seed: int = 0
) -> tuple[PairedTest, ...]:
    """Test pairs of conditions within people.

    scores : (people, conditions), other factors and rounds averaged before. names : of the conditions.
    against : only pairs of this one, as the first; all pairs by default. Corrections count the pairs tested.
    seed : of the intervals that are resampled. Raises ModelError on missing cells and unknown names.
    """
    found = complete_scores(scores, ("person", "condition"))
    if len(names) != found.shape[1] or len(set(names)) != len(names):
        raise ModelError(f"{found.shape[1]} conditions need as many different names, got {list(names)}")
    pairs = _pairs(names, against)
    tested = [_paired(found[:, names.index(a)] - found[:, names.index(b)], f"{a} and {b}") for a, b in pairs]
    p = [t_and_p[1] for _, *t_and_p in tested]
    corrected = zip(bonferroni(p), holm(p), strict=True)
    rows = zip(pairs, tested, corrected, strict=True)
    return tuple(
        PairedTest(
            a, b, difference, t, found.shape[0] - 1, p, *both,
            cohen_dz(found[:, names.index(a)] - found[:, names.index(b)], seed),
            reduction(found[:, names.index(a)], found[:, names.index(b)], seed),
        )
        for (a, b), (difference, t, p), both in rows
    )  # fmt: skip


def bonferroni(p: Sequence[float]) -> tuple[float, ...]:
    """Multiply every p by their number, at most 1."""
    return tuple(min(1.0, one * len(p)) for one in p)


def holm(p: Sequence[float]) -> tuple[float, ...]:
    """Correct p step by step from the smallest (Holm 1979): never larger than Bonferroni's, as safe."""
    order = np.argsort(p, kind="stable")
    corrected = np.empty(len(p))
    highest = 0.0
    for rank, place in enumerate(order):
        highest = max(highest, min(1.0, (len(p) - rank) * p[place]))
        corrected[place] = highest
    return tuple(corrected.tolist())


def _pairs(names: Sequence[str], against: str | None) -> list[tuple[str, str]]:
    if against is None:
        return list(combinations(names, 2))
    if against not in names:
        raise ModelError(f"there is no condition {against!r} among {', '.join(names)}")
    return [(against, name) for name in names if name != against]


def _paired(differences: FloatArray, pair: str) -> tuple[Estimate, float, float]:
    from scipy.stats import t as student

    n = differences.size
    mean, error = float(differences.mean()), float(differences.std(ddof=1)) / math.sqrt(n)
    if error == 0.0:
        raise ModelError(f"{pair} differ alike in every person, so there is no spread to test against")
    half = float(student.ppf(0.5 + CONFIDENCE / 2, n - 1)) * error
    t = mean / error
    return Estimate(mean, mean - half, mean + half), t, float(2 * student.sf(abs(t), n - 1))

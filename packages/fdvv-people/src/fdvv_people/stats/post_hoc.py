"""Which conditions differ: paired tests of people's means, corrected for how many there are."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.stats.effect_size import CONFIDENCE, Estimate, cohen_dz, complete_scores, reduction


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
    column = dict(zip(names, found.T, strict=True))
    pairs = pairs_of(names, against)
    tests = [_paired(column[a] - column[b], f"{a} and {b}") for a, b in pairs]
    p = [test[2] for test in tests]
    rows = zip(pairs, tests, bonferroni(p), holm(p), strict=True)
    return tuple(
        PairedTest(
            a, b, difference, t, len(found) - 1, p, bonferroni_p, holm_p,
            cohen_dz(column[a] - column[b], seed), reduction(column[a], column[b], seed),
        )
        for (a, b), (difference, t, p), bonferroni_p, holm_p in rows
    )  # fmt: skip


def bonferroni(p: Sequence[float]) -> tuple[float, ...]:
    """Multiply every p by their number, at most 1."""
    return tuple(min(1.0, one * len(p)) for one in p)


def holm(p: Sequence[float]) -> tuple[float, ...]:
    """Correct p step by step from the smallest (Holm 1979): never larger than Bonferroni's, as safe."""
    order = np.argsort(p, kind="stable")
    corrected = np.empty(len(p))
    steps = np.arange(len(p), 0, -1) * np.asarray(p, dtype=np.float64)[order]
    corrected[order] = np.maximum.accumulate(np.minimum(1.0, steps))
    return tuple(corrected.tolist())


def pairs_of(names: Sequence[str], against: str | None) -> list[tuple[str, str]]:
    """List all pairs, or those of one condition, as the first. Raises ModelError on an unknown one."""
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

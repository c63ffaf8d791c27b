"""Several conditions rated by the same people: Friedman's test, and every pair with Holm's correction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.study._post_hoc import holm
from fdvv.study._scores import complete_scores
from fdvv.study._signed_rank import SignedRank, Zeros, signed_rank


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
    ranks = rankdata(found, axis=1)
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
    if against is not None and against not in names:
        raise ModelError(f"there is no condition {against!r} among {', '.join(names)}")
    firsts = names if against is None else [against]
    places = [(names.index(a), j) for a in firsts for j in range(len(names)) if names[j] != a]
    places = [(i, j) for i, j in places if against is not None or i < j]
    tests = [signed_rank(found[:, i] - found[:, j], zeros) for i, j in places]
    corrected = holm([test.p_exact for test in tests])
    return tuple(
        RankPair(names[i], names[j], test, p)
        for (i, j), test, p in zip(places, tests, corrected, strict=True)
    )

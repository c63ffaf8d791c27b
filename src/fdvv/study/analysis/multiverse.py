"""Multiverse analysis of the main claim (Steegen et al. 2016; Simonsohn et al. 2020)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product
from operator import attrgetter

import numpy as np

from fdvv.stats.effect_size import CONFIDENCE
from fdvv.stats.rank_tests import signed_ranks
from fdvv.stats.share import sign_test, wilson
from fdvv.study.plan.answers import Answers, groups_by, is_answered, means_by
from fdvv.study.plan.claim import CHOICE, CORRECT, claim_values, measure_of, measured_by
from fdvv.study.plan.plan import Claim
from fdvv.units import FloatArray

PLANNED, EVERYONE, COMPLETE = "by the rules", "nobody left out", "complete people only"
PERSON, CELL, TRIAL = "person", "person and button", "trial"
SPLIT, DROPPED = "split", "dropped"
RANKS, PRATT, SIGNS, T = "signed rank, zeros left out", "signed rank, zeros ranked", "sign", "t"
EXACT_UP_TO = 100
"""Numbers up to which the signed-rank test is exact; beyond, its normal approximation is as good."""


@dataclass(frozen=True)
class Specification:
    """One specification of the analysis, with its result.

    Attributes
    ----------
    exclusions, measure, unit, ties, test : the choices made. reported : it is the main analysis of the
        report. registered : it is that, and a plan had fixed its claim beforehand.
    share : part that speaks for the claim, ties as halves or dropped; 0.5 is no difference. low, high : its
        95 % interval. n : numbers that were tested. p : two-sided.
    """

    exclusions: str
    measure: str
    unit: str
    ties: str
    test: str
    share: float
    low: float
    high: float
    n: int
    p: float
    registered: bool = False
    reported: bool = False


@dataclass(frozen=True)
class Multiverse:
    """All specifications, by rising share. alpha : level of their tests."""

    specifications: tuple[Specification, ...]
    alpha: float

    @property
    def reported(self) -> Specification:
        return next(one for one in self.specifications if one.reported)

    @property
    def _alike(self) -> list[Specification]:
        side = np.sign(self.reported.share - 0.5)
        return [one for one in self.specifications if np.sign(one.share - 0.5) == side]

    @property
    def agreeing(self) -> int:
        """How many have a share on the same side of one half as the reported one."""
        return len(self._alike)

    @property
    def significant(self) -> int:
        """How many agree and are significant."""
        return sum(one.p < self.alpha for one in self._alike)


def multiverse(answers: Answers, claim: Claim, registered: bool = False) -> Multiverse:
    """Test a claim under every reasonable specification.

    answers : screened; `excluded` says what the rules left out. registered : a plan had fixed the claim.
    Equivalent specifications are counted once.
    ModelError on a claim that the answers do not hold.
    """
    first = measure_of(answers, claim)
    found: list[Specification] = []
    for exclusions, rows in _exclusions(answers).items():
        for measure in _measures(answers, first, claim):
            values = claim_values(rows, measured_by(claim, measure))[rows.counts]
            keys = rows.person[rows.counts], rows.item[rows.counts]
            for unit, ties in product((PERSON, CELL, TRIAL), (SPLIT, DROPPED)):
                found += _tested(exclusions, measure, unit, ties, values, keys)
    chosen = (PLANNED, first, PERSON, SPLIT, RANKS)
    key = attrgetter("exclusions", "measure", "unit", "ties", "test")
    main = [key(one) == chosen for one in found]
    marked = [replace(s, reported=m, registered=m and registered) for s, m in zip(found, main, strict=True)]
    return Multiverse(tuple(sorted(marked, key=lambda one: one.share)), claim.alpha)


def _exclusions(answers: Answers) -> dict[str, Answers]:
    everyone = replace(answers, excluded=None)
    whole = [
        person
        for person in dict.fromkeys(answers.person.tolist())
        if (answers.counts & is_answered(answers))[answers.person == person].all()
    ]
    excluded = np.where(answers.counts & np.isin(answers.person, whole), "", "incomplete")
    complete = replace(answers, excluded=excluded)
    found, seen = {}, set()
    for name, rows in ((PLANNED, answers), (EVERYONE, everyone), (COMPLETE, complete)):
        key = (rows.counts & is_answered(rows)).tobytes()
        if key not in seen and (rows.counts & is_answered(rows)).any():
            found[name] = rows
        seen.add(key)
    return found


def _measures(answers: Answers, first: str, claim: Claim) -> list[str]:
    if first == CORRECT:
        return [CORRECT]
    chosen = [CHOICE] if np.isin(answers.choice, (claim.more, claim.less)).any() else []
    rated = [name for name, columns in answers.ratings.items() if np.isfinite(columns).any()]
    return list(dict.fromkeys([first, *chosen, *rated]))


def _tested(
    exclusions: str, measure: str, unit: str, ties: str, values: FloatArray, keys: tuple[np.ndarray, ...]
) -> list[Specification]:
    if ties == DROPPED:
        if not np.any(values == 0):
            return []
        values = np.where(values == 0, np.nan, values)
    tested, shares = _units(values, unit, keys)
    if not tested.size:
        return []
    share, low, high = _interval(shares, unit)
    tests: tuple[str, ...] = (RANKS, PRATT, SIGNS, T) if np.any(tested == 0) else (RANKS, SIGNS, T)
    # of right and wrong, or of choices, one by one: ranks say what signs say
    # where all are alike there is nothing to hold a mean against
    tests = tuple(one for one in tests if one != T or (tested.size > 1 and tested.std() > 0))
    tests = (SIGNS,) if unit == TRIAL and np.unique(np.abs(tested[tested != 0])).size <= 1 else tests
    return [
        Specification(exclusions, measure, unit, ties, test, share, low, high, tested.size, _p(tested, test))
        for test in tests
    ]


def _units(values: FloatArray, unit: str, keys: tuple[np.ndarray, ...]) -> tuple[FloatArray, FloatArray]:
    signs = np.where(np.isfinite(values), (np.sign(values) + 1.0) / 2.0, np.nan)
    if unit == TRIAL or not values.size:
        there = np.isfinite(values)
        return values[there], signs[there]
    by = keys[:1] if unit == PERSON else keys
    # where each person has one button, cells are people, and counted already
    if unit == CELL and len(np.unique(groups_by(*keys))) == len(np.unique(keys[0])):
        return np.empty(0), np.empty(0)
    means, shares = means_by(values, *by), means_by(signs, *by)
    return means[np.isfinite(means)], shares[np.isfinite(means)]


def _interval(shares: FloatArray, unit: str) -> tuple[float, float, float]:
    from scipy.stats import t as student

    n, share = shares.size, float(shares.mean())
    if unit == TRIAL:
        low, high = wilson(share * n, n)
        return share, float(low), float(high)
    if n < 2:
        return share, 0.0, 1.0
    half = float(student.ppf(0.5 + CONFIDENCE / 2, n - 1)) * float(shares.std(ddof=1)) / float(np.sqrt(n))
    return share, max(0.0, share - half), min(1.0, share + half)


def _p(values: FloatArray, test: str) -> float:
    from scipy.stats import ttest_1samp

    if test == SIGNS:
        return sign_test(values).p
    if test == T:
        return float(ttest_1samp(values, 0.0).pvalue)
    exact = values.size <= EXACT_UP_TO
    found = signed_ranks(values[np.newaxis], "pratt" if test == PRATT else "wilcoxon", exact)
    return float((found.p_exact if exact else found.p_asymptotic)[0])

"""A share of answers whose interval counts people: answers of one person are more alike than answers are."""

from __future__ import annotations

from typing import Literal

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.study._beta_binomial import beta_binomial_interval
from fdvv.study._effect_size import CONFIDENCE, bca
from fdvv.study._share import Share, clopper_pearson
from fdvv.units import FloatArray

ClusteredMethod = Literal["korn-graubard", "beta-binomial", "bootstrap"]


def clustered_share(
    successes: npt.ArrayLike, n: npt.ArrayLike, method: ClusteredMethod = "korn-graubard", seed: int = 0
) -> Share:
    """Give a share of all answers with an interval over people.

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
    """Give a share of which only totals are printed, for an assumed likeness of one person's answers.

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
        found = bca(_ratio, (k, n), seed)
        # people too few or too alike to draw from: the other way always has an answer
        return (found.low, found.high) if found.low is not None and found.high is not None else _counted(k, n)
    return _counted(k, n)


def effective_answers(successes: FloatArray, n: FloatArray) -> float:
    """Give how many independent answers say as much as these of people, from how people spread.

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


def _counted(k: FloatArray, n: FloatArray) -> tuple[float, float]:
    """Give Korn and Graubard's bounds."""
    counted = effective_answers(k, n)
    low, high = clopper_pearson(k.sum() / n.sum() * counted, counted)
    return float(low), float(high)


def _ratio(successes: FloatArray, n: FloatArray, axis: int) -> FloatArray:
    return np.asarray(np.sum(successes, axis=axis) / np.sum(n, axis=axis))

"""How large a difference within people is, with an interval from resampling people."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from fdvv.study._scores import complete_scores
from fdvv.units import FloatArray

RESAMPLES = 9999
CONFIDENCE = 0.95
FEWEST_RESAMPLED = 5
"""People below which resampling says nothing: too often all that is drawn is one person again and again."""


@dataclass(frozen=True)
class Estimate:
    """A value with its interval.

    Attributes
    ----------
    low, high : bounds of the 95 % interval; None where people are too few or too alike to tell one.
    """

    value: float
    low: float | None = None
    high: float | None = None


def cohen_dz(differences: npt.ArrayLike, seed: int = 0) -> Estimate:
    """Give the mean of people's differences in units of their standard deviation, with its BCa interval.

    Bias-corrected and accelerated bootstrap over people (Efron 1987). 0 / 0 is 0; infinite where all differ
    alike. ModelError on a difference that is missing.
    """
    return bca(_standardised, (complete_scores(differences, ("person",)),), seed)


def reduction(lower: npt.ArrayLike, higher: npt.ArrayLike, seed: int = 0) -> Estimate:
    """Give by which part the mean of the first is below that of the second, with its BCa interval.

    lower, higher : (people,) of the same people. 0.2 means 20 % less.
    """
    pairs = complete_scores(np.column_stack([lower, higher]), ("person", "condition"))
    return bca(_part_less, (pairs[:, 0], pairs[:, 1]), seed)


def bca(statistic: Callable[..., Any], columns: tuple[FloatArray, ...], seed: int = 0) -> Estimate:
    """Estimate a statistic of people, resampling whole people.

    statistic : of arrays, along ``axis``. columns : (people,) each. seed repeats the interval.
    """
    from scipy.stats import bootstrap

    value = float(statistic(*columns, axis=-1))
    if columns[0].size < FEWEST_RESAMPLED or not np.isfinite(value):
        return Estimate(value)
    random = np.random.default_rng(seed)
    # people who all differ alike, or a resample of one person alone: then there is no interval to tell
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        found = bootstrap(
            columns, statistic, n_resamples=RESAMPLES, confidence_level=CONFIDENCE, paired=True, rng=random
        ).confidence_interval
    low, high = float(found.low), float(found.high)
    return Estimate(value, low, high) if np.isfinite([low, high]).all() else Estimate(value)


def _part_less(lower: FloatArray, higher: FloatArray, axis: int) -> FloatArray:
    """Give by which part one mean is below the other."""
    return np.asarray(1.0 - np.mean(lower, axis=axis) / np.mean(higher, axis=axis))


def _standardised(differences: FloatArray, axis: int) -> FloatArray:
    """Give mean over standard deviation."""
    mean, spread = np.mean(differences, axis=axis), np.std(differences, axis=axis, ddof=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.where(mean == 0.0, 0.0, mean / spread))

"""How large a difference within people is, with an interval from resampling people."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.units import FloatArray

FEWEST = 3
"""People below which nothing is tested: with two, one difference is all that is known of the spread."""

RESAMPLES = 9999
CONFIDENCE = 0.95
FEWEST_RESAMPLED = 5
"""People below which resampling says nothing: too often all that is drawn is one person again and again."""


def complete_scores(scores: npt.ArrayLike, axes: Sequence[str]) -> FloatArray:
    """Return scores as a checked array, one axis per name, people first.

    Repeated measures have no answer for a missing cell: the person must be left out or measured again. Raises
    ModelError that names the first cell without a finite score; also on an axis too many or too few, too few
    people and a factor of one level.
    """
    found = np.asarray(scores, dtype=np.float64)
    if found.ndim != len(axes):
        raise ModelError(f"scores need the axes {', '.join(axes)}, got the shape {found.shape}")
    if found.shape[0] < FEWEST:
        raise ModelError(f"repeated measures need at least {FEWEST} people, got {found.shape[0]}")
    for name, size in zip(axes[1:], found.shape[1:], strict=True):
        if size < 2:
            raise ModelError(f"the factor {name} needs at least 2 levels, got {size}")
    missing = np.argwhere(~np.isfinite(found))
    if missing.size:
        cell = ", ".join(f"{name} {place + 1}" for name, place in zip(axes, missing[0], strict=True))
        raise ModelError(
            f"{len(missing)} of {found.size} scores are missing, the first at {cell} (counted from 1); "
            "measure it, or leave that person out"
        )
    return found


def averaged_rounds(observations: npt.ArrayLike) -> FloatArray:
    """Average the last axis, the rounds of one person: people are counted, not their rounds."""
    return np.asarray(np.mean(np.asarray(observations, dtype=np.float64), axis=-1))


def rounds_as_people(observations: npt.ArrayLike) -> FloatArray:
    """Turn (people, ..., rounds) into (people * rounds, ...), as if every round were another person's.

    The paper's F(5, 95) counts so: 10 people of 2 rounds as 20. Rounds of one person are more alike than
    people are, so that p comes out too small; for comparison only.
    """
    found = np.moveaxis(np.asarray(observations, dtype=np.float64), -1, 1)
    return found.reshape(-1, *found.shape[2:])


@dataclass(frozen=True)
class Estimate:
    """A value with its interval.

    Attributes
    ----------
    low, high : bounds of the 95 % interval; None where people are too few or too alike.
    """

    value: float
    low: float | None = None
    high: float | None = None


def cohen_dz(differences: npt.ArrayLike, seed: int = 0) -> Estimate:
    """Return the mean of people's differences in units of their standard deviation, with its BCa interval.

    Bias-corrected and accelerated bootstrap over people (Efron 1987). 0 / 0 is 0; infinite where all differ
    alike. ModelError on a difference that is missing.
    """
    return bca(_standardised, (complete_scores(differences, ("person",)),), seed)


def reduction(lower: npt.ArrayLike, higher: npt.ArrayLike, seed: int = 0) -> Estimate:
    """Return by which part the mean of the first is below that of the second, with its BCa interval.

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
    # people who all differ alike, or a resample of one person alone: then there is no interval
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        found = bootstrap(
            columns, statistic, n_resamples=RESAMPLES, confidence_level=CONFIDENCE, paired=True, rng=random
        ).confidence_interval
    low, high = float(found.low), float(found.high)
    return Estimate(value, low, high) if np.isfinite([low, high]).all() else Estimate(value)


def _part_less(lower: FloatArray, higher: FloatArray, axis: int) -> FloatArray:
    return np.asarray(1.0 - np.mean(lower, axis=axis) / np.mean(higher, axis=axis))


def _standardised(differences: FloatArray, axis: int) -> FloatArray:
    mean, spread = np.mean(differences, axis=axis), np.std(differences, axis=axis, ddof=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.where(mean == 0.0, 0.0, mean / spread))

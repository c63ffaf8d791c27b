"""What all trials of a staircase tell of its threshold: a belief on a grid, by Bayes' rule."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fdvv.units import FloatArray

THRESHOLDS = np.geomspace(0.002, 3.0, 200)
"""Ratios; all equally likely beforehand, on the logarithm."""
SPREADS = np.geomspace(0.15, 2.4, 11)
"""Of the psychometric function, in natural logarithms of the ratio."""
SPREAD, SPREAD_SPREAD = 0.75, 0.6
"""Beforehand: near that of d' that grows with the ratio, within a factor of 1.8 either way (assumed)."""
LAPSE = 0.02
"""Part of the trials answered without feeling anything (assumed; Wichmann and Hill 2001 find 0 to 0.05)."""
CHANCE = 0.5


def threshold_interval(history: Sequence[tuple[float, bool]], share: float) -> tuple[float, float]:
    """Give between which ratios the difference lies that is told apart in such a share of trials, at 95 %.

    history : (ratio, correct) of each trial with two labels. A cumulative normal over the logarithm of the
    ratio, from 0.5 up; its spread is not known and averaged over. Which trials were made follows from earlier
    answers, so that stopping needs no correction; several staircases of one person may be joined. In 15 sets
    of 300 simulated staircases of 8 turns, of listeners whose d' grows with the ratio, faster or slower,
    lapsing or not, it held the truth in 93 to 99.7 %. It is wide: high is 5 to 12 times low in one staircase.
    """
    belief = _belief(history, share)
    passed = np.cumsum(belief)
    low, high = np.interp([0.025, 0.975], passed / passed[-1], np.log(THRESHOLDS))
    return float(np.exp(low)), float(np.exp(high))


def _belief(history: Sequence[tuple[float, bool]], share: float) -> FloatArray:
    """Give how likely each threshold is, up to a factor, (thresholds,)."""
    from scipy.special import ndtr, ndtri

    ratios = np.log([ratio for ratio, _ in history])  # (trials,)
    right = np.array([correct for _, correct in history], bool)
    top = 1 - CHANCE - LAPSE
    middle = np.log(THRESHOLDS)[:, None] - SPREADS * ndtri((share - CHANCE) / top)  # (thresholds, spreads)
    p = CHANCE + top * ndtr((ratios - middle[..., None]) / SPREADS[:, None])
    told = np.where(right, np.log(p), np.log1p(-p)).sum(axis=-1)
    told = told - 0.5 * (np.log(SPREADS / SPREAD) / SPREAD_SPREAD) ** 2
    return np.asarray(np.exp(told - told.max()).sum(axis=1))

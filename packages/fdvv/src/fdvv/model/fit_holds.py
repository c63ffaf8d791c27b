"""What a fit must hold to besides the least error: its bump, and no force below the measured ones."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np

from fdvv.model import bspline
from fdvv.model.bump import find_bump
from fdvv.model.knot_search import Spline
from fdvv.units import FloatArray

Search = Callable[[FloatArray, FloatArray, FloatArray], Spline]
"""Fits samples x, y of weights w with the number of control points and the degree at hand."""

Kept = Callable[[FloatArray, FloatArray, FloatArray], bool]
"""Whether the values of a fit at x keep the bump of y."""

BUMP_ROUNDS = 8
BUMP_COST = 1.5
"""The error may grow by this factor for the bump's sake, no more."""
BUMP_WEIGHT = 2.0  # assumed: the last of BUMP_ROUNDS weighs 128 times
BUMP_REACH_mm = 0.1  # assumed: twice the 50 um over which peak and valley are averaged

BELOW_cN, LEAST_cN = 0.4, -0.5
"""A curve may pass this far below the least force measured, which nobody feels, but not below -0.5 cN unless
the measurement does: latching and magnetic keys pull."""
DEAR_ratio = 1.02  # assumed: a smaller rise of the RMSE is not worth a second search
BETWEEN, BETWEEN_weight = 3, 0.2  # assumed: quarters of a gap, which weigh less than a sample: 0.6


def hold_bump(x: FloatArray, y: FloatArray, degree: int, fit: Spline, search: Search, kept: Kept) -> Spline:
    """Repeat a fit that lost more than 5 % of its bump, each time with more weight on peak and valley.

    Least squares cares for the sum of errors, a finger for the snap. Returns the first fit that keeps the
    bump; the plain one if none does before the error has grown by half.
    """
    bump = find_bump(x, y)
    if bump is None:
        return fit
    near = np.minimum(np.abs(x - bump.peak_mm), np.abs(x - bump.valley_mm)) < BUMP_REACH_mm
    weight, trial, bound = np.ones_like(x), fit, math.inf
    for _ in range(BUMP_ROUNDS):
        fitted = bspline.evaluate(*trial, degree, x)
        error = float(np.sum((fitted - y) ** 2))
        bound = min(bound, BUMP_COST**2 * error)
        if error > bound:
            break
        if kept(x, y, fitted):
            return trial
        weight[near] *= BUMP_WEIGHT
        trial = search(x, y, weight)
    return fit


def hold_floor(x: FloatArray, y: FloatArray, degree: int, fit: Spline, search: Search) -> Spline:
    """Bound a curve that dips below the least measured force: no control point lies below it then.

    A spline lies within the range of its control points. Where the bound costs more than 2 % of the error,
    knots are searched again with points on the chords of the samples at the dip, so that the search sees it.
    """
    floor, at = _floor_cN(y), _lowest_mm(x, degree, fit)
    if float(bspline.evaluate(*fit, degree, at)) >= floor:
        return fit
    free = _error(x, y, degree, fit)
    bounded = _fit_above(x, y, degree, fit[0], floor)
    if _error(x, y, degree, bounded) > DEAR_ratio**2 * free:
        again = _fit_above(x, y, degree, search(*_with_chords(x, y, at))[0], floor)
        bounded = min(bounded, again, key=lambda spline: _error(x, y, degree, spline))
    return bounded


def _floor_cN(force_cN: FloatArray) -> float:
    least = float(force_cN.min())
    below = least - BELOW_cN
    return max(below, LEAST_cN) if least >= LEAST_cN else below


def _lowest_mm(x: FloatArray, degree: int, spline: Spline) -> float:
    """Return where a curve is lowest, of sixteen places between two knots and of the samples."""
    t = np.unique(spline[0])
    fine = np.concatenate([x, *(a + (b - a) * np.arange(16) / 16 for a, b in pairwise(t))])
    return float(fine[np.argmin(bspline.evaluate(*spline, degree, fine))])


def _error(x: FloatArray, y: FloatArray, degree: int, spline: Spline) -> float:
    return float(np.sum((bspline.evaluate(*spline, degree, x) - y) ** 2))


def _fit_above(x: FloatArray, y: FloatArray, degree: int, t: FloatArray, floor: float) -> Spline:
    """Find the least squares of given knots with no coefficient below the floor."""
    from scipy.optimize import nnls

    # the basis sums to one, so a floor under the coefficients shifts the problem
    above, _ = nnls(bspline.design_matrix(t, degree, x), y - floor)
    return t, floor + above


def _with_chords(x: FloatArray, y: FloatArray, at: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Add light points on the chords of the interval around a place and of its neighbours."""
    i = int(np.clip(np.searchsorted(x, at) - 1, 0, x.size - 2))
    ends = x[max(0, i - 1) : i + 3]
    part = np.arange(1, BETWEEN + 1) / (BETWEEN + 1)
    between = (ends[:-1, None] + np.diff(ends)[:, None] * part).ravel()
    joined = np.concatenate([x, between])
    order = np.argsort(joined, kind="stable")
    weight = np.concatenate([np.ones_like(x), np.full(between.size, BETWEEN_weight)])
    return joined[order], np.concatenate([y, np.interp(between, x, y)])[order], weight[order]

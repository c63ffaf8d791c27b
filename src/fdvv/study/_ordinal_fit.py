"""Fitting a cumulative probit model in which people differ: the maximum and how sharply it peaks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.study._ordinal_likelihood import OrdinalData, OrdinalPoint, log_likelihood
from fdvv.units import FloatArray

FLATTEST = 1e-3
"""Slope of the log-likelihood, per answer, above which no maximum was found."""

STEP = 1e-4
"""By which each number is moved to see how the slope of the log-likelihood changes."""


@dataclass(frozen=True, eq=False)
class OrdinalFit:
    """The maximum.

    Attributes
    ----------
    point : where it is. log_likelihood : there. covariance : of the point's numbers; nan where the likelihood
        does not bend. slope : largest that is left, per answer.
    """

    point: OrdinalPoint
    log_likelihood: float
    covariance: FloatArray
    slope: float


def gathered(
    category: np.ndarray, person: np.ndarray, columns: FloatArray, slope: int | None = None
) -> OrdinalData:
    """Count answers that are alike in everything, sorted by person in the order of first appearance.

    category : (n,) from 0. person : (n,) of anything. columns : (n, k) predictors. slope : the one by which
    people differ as well.
    """
    _, first, back = np.unique(person, return_index=True, return_inverse=True)
    who = np.argsort(np.argsort(first))[back]
    rows, count = np.unique(np.column_stack([who, category, columns]), axis=0, return_counts=True)
    predictors = rows[:, 2:]
    ones = np.ones((len(rows), 1))
    random = ones if slope is None else np.column_stack([ones, predictors[:, slope]])
    starts = np.unique(rows[:, 0], return_index=True)[1]
    return OrdinalData(rows[:, 1].astype(np.int64), predictors, random, count.astype(np.float64), starts)


def fitted(data: OrdinalData, nodes: int) -> OrdinalFit:
    """Climb from thresholds that fit the plain shares, no effect and people who differ by half."""
    from scipy.optimize import minimize
    from scipy.special import ndtri

    share = np.bincount(data.category, data.count) / data.count.sum()
    cuts, size = np.asarray(1.2 * ndtri(np.cumsum(share)[:-1])), data.random.shape[1]
    start = OrdinalPoint(cuts, np.zeros(data.predictors.shape[1]), 0.5 * np.eye(size))

    def falling(free: FloatArray) -> tuple[float, FloatArray]:
        point = start.moved(_ordered(free, cuts.size))
        value, gradient = log_likelihood(data, point, nodes)
        return -value, -_along_free(gradient, free, cuts.size)

    free = _freed(start.flat(), cuts.size)
    found = minimize(falling, free, jac=True, method="BFGS", options={"gtol": 1e-5, "maxiter": 500})
    point = start.moved(_ordered(found.x, cuts.size))
    steepest = float(np.abs(np.asarray(found.jac, float)).max()) / float(data.count.sum())
    return OrdinalFit(point, -float(found.fun), _covariance(data, point, nodes), steepest)


def _freed(flat: FloatArray, cuts: int) -> FloatArray:
    """Turn ordered thresholds into the first and the logarithms of the steps to the next."""
    free = flat.copy()
    free[1:cuts] = np.log(np.diff(flat[:cuts]))
    return free


def _ordered(free: FloatArray, cuts: int) -> FloatArray:
    flat = free.copy()
    flat[1:cuts] = free[0] + np.cumsum(np.exp(free[1:cuts]))
    return flat


def _along_free(gradient: FloatArray, free: FloatArray, cuts: int) -> FloatArray:
    turned = gradient.copy()
    # a step moves its own threshold and all above
    above = np.cumsum(gradient[:cuts][::-1])[::-1]
    turned[0] = above[0]
    turned[1:cuts] = above[1:] * np.exp(free[1:cuts])
    return turned


def _covariance(data: OrdinalData, point: OrdinalPoint, nodes: int) -> FloatArray:
    """Invert the bend of the log-likelihood, from differences of its slope."""
    flat = point.flat()
    rows = []
    for moved in STEP * np.eye(flat.size):
        up, down = (log_likelihood(data, point.moved(flat + way * moved), nodes)[1] for way in (1, -1))
        rows.append((down - up) / (2 * STEP))
    bend = np.array(rows)
    try:
        return np.asarray(np.linalg.inv((bend + bend.T) / 2))
    except np.linalg.LinAlgError:
        return np.full_like(bend, np.nan)

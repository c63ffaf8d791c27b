"""Fitting a cumulative probit model in which people differ: the maximum and how sharply it peaks.

An answer is the category in which a normal response falls. Its mean is the predictors' sum plus the person's
own intercept, integrated out by adaptive Gauss-Hermite quadrature on nodes about its mode (Pinheiro and Bates
1995; Hedeker and Gibbons 1994). The slope of the log-likelihood is the mean over the same nodes of the
complete data's slope (Fisher's identity).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import product

import numpy as np

from fdvv.units import FloatArray

NEWTON_STEPS = 50
LOG_ROOT_2_PI = 0.5 * math.log(2 * math.pi)
FLATTEST = 1e-3
"""Slope of the log-likelihood, per answer, above which no maximum was found."""

STEP = 1e-4
"""By which each number is moved to see how the slope of the log-likelihood changes."""


@dataclass(frozen=True, eq=False)
class OrdinalData:
    """Answers that are alike in everything counted together, sorted by person.

    Attributes
    ----------
    category : (n,) from 0. predictors : (n, k). random : (n, q), what a person's own parts multiply.
    count : (n,) answers. starts : (people,), where each person begins.
    """

    category: np.ndarray
    predictors: FloatArray
    random: FloatArray
    count: FloatArray
    starts: np.ndarray

    @property
    def people(self) -> int:
        return len(self.starts)

    @property
    def owner(self) -> np.ndarray:
        return np.repeat(np.arange(self.people), np.diff(np.append(self.starts, len(self.category))))

    def by_person(self, values: FloatArray) -> FloatArray:
        """Sum rows of each person."""
        return np.asarray(np.add.reduceat(values, self.starts, axis=0))


@dataclass(frozen=True, eq=False)
class OrdinalPoint:
    """What is tried: thresholds (categories - 1,), effects (k,), and the people's Cholesky factor (q, q)."""

    thresholds: FloatArray
    effects: FloatArray
    factor: FloatArray

    def flat(self) -> FloatArray:
        """Return all numbers in a row."""
        return np.concatenate([self.thresholds, self.effects, self.factor[np.tril_indices(len(self.factor))]])

    def moved(self, flat: FloatArray) -> OrdinalPoint:
        """Return the point of other numbers in a row."""
        first, second = len(self.thresholds), len(self.thresholds) + len(self.effects)
        factor = np.zeros_like(self.factor)
        factor[np.tril_indices(len(factor))] = flat[second:]
        return OrdinalPoint(flat[:first], flat[first:second], factor)


def log_likelihood(data: OrdinalData, point: OrdinalPoint, nodes: int) -> tuple[float, FloatArray]:
    """Return the log-likelihood and its slope along each number of the point."""
    low, high = _bounds(data, point)
    lead = data.random @ point.factor
    modes, spread = person_modes(data, point)
    steps, weights = _grid(nodes, data.random.shape[1])
    # (people, nodes, q): nodes laid over each person's own peak
    own = modes[:, np.newaxis] + math.sqrt(2) * np.einsum("pij,kj->pki", spread, steps)
    shift = np.einsum("nq,nkq->nk", lead, own[data.owner])
    log_p, at_low, at_high = _cell(low[:, np.newaxis] - shift, high[:, np.newaxis] - shift)
    total = data.by_person(data.count[:, np.newaxis] * log_p)
    total = total - 0.5 * np.sum(own**2, axis=2) + weights
    peak = total.max(axis=1, keepdims=True)
    mass = np.exp(total - peak)
    # the roots of 2 of the nodes' scale and of the normal density leave pi
    outside = np.log(np.abs(np.linalg.det(spread))) - 0.5 * data.random.shape[1] * math.log(math.pi)
    value = float(np.sum(peak[:, 0] + np.log(mass.sum(axis=1)) + outside))
    mass /= mass.sum(axis=1, keepdims=True)
    chance = data.count[:, np.newaxis] * mass[data.owner]
    return value, _slope(data, point, chance * at_low, chance * at_high, own)


def person_modes(data: OrdinalData, point: OrdinalPoint) -> tuple[FloatArray, FloatArray]:
    """Return the mode of each person's random effects, (people, q), and the root of their spread there."""
    low, high = _bounds(data, point)
    lead = data.random @ point.factor
    size = data.random.shape[1]
    own = np.zeros((data.people, size))
    for _ in range(NEWTON_STEPS):
        shift = np.sum(lead * own[data.owner], axis=1)
        slope, bend = _bend(low - shift, high - shift)
        gradient = data.by_person((data.count * slope)[:, np.newaxis] * lead) - own
        outer = lead[:, :, np.newaxis] * lead[:, np.newaxis]
        curvature = np.eye(size) - data.by_person((data.count * bend)[:, np.newaxis, np.newaxis] * outer)
        step = np.linalg.solve(curvature, gradient[..., np.newaxis])[..., 0]
        # the peak is the only one, but a step from far away may jump over it
        own = own + step / np.maximum(1.0, np.abs(step).max(axis=1, keepdims=True))
        if np.abs(step).max() < 1e-10:
            break
    return own, np.linalg.cholesky(np.linalg.inv(curvature))


def _bounds(data: OrdinalData, point: OrdinalPoint) -> tuple[FloatArray, FloatArray]:
    edges = np.concatenate([[-np.inf], point.thresholds, [np.inf]])
    middle = data.predictors @ point.effects
    return edges[data.category] - middle, edges[data.category + 1] - middle


def _slope(
    data: OrdinalData, point: OrdinalPoint, at_low: FloatArray, at_high: FloatArray, own: FloatArray
) -> FloatArray:
    """Sum what moving each number does: at_low, at_high (n, nodes) are what moving a cell's bounds does."""
    edges = np.zeros(len(point.thresholds) + 2)
    np.add.at(edges, data.category, at_low.sum(axis=1))
    np.add.at(edges, data.category + 1, at_high.sum(axis=1))
    mean = -(at_low + at_high)
    owned = np.einsum("nk,nkq->nq", mean, own[data.owner])
    factor = data.random.T @ owned
    return np.concatenate(
        [edges[1:-1], data.predictors.T @ mean.sum(axis=1), factor[np.tril_indices(len(factor))]]
    )


def _cell(low: FloatArray, high: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    from scipy.special import log_ndtr

    # in the upper tail the mirror image, where nothing cancels
    flip = low > 0
    a, b = np.where(flip, -high, low), np.where(flip, -low, high)
    upper = log_ndtr(b)
    with np.errstate(divide="ignore"):
        log_p = upper + np.log1p(-np.exp(np.minimum(log_ndtr(a) - upper, 0.0)))
    log_p = np.maximum(log_p, -1e6)
    return log_p, -_density_ratio(low, log_p), _density_ratio(high, log_p)


def _bend(low: FloatArray, high: FloatArray) -> tuple[FloatArray, FloatArray]:
    _, at_low, at_high = _cell(low, high)
    slope = -(at_low + at_high)
    a, b = (np.where(np.isfinite(bound), bound, 0.0) for bound in (low, high))
    return slope, -a * at_low - b * at_high - slope**2


def _density_ratio(bound: FloatArray, log_p: FloatArray) -> FloatArray:
    return np.asarray(np.exp(-0.5 * bound**2 - LOG_ROOT_2_PI - log_p))


def _grid(nodes: int, size: int) -> tuple[FloatArray, FloatArray]:
    at, weight = np.polynomial.hermite.hermgauss(nodes)
    places = np.array(list(product(range(nodes), repeat=size)))
    log_weight = np.log(weight) + at**2
    return at[places], log_weight[places].sum(axis=1)


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
    flat = point.flat()
    rows = []
    for moved in STEP * np.eye(flat.size):
        up, down = (log_likelihood(data, point.moved(flat + sign * moved), nodes)[1] for sign in (1, -1))
        rows.append((down - up) / (2 * STEP))
    bend = np.array(rows)
    try:
        return np.asarray(np.linalg.inv((bend + bend.T) / 2))
    except np.linalg.LinAlgError:
        return np.full_like(bend, np.nan)

"""From samples to a B-spline: the paper's uniform knots, and knots placed where the curve needs them."""

from __future__ import annotations

import ctypes
import math
import time
from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np

from fdvv._native import address, library
from fdvv.errors import FitError
from fdvv.model import bspline
from fdvv.model.bump import find_bottom_out_mm, find_bump, find_contact_mm
from fdvv.model.curve import ForceCurve, MeasuredCurve
from fdvv.units import FloatArray

CONTROL_POINTS = 15
COMPLEXITY_PENALTY = 2.5
"""P of the paper's BIC*."""

SCAN_SIZES = range(5, 41)
EXCHANGES = 15
"""Knot exchanges to try before the search ends; twice as many gained nothing on 96 real strokes."""

LARGEST = 64

BUMP_KEPT_ratio = 0.95
"""A fit that keeps less of its bump is repeated with more weight within BUMP_REACH_mm of peak and valley."""
BUMP_ROUNDS = 8
BUMP_COST = 1.5
"""The error may grow by this factor for the bump's sake, no more."""
BUMP_WEIGHT = 2.0
BUMP_REACH_mm = 0.1


class FitMethod(StrEnum):
    """Where the knots go."""

    ADAPTIVE = "adaptive"
    """Knots free to move, quadratic unless asked otherwise: decision 3."""
    UNIFORM = "uniform"
    """Equal spans, cubic unless asked otherwise: the paper's way."""


@dataclass(frozen=True, eq=False)
class CurveFit:
    """A fitted curve and how well it holds to the samples.

    Attributes
    ----------
    curve : the spline, from contact to bottom-out.
    method : how the knots were placed.
    rmse_cN, max_cN : error against the raw curve, each distinct displacement counting once.
    rows_rmse_cN : error against every raw row; rows that repeat a displacement scatter around their mean,
        which no curve can follow.
    bump_kept_ratio : drop of the fitted bump over that of the raw curve; None if the raw has no bump.
    bic_star : the paper's criterion, lower is better.
    samples : number of distinct displacements.
    smoothing_mm : sigma of the Gaussian that was applied before the fit; 0 if none.
    time_s : what the fit took.
    """

    curve: ForceCurve
    method: FitMethod
    rmse_cN: float
    max_cN: float
    rows_rmse_cN: float
    bump_kept_ratio: float | None
    bic_star: float
    samples: int
    smoothing_mm: float
    time_s: float


def bic_star(n: int, k: int, squared_error: float, penalty: float = COMPLEXITY_PENALTY) -> float:
    """Compute BIC* = ln(n) k P - 2 ln(L) (the paper's eq. 1) for Gaussian errors.

    n : observations; k : parameters (control points); squared_error : sum over the observations.
    The likelihood is at its maximum, where the variance is squared_error / n.
    """
    # without a floor a perfect fit would have an infinite likelihood
    variance = max(squared_error / n, 1e-18)
    return math.log(n) * k * penalty + n * (math.log(2 * math.pi * variance) + 1)


def smooth(x_mm: FloatArray, force_cN: FloatArray, sigma_mm: float) -> FloatArray:
    """Apply a Gaussian of sigma_mm along displacement, at strictly rising x_mm, and give (n,) forces.

    The samples are brought to a grid a quarter of sigma or finer; the ends are mirrored.
    """
    from scipy.ndimage import gaussian_filter1d

    step = min(float(np.median(np.diff(x_mm))), sigma_mm / 4)
    grid = np.linspace(x_mm[0], x_mm[-1], max(2, math.ceil((x_mm[-1] - x_mm[0]) / step) + 1))
    smoothed = gaussian_filter1d(np.interp(grid, x_mm, force_cN), sigma_mm / (grid[1] - grid[0]))
    return np.interp(x_mm, grid, smoothed)


def _adaptive(
    x: FloatArray, y: FloatArray, degree: int, size: int, weight: FloatArray | None = None
) -> tuple[FloatArray, FloatArray]:
    """Place the knots freely; no two closer than the samples, so that samples hold every basis function."""
    t, c = np.zeros(size + degree + 1), np.zeros(size)
    weight = np.ones_like(x) if weight is None else weight
    x, y, weight = (np.ascontiguousarray(column) for column in (x, y, weight))
    spacing = min(float(np.median(np.diff(x))), (x[-1] - x[0]) / (2 * size))
    search = library().fdvv_spline_free_knots
    search.restype = ctypes.c_double
    samples = (x.size, address(x), address(y), address(weight))
    error = search(*samples, degree, size, ctypes.c_double(spacing), EXCHANGES, address(t), address(c))
    if error < 0:
        raise FitError(f"{size} control points of degree {degree} cannot be fitted to {x.size} samples")
    return t, c


def _knots_and_points(
    x: FloatArray, y: FloatArray, method: FitMethod, degree: int, size: int
) -> tuple[FloatArray, FloatArray]:
    most = min(LARGEST, x.size)
    if not degree < size <= most:
        takes = f"takes {degree + 1} to {most} control points, got {size}"
        raise FitError(f"degree {degree} with {x.size} distinct displacements {takes}")
    if method is FitMethod.ADAPTIVE:
        return _adaptive(x, y, degree, size)
    t = bspline.uniform_knots(x[0], x[-1], size, degree)
    return t, bspline.least_squares(t, degree, x, y)


def _hold_bump(
    x: FloatArray, y: FloatArray, degree: int, t: FloatArray, c: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Repeat a fit that lost more than 5 % of its bump, each time with more weight on peak and valley.

    Least squares cares for the sum of errors, a finger for the snap. Returns the first fit that keeps the
    bump; the plain one if none does before the error has grown by half.
    """
    bump = find_bump(x, y)
    if bump is None:
        return t, c
    near = np.minimum(np.abs(x - bump.peak_mm), np.abs(x - bump.valley_mm)) < BUMP_REACH_mm
    weight, trial, bound = np.ones_like(x), (t, c), math.inf
    for _ in range(BUMP_ROUNDS):
        fitted = bspline.evaluate(*trial, degree, x)
        error, fitted_bump = float(np.sum((fitted - y) ** 2)), find_bump(x, fitted, least_drop_cN=0.0)
        bound = min(bound, BUMP_COST**2 * error)
        if error > bound:
            break
        if fitted_bump and fitted_bump.drop_cN >= BUMP_KEPT_ratio * bump.drop_cN:
            return trial
        weight[near] *= BUMP_WEIGHT
        trial = _adaptive(x, y, degree, c.size, weight)
    return t, c


def _degree(method: FitMethod, degree: int | None) -> int:
    chosen = degree or (3 if method is FitMethod.UNIFORM else 2)
    if not 1 <= chosen <= 3:
        raise FitError(f"degree must be 1, 2 or 3, got {chosen}")
    return chosen


def scan_sizes(
    measured: MeasuredCurve,
    method: FitMethod | str = FitMethod.UNIFORM,
    sizes: Iterable[int] = SCAN_SIZES,
    degree: int | None = None,
    penalty: float = COMPLEXITY_PENALTY,
) -> dict[int, float]:
    """Compute BIC* for each number of control points, on the samples as given; sizes too large are left out.

    The paper's way to choose a size: the smallest BIC* wins.
    """
    method = FitMethod(method)
    chosen = _degree(method, degree)
    x, y, _ = measured.by_displacement()
    scores = {}
    for size in sizes:
        if not chosen < size <= min(LARGEST, x.size):
            continue
        t, c = _knots_and_points(x, y, method, chosen, size)
        error = float(np.sum((bspline.evaluate(t, c, chosen, x) - y) ** 2))
        scores[size] = bic_star(x.size, size, error, penalty)
    return scores


def active_part(measured: MeasuredCurve) -> MeasuredCurve:
    """Cut a stroke to the part from contact to bottom-out (to its end if it did not reach the stop)."""
    start = find_contact_mm(measured)
    end = find_bottom_out_mm(measured, start)
    return measured.between(start, float(measured.displacement_mm[-1]) if end is None else end)


def fit_curve(
    measured: MeasuredCurve,
    method: FitMethod | str = FitMethod.ADAPTIVE,
    control_points: int | None = CONTROL_POINTS,
    degree: int | None = None,
    smoothing_mm: float = 0.0,
    penalty: float = COMPLEXITY_PENALTY,
) -> CurveFit:
    """Fit a B-spline to the samples given; cut them with active_part first.

    Parameters
    ----------
    method : adaptive (default) or uniform knots.
    control_points : how many; None lets BIC* choose among 5 to 40.
    degree : 1 to 3; by default 2 for adaptive knots and 3 for uniform ones.
    smoothing_mm : sigma of a Gaussian applied before the fit. 0, the default, fits the curve as measured.
        Errors and the bump kept are always against the raw curve.

    Raises FitError if there are too few distinct displacements or a setting is out of range.
    """
    import scipy.interpolate  # noqa: F401  loaded here so that the first curve's time_s does not hold it

    started = time.perf_counter()
    method = FitMethod(method)
    chosen = _degree(method, degree)
    x, raw, _ = measured.by_displacement()
    if not (math.isfinite(smoothing_mm) and smoothing_mm >= 0):
        raise FitError(f"smoothing_mm must be 0 or more, got {smoothing_mm}")
    y = smooth(x, raw, smoothing_mm) if smoothing_mm else raw
    if control_points is None:
        smoothed = MeasuredCurve(x, y, measured.stroke, measured.velocity_mm_s)
        by_size = scan_sizes(smoothed, method, degree=chosen, penalty=penalty)
        control_points = min(by_size, key=by_size.__getitem__, default=0)
    t, c = _knots_and_points(x, y, method, chosen, control_points)
    if method is FitMethod.ADAPTIVE:
        t, c = _hold_bump(x, y, chosen, t, c)
    curve = ForceCurve(measured.stroke, measured.velocity_mm_s, chosen, t, c)
    scores = _scores(curve, measured, penalty)
    time_s = time.perf_counter() - started
    return CurveFit(curve, method, **scores, samples=x.size, smoothing_mm=smoothing_mm, time_s=time_s)


def _scores(curve: ForceCurve, measured: MeasuredCurve, penalty: float) -> dict[str, Any]:
    """Return the figures of a fit that tell how well it holds to the raw curve."""
    x, raw, _ = measured.by_displacement()
    fitted = curve.force_cN(x)
    error = fitted - raw
    rows = curve.force_cN(measured.displacement_mm) - measured.force_cN
    bump, fitted_bump = find_bump(x, raw), find_bump(x, fitted, least_drop_cN=0.0)
    squared = float(np.sum(error**2))
    return {
        "rmse_cN": math.sqrt(squared / x.size),
        "max_cN": float(np.abs(error).max()),
        "rows_rmse_cN": float(np.sqrt(np.mean(rows**2))),
        "bump_kept_ratio": fitted_bump.drop_cN / bump.drop_cN if bump and fitted_bump else None,
        "bic_star": bic_star(x.size, curve.control_points_cN.size, squared, penalty),
    }

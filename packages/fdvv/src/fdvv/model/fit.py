"""From samples to a B-spline: the paper's uniform knots, and knots placed where the curve needs them."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np

from fdvv.errors import FitError
from fdvv.model import bspline
from fdvv.model.bump import find_bottom_out_mm, find_contact_mm
from fdvv.model.bump_kept import drop_ratio, is_felt, is_kept, median_drop_ratio
from fdvv.model.curve import ForceCurve, MeasuredCurve
from fdvv.model.fit_holds import hold_bump, hold_floor
from fdvv.model.knot_search import LARGEST, KnotPath, Spline, free_knots, knot_path, refine
from fdvv.model.residual import holds_shape
from fdvv.units import FloatArray

PAPERS_CONTROL_POINTS = 15
COMPLEXITY_PENALTY = 2.5
"""P of the paper's BIC*."""

SCAN_SIZES = range(5, 41)
AUTO_LEAST = 5
SCHWARZ_PENALTY = 1.0
"""P of Schwarz's BIC, for a residual that still holds shape."""
AUTO_SAMPLES = 16
"""With fewer distinct displacements the number cannot be chosen."""
AUTO_EXCHANGES = 3
"""Knot exchanges once a size is chosen; fifteen gained nothing on 118 real strokes."""
MOST_SAMPLES = 8192
"""More are averaged in groups for the search; scores are against all of them."""
AUTO_STEP = 4
"""Control points added while the bump is not kept and BIC* is not above that of 15."""


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
    bump_kept_ratio : drop of the fitted bump over that of the raw curve, as means over 50 um, no coarser than
        a finger; None if the raw has no bump.
    bump_kept_samples_ratio : the same with medians of 5 samples, which no finger resolves.
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
    bump_kept_samples_ratio: float | None
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


def _fit_spline(x: FloatArray, y: FloatArray, method: FitMethod, degree: int, size: int) -> Spline:
    most = min(LARGEST, x.size)
    if not degree < size <= most:
        takes = f"takes {degree + 1} to {most} control points, got {size}"
        raise FitError(f"degree {degree} with {x.size} distinct displacements {takes}")
    if method is FitMethod.ADAPTIVE:
        return free_knots(x, y, degree, size)
    t = bspline.uniform_knots(x[0], x[-1], size, degree)
    return t, bspline.least_squares(t, degree, x, y)


def _fit_with_holds(x: FloatArray, y: FloatArray, method: FitMethod, degree: int, size: int) -> Spline:
    """Fit a number of control points; free knots keep the bump, and no force lies below the measured ones."""

    def search(x: FloatArray, y: FloatArray, weight: FloatArray) -> Spline:
        return free_knots(x, y, degree, size, weight)

    spline = _fit_spline(x, y, method, degree, size)
    if method is FitMethod.ADAPTIVE:
        spline = hold_bump(x, y, degree, spline, search, is_felt)
        return hold_floor(x, y, degree, spline, search)
    return hold_floor(x, y, degree, spline, lambda *_: spline)


def _auto(x: FloatArray, y: FloatArray, degree: int, penalty: float) -> Spline:
    """Choose the number of free control points: the least BIC*, more while the bump is not kept.

    Where that leaves shape, the least BIC (P = 1). Never above the BIC* of 15.
    """
    if x.size < AUTO_SAMPLES:
        raise FitError(f"auto takes {AUTO_SAMPLES} distinct displacements, got {x.size}: ask for a number")
    papers = _fit_with_holds(x, y, FitMethod.ADAPTIVE, degree, PAPERS_CONTROL_POINTS)
    bound = _score(x, y, degree, papers, penalty)
    path = knot_path(x, y, degree, (AUTO_LEAST, min(LARGEST, x.size)))
    tried = [papers]
    for start in _starts(x, y, degree, path, penalty):
        # control points first, weight on the bump only where they do not help
        for hold in (False, True):
            for size in range(start, max(path) + 1, AUTO_STEP):
                fit = _from_knots(x, y, degree, path[size][1], hold)
                if _score(x, y, degree, fit, penalty) > bound:
                    break
                if is_kept(x, y, bspline.evaluate(*fit, degree, x)):
                    return fit
                tried.append(fit)
    return min(tried, key=lambda spline: _score(x, y, degree, spline, penalty))


def _starts(x: FloatArray, y: FloatArray, degree: int, path: KnotPath, penalty: float) -> list[int]:
    """Return the sizes to start at: that of the least BIC*, before it that of BIC where BIC* leaves shape."""
    best, more = _least(path, x.size, penalty), _least(path, x.size, SCHWARZ_PENALTY)
    knots = path[best][1]
    fitted = bspline.evaluate(knots, bspline.least_squares(knots, degree, x, y), degree, x)
    return [more, best] if more > best and holds_shape(y, fitted) else [best]


def _least(path: KnotPath, samples: int, penalty: float) -> int:
    return min(path, key=lambda size: bic_star(samples, size, path[size][0], penalty))


def _from_knots(x: FloatArray, y: FloatArray, degree: int, knots: FloatArray, hold: bool) -> Spline:
    def search(x: FloatArray, y: FloatArray, weight: FloatArray) -> Spline:
        return refine(x, y, degree, knots, AUTO_EXCHANGES, weight)

    spline = search(x, y, np.ones_like(x))
    if hold:
        spline = hold_bump(x, y, degree, spline, search, is_kept)
    return hold_floor(x, y, degree, spline, search)


def _score(x: FloatArray, y: FloatArray, degree: int, spline: Spline, penalty: float) -> float:
    squared = float(np.sum((bspline.evaluate(*spline, degree, x) - y) ** 2))
    return bic_star(x.size, spline[1].size, squared, penalty)


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
        scores[size] = _score(x, y, chosen, _fit_spline(x, y, method, chosen, size), penalty)
    return scores


def active_part(measured: MeasuredCurve) -> MeasuredCurve:
    """Cut a stroke to the part from contact to bottom-out (to its end if it did not reach the stop)."""
    start = find_contact_mm(measured)
    end = find_bottom_out_mm(measured, start)
    return measured.between(start, float(measured.displacement_mm[-1]) if end is None else end)


def fit_curve(
    measured: MeasuredCurve,
    method: FitMethod | str = FitMethod.ADAPTIVE,
    control_points: int | None = None,
    degree: int | None = None,
    smoothing_mm: float = 0.0,
    penalty: float = COMPLEXITY_PENALTY,
) -> CurveFit:
    """Fit a B-spline to the samples given; cut them with active_part first.

    Parameters
    ----------
    method : adaptive (default) or uniform knots.
    control_points : how many; None, the default, lets BIC* choose (uniform knots: among 5 to 40); the paper
        has 15.
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
    x, y = _average_groups(x, y)
    if control_points is None and method is FitMethod.ADAPTIVE:
        t, c = _auto(x, y, chosen, penalty)
    else:
        if control_points is None:
            smoothed = MeasuredCurve(x, y, measured.stroke, measured.velocity_mm_s)
            by_size = scan_sizes(smoothed, method, degree=chosen, penalty=penalty)
            control_points = min(by_size, key=by_size.__getitem__, default=0)
        t, c = _fit_with_holds(x, y, method, chosen, control_points)
    curve = ForceCurve(measured.stroke, measured.velocity_mm_s, chosen, t, c)
    scores = _scores(curve, measured, penalty)
    time_s = time.perf_counter() - started
    return CurveFit(curve, method, **scores, samples=x.size, smoothing_mm=smoothing_mm, time_s=time_s)


def _average_groups(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Average groups of successive samples, both ends kept, so that at most MOST_SAMPLES remain."""
    if x.size <= MOST_SAMPLES:
        return x, y
    starts = np.arange(1, x.size - 1, math.ceil((x.size - 2) / (MOST_SAMPLES - 2)))
    counts = np.diff(np.append(starts, x.size - 1))

    def means(values: FloatArray) -> FloatArray:
        return np.concatenate([values[:1], np.add.reduceat(values[:-1], starts) / counts, values[-1:]])

    return means(x), means(y)


def _scores(curve: ForceCurve, measured: MeasuredCurve, penalty: float) -> dict[str, Any]:
    """Return the figures of a fit that tell how well it holds to the raw curve."""
    x, raw, _ = measured.by_displacement()
    fitted = curve.force_cN(x)
    error = fitted - raw
    rows = curve.force_cN(measured.displacement_mm) - measured.force_cN
    squared = float(np.sum(error**2))
    return {
        "rmse_cN": math.sqrt(squared / x.size),
        "max_cN": float(np.abs(error).max()),
        "rows_rmse_cN": float(np.sqrt(np.mean(rows**2))),
        "bump_kept_ratio": drop_ratio(x, raw, fitted),
        "bump_kept_samples_ratio": median_drop_ratio(raw, fitted),
        "bic_star": bic_star(x.size, curve.control_points_cN.size, squared, penalty),
    }

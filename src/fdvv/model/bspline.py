"""Clamped B-splines: basis, evaluation, interpolation and least squares on given knots.

Notation: t (n + k + 1,) knots, c (n,) coefficients, k degree, x abscissae. The recurrence is
de Boor's (A Practical Guide to Splines, ch. IX), evaluated by SciPy.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.units import FloatArray


def check(t: FloatArray, c: FloatArray, k: int) -> None:
    """Raise ModelError unless (t, c, k) is a clamped spline with no knot of more than k + 1 repeats."""
    if not 1 <= k <= 5:
        raise ModelError(f"degree must be 1 to 5, got {k}")
    if c.size < k + 1:
        raise ModelError(f"degree {k} needs at least {k + 1} control points, got {c.size}")
    if t.size != c.size + k + 1:
        raise ModelError(f"{c.size} control points of degree {k} need {c.size + k + 1} knots, got {t.size}")
    if np.any(np.diff(t) < 0):
        raise ModelError("knots_mm must not fall")
    if t[0] != t[k] or t[-1] != t[-k - 1]:
        raise ModelError(f"the first and last {k + 1} knots must be equal, got {t[: k + 1]}, {t[-k - 1 :]}")
    if np.any(t[k + 1 :] - t[: -k - 1] <= 0):
        raise ModelError(f"no knot may repeat more than {k + 1} times and the curve needs a length")


def uniform_knots(start: float, end: float, n: int, k: int) -> FloatArray:
    """Make clamped knots with equal spans for n coefficients of degree k."""
    inner = np.linspace(start, end, n - k + 1)[1:-1]
    return np.concatenate([np.full(k + 1, start), inner, np.full(k + 1, end)])


def greville(t: FloatArray, k: int) -> FloatArray:
    """Average k successive knots: the abscissa at which each coefficient acts."""
    windows = np.lib.stride_tricks.sliding_window_view(t[1:-1], k)
    return np.asarray(windows.mean(axis=1))


def evaluate(t: FloatArray, c: FloatArray, k: int, x: npt.ArrayLike, derivative: int = 0) -> FloatArray:
    """Evaluate the spline or a derivative at x; outside the knots end values and derivative 0."""
    from scipy.interpolate import BSpline

    x = np.asarray(x, dtype=np.float64)
    inside = np.clip(x, t[0], t[-1])
    values = np.asarray(BSpline(t, c, k)(inside, nu=derivative), dtype=np.float64)
    return np.where(inside == x, values, 0.0) if derivative else values


def design_matrix(t: FloatArray, k: int, x: FloatArray) -> FloatArray:
    """Give the dense (x.size, n) matrix of basis values, for x inside the knots."""
    from scipy.interpolate import BSpline

    return np.asarray(BSpline.design_matrix(x, t, k).toarray())


def least_squares(t: FloatArray, k: int, x: FloatArray, y: FloatArray) -> FloatArray:
    """Find the coefficients that minimise the squared error at (x, y), each sample counting once.

    Where a gap in x leaves a basis function without samples, the solution of least norm is taken.
    """
    from scipy.interpolate import make_lsq_spline

    try:
        return np.asarray(make_lsq_spline(x, y, t, k).c, dtype=np.float64)
    except (ValueError, np.linalg.LinAlgError):
        solution, *_ = np.linalg.lstsq(design_matrix(t, k, x), y, rcond=None)
        return np.asarray(solution)


def interpolate(x: FloatArray, y: FloatArray, k: int = 3) -> tuple[FloatArray, FloatArray]:
    """Interpolate (x, y) with not-a-knot ends: (t, c), one coefficient per node."""
    from scipy.interpolate import make_interp_spline

    spline = make_interp_spline(x, y, k=k)
    return np.asarray(spline.t, dtype=np.float64), np.asarray(spline.c, dtype=np.float64)

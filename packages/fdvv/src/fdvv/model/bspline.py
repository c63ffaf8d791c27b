"""Clamped B-splines: basis, evaluation, interpolation and least squares on given knots.

Notation: t (n + k + 1,) knots, c (n,) coefficients, k degree, x abscissae. The recurrence is
de Boor's (A Practical Guide to Splines, ch. IX), evaluated by SciPy.
"""

from __future__ import annotations

import ctypes
from dataclasses import fields

import numpy as np
import numpy.typing as npt

from fdvv._native import address, library
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
    """Return clamped knots with equal spans for n coefficients of degree k."""
    inner = np.linspace(start, end, n - k + 1)[1:-1]
    return np.concatenate([np.full(k + 1, start), inner, np.full(k + 1, end)])


def greville(t: FloatArray, k: int) -> FloatArray:
    """Average k successive knots: the abscissa at which each coefficient acts."""
    windows = np.lib.stride_tricks.sliding_window_view(t[1:-1], k)
    return np.asarray(windows.mean(axis=1))


def evaluate(t: FloatArray, c: FloatArray, k: int, x: npt.ArrayLike, derivative: int = 0) -> FloatArray:
    """Evaluate the spline or a derivative at x; outside the knots end values and derivative 0."""
    x = np.asarray(x, dtype=np.float64)
    if derivative > k:
        return np.zeros(x.shape)
    inside = np.clip(x, t[0], t[-1])
    # SciPy's BSpline gives the same bits, and takes half a second to import
    t, c, flat = (np.ascontiguousarray(part, dtype=np.float64) for part in (t, c, inside))
    values = np.empty(x.shape)
    sizes = ctypes.c_long(c.size), ctypes.c_int(k)
    status = library().fdvv_spline_evaluate(
        *sizes,
        address(t),
        address(c),
        ctypes.c_int(derivative),
        ctypes.c_long(flat.size),
        address(flat),
        address(values),
    )
    if status:
        raise ModelError(f"a spline of degree {k} with {c.size} control points cannot be evaluated")
    return np.where(inside == x, values, 0.0) if derivative else values


def design_matrix(t: FloatArray, k: int, x: FloatArray) -> FloatArray:
    """Return the dense (x.size, n) matrix of basis values, for x inside the knots."""
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


LARGEST_mm, LARGEST_cN = 1e3, 1e6
"""A metre and ten kilonewtons: beyond any button, within what can be tabulated and squared."""


def column(values: npt.ArrayLike, name: str) -> FloatArray:
    """Return a read-only 1-D float column; ModelError for what is not finite."""
    array = np.array(values, dtype=np.float64)
    if array.ndim != 1:
        raise ModelError(f"{name} must be one column, got {array.shape = }")
    if not np.isfinite(array).all():
        at = int(np.flatnonzero(~np.isfinite(array))[0])
        raise ModelError(f"{name} must be finite, got {array[at]} at index {at}")
    array.setflags(write=False)
    return array


def set_columns(record: object, *names: str) -> None:
    """Make fields of a frozen record read-only columns of its own. Raises ModelError."""
    for name in names:
        object.__setattr__(record, name, column(getattr(record, name), name))


class ExactlyEqual:
    """A record with arrays that equals another if all fields do, arrays to the bit."""

    def _key(self) -> tuple[object, ...]:
        values = (getattr(self, field.name) for field in fields(self))  # type: ignore[arg-type]
        return tuple(v.tobytes() if isinstance(v, np.ndarray) else v for v in values)

    def __eq__(self, other: object) -> bool:
        return self._key() == other._key() if isinstance(other, type(self)) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._key())


def check_velocity(velocity_mm_s: float | None, name: str = "velocity_mm_s") -> None:
    """Raise ModelError unless a velocity is positive and finite, or None (unknown)."""
    if velocity_mm_s is not None and not (np.isfinite(velocity_mm_s) and velocity_mm_s > 0):
        raise ModelError(f"{name} must be positive and finite, got {velocity_mm_s}")


def check_size(values: npt.ArrayLike, limit: float, name: str) -> None:
    worst = float(np.abs(values).max())
    if worst > limit:
        raise ModelError(f"{name} must stay within {limit:g}, got {worst:g}")


def check_spread(value: float | None, name: str) -> None:
    """Raise ModelError unless a standard deviation is at least 0 and finite, or None (unknown)."""
    if value is not None and not (np.isfinite(value) and value >= 0):
        raise ModelError(f"{name} must be at least 0 and finite, got {value}")


def check_presses(presses: int) -> None:
    if presses < 2:
        raise ModelError(f"a spread takes at least 2 presses, got {presses}")

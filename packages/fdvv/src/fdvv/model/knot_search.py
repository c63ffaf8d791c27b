"""Free knots, by the compiled search: of one size, of every size, and on from given knots."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence

import numpy as np

from fdvv._native import address, library
from fdvv.errors import FitError
from fdvv.units import FloatArray

Spline = tuple[FloatArray, FloatArray]
"""Knots and coefficients."""

KnotPath = dict[int, tuple[float, FloatArray]]
"""Squared error and knots, by number of control points."""

LARGEST = 64
ROW = LARGEST + 4
"""Knots that the kernel leaves room for per size."""

EXCHANGES = 15
"""Knot exchanges to try before the search ends; twice as many gained nothing on 96 real strokes."""


def free_knots(
    x: FloatArray, y: FloatArray, degree: int, size: int, weight: FloatArray | None = None
) -> Spline:
    """Place the knots freely; no two closer than the samples, so that samples hold every basis function.

    x, y : (n,), x strictly rising. weight : (n,), of the squared errors; 1 by default. Raises FitError.
    """
    return _search("fdvv_spline_free_knots", x, y, degree, np.zeros(size + degree + 1), weight, EXCHANGES)


def refine(
    x: FloatArray,
    y: FloatArray,
    degree: int,
    knots: FloatArray,
    exchanges: int,
    weight: FloatArray | None = None,
) -> Spline:
    """Search on from knots that are good already; the rest as free_knots. Raises FitError."""
    return _search("fdvv_spline_refine", x, y, degree, knots.copy(), weight, exchanges)


def _search(
    kernel: str,
    x: FloatArray,
    y: FloatArray,
    degree: int,
    t: FloatArray,
    weight: FloatArray | None,
    exchanges: int,
) -> Spline:
    size = t.size - degree - 1
    c = np.zeros(size)
    weight = np.ones_like(x) if weight is None else weight
    x, y, weight = (np.ascontiguousarray(column) for column in (x, y, weight))
    search = getattr(library(), kernel)
    search.restype = ctypes.c_double
    samples = (x.size, address(x), address(y), address(weight))
    error = search(
        *samples, degree, size, ctypes.c_double(_spacing(x, size)), exchanges, address(t), address(c)
    )
    if error < 0:
        raise FitError(f"{size} control points of degree {degree} cannot be fitted to {x.size} samples")
    return t, c


def knot_path(x: FloatArray, y: FloatArray, degree: int, sizes: Sequence[int]) -> KnotPath:
    """Search knots of every size: squared error and knots by number of control points.

    sizes : least and most. Each size is found from the next by removing the least important knot, so that all
    of them take about as long as one search; refine brings one to its end. Raises FitError.
    """
    least, most = sizes
    errors, knots = np.zeros(most + 1), np.zeros((most + 1, ROW))
    x, y = np.ascontiguousarray(x), np.ascontiguousarray(y)
    spacing = ctypes.c_double(_spacing(x, most))
    start = library().fdvv_spline_path(
        x.size, address(x), address(y), degree, least, most, spacing, address(errors), address(knots)
    )
    if start < 0:
        raise FitError(f"{least} control points of degree {degree} cannot be fitted to {x.size} samples")
    return {m: (float(errors[m]), knots[m, : m + degree + 1].copy()) for m in range(least, start + 1)}


def _spacing(x: FloatArray, size: int) -> float:
    return min(float(np.median(np.diff(x))), float(x[-1] - x[0]) / (2 * size))

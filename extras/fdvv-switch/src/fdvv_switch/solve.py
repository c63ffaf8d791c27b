"""Least squares with bounds, the one solver of all designs."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fdvv.units import FloatArray


def solve(
    miss: Callable[[FloatArray], FloatArray],
    start: FloatArray,
    low: FloatArray,
    high: FloatArray,
    evaluations: int = 80,
) -> tuple[FloatArray, float]:
    """Return the parameters of the least sum of squares and that sum, from a start that is put inside.

    Trust region reflective with numerical derivatives, scaled by them (SciPy); no random numbers.
    """
    from scipy.optimize import least_squares

    room = 1e-6 * np.minimum(high - low, 1.0)
    inside = np.clip(start, low + room, high - room)
    found = least_squares(miss, inside, bounds=(low, high), x_scale="jac", max_nfev=evaluations)
    return np.asarray(found.x), float(found.cost)


def rms(values: FloatArray) -> float:
    """Return the root of the mean square."""
    return float(np.sqrt(np.mean(np.square(values))))

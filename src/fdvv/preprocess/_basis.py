"""Cubic B-splines on even knots, as rows of a design matrix."""

from __future__ import annotations

import numpy as np

from fdvv.units import FloatArray


class EvenBasis:
    """Cubic B-splines on even knots over start, start + step, ...; pieces + 3 of them.

    Parameters
    ----------
    start, step : first knot and spacing, in the unit of what is passed to rows.
    pieces : number of spans.
    """

    def __init__(self, start: float, step: float, pieces: int) -> None:
        self.start, self.step, self.pieces = start, step, pieces

    @property
    def size(self) -> int:
        """Count the functions."""
        return self.pieces + 3

    def rows(self, at: FloatArray, derivative: int = 0) -> FloatArray:
        """Evaluate every function or its derivative of order 0 to 2, (len(at), size); ends held."""
        place = np.clip((at - self.start) / self.step, 0.0, float(self.pieces))
        left = np.minimum(place.astype(np.int64), self.pieces - 1)
        u = place - left
        matrix = np.zeros((at.size, self.size))
        for k, weight in enumerate(_WEIGHTS[derivative](u)):
            matrix[np.arange(at.size), left + k] = weight / self.step**derivative
        return matrix


def _values(u: FloatArray) -> tuple[FloatArray, ...]:
    return (1 - u) ** 3 / 6, (3 * u**3 - 6 * u**2 + 4) / 6, (3 * (u + u**2 - u**3) + 1) / 6, u**3 / 6


def _slopes(u: FloatArray) -> tuple[FloatArray, ...]:
    return -((1 - u) ** 2) / 2, (3 * u**2 - 4 * u) / 2, (1 + 2 * u - 3 * u**2) / 2, u**2 / 2


def _bends(u: FloatArray) -> tuple[FloatArray, ...]:
    return 1 - u, 3 * u - 2, 1 - 3 * u, u


_WEIGHTS = (_values, _slopes, _bends)


def rough(size: int) -> FloatArray:
    """Give the matrix of third differences, (size - 3, size): what a smooth spline keeps small."""
    return np.diff(np.eye(size), 3, axis=0)

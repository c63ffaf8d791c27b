"""Force between the measured velocities: curves at several speeds make one surface.

Notation: v the n measured velocities, h (n - 1,) their steps, y (n, ...) the curves' values at the given
displacements, d (n - 1, ...) the secants diff(y) / h, m (n, ...) the slopes over velocity.
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum
from typing import NamedTuple

import numpy as np

from fdvv.model.curve import ForceCurve
from fdvv.units import FloatArray


class Interpolation(StrEnum):
    """How force is found at a velocity between curves; outside their range the end curve holds.

    NEAREST takes the nearest curve (the slower one half-way) and is not continuous; LINEAR is the
    paper's; PCHIP is monotone piecewise cubic, smooth in velocity, and never leaves the range of the two
    curves beside it. docs/explanation/velocity.md compares them.
    """

    NEAREST = "nearest"
    LINEAR = "linear"
    PCHIP = "pchip"


class _Place(NamedTuple):
    """Where velocities lie among the measured ones: between curves lower and lower + 1, at part of h."""

    lower: np.ndarray[tuple[int, ...], np.dtype[np.intp]]
    part: FloatArray
    h: FloatArray
    outside: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]


def blend(
    curves: Sequence[ForceCurve],
    method: Interpolation,
    velocity_mm_s: FloatArray,
    displacement_mm: FloatArray,
    derivative: int = 0,
) -> FloatArray:
    """Evaluate force (cN) or its displacement derivative (cN/mm) on a surface of curves.

    curves : one stroke, velocities rising; a single curve serves every velocity.
    velocity_mm_s, displacement_mm : arrays of one common shape, which is the result's.

    At a measured velocity the result is that curve's, to the bit.
    """
    if len(curves) == 1:
        return (
            curves[0].stiffness_cN_mm(displacement_mm) if derivative else curves[0].force_cN(displacement_mm)
        )
    v = _speeds(curves)
    at = _locate(v, velocity_mm_s)
    y = _evaluate(curves, displacement_mm, derivative)
    if method is Interpolation.NEAREST:
        return _take(y, at.lower + (at.part > 0.5))
    low, high = _take(y, at.lower), _take(y, at.lower + 1)
    if method is Interpolation.LINEAR or len(curves) == 2:
        return np.asarray((1 - at.part) * low + at.part * high)
    force = _evaluate(curves, displacement_mm) if derivative else y
    m = _slopes(v, force, y)
    s = at.part
    bend = s * (1 - s) * at.h * ((1 - s) * _take(m, at.lower) - s * _take(m, at.lower + 1))
    return np.asarray((1 - s) ** 2 * (1 + 2 * s) * low + s**2 * (3 - 2 * s) * high + bend)


def blend_slope(
    curves: Sequence[ForceCurve],
    method: Interpolation,
    velocity_mm_s: FloatArray,
    displacement_mm: FloatArray,
) -> FloatArray:
    """Evaluate dF/dv (cN s/mm), arguments as for blend.

    Outside the measured velocities, with NEAREST and with a single curve it is 0; where LINEAR has a
    corner it is the slope towards the faster curve.
    """
    if len(curves) == 1 or method is Interpolation.NEAREST:
        return np.zeros(displacement_mm.shape)
    v = _speeds(curves)
    at = _locate(v, velocity_mm_s)
    y = _evaluate(curves, displacement_mm)
    secant = (_take(y, at.lower + 1) - _take(y, at.lower)) / at.h
    if method is Interpolation.PCHIP and len(curves) > 2:
        m = _slopes(v, y, y)
        low, high, s = _take(m, at.lower), _take(m, at.lower + 1), at.part
        secant = 6 * s * (1 - s) * secant + (1 - s) * (1 - 3 * s) * low + s * (3 * s - 2) * high
    return np.where(at.outside, 0.0, secant)


def _speeds(curves: Sequence[ForceCurve]) -> FloatArray:
    return np.array([c.velocity_mm_s for c in curves], dtype=np.float64)


def _evaluate(curves: Sequence[ForceCurve], x: FloatArray, derivative: int = 0) -> FloatArray:
    return np.stack([c.stiffness_cN_mm(x) if derivative else c.force_cN(x) for c in curves])


def _locate(v: FloatArray, wanted: FloatArray) -> _Place:
    held = np.clip(wanted, v[0], v[-1])
    lower = np.clip(np.searchsorted(v, held, side="right") - 1, 0, v.size - 2)
    h = v[lower + 1] - v[lower]
    return _Place(lower, (held - v[lower]) / h, h, held != wanted)


def _take(y: FloatArray, index: np.ndarray[tuple[int, ...], np.dtype[np.intp]]) -> FloatArray:
    return np.asarray(np.take_along_axis(y, index[np.newaxis], axis=0)[0])


def _slopes(v: FloatArray, force: FloatArray, y: FloatArray) -> FloatArray:
    """Return the PCHIP slopes over velocity, (n, ...), for n >= 3 curves.

    Inside they are the weighted harmonic means of the secants beside them, 0 where those differ in sign
    (Fritsch and Butland, SIAM J. Sci. Stat. Comput. 5, 1984). Such slopes are homogeneous in the
    secants, so by Euler the partial derivatives, taken at force, weigh the secants of force into slopes
    and the secants of y = dF/dx into the slopes' own derivative over x.
    """
    h = np.diff(v).reshape(-1, *(1,) * (force.ndim - 1))
    d, of = np.diff(force, axis=0) / h, np.diff(y, axis=0) / h
    w1, w2 = h[:-1] + 2 * h[1:], 2 * h[:-1] + h[1:]
    agree = d[:-1] * d[1:] > 0
    total = np.where(agree, w1 * d[1:] + w2 * d[:-1], 1.0)
    inner = (w1 + w2) * (w1 * (d[1:] / total) ** 2 * of[:-1] + w2 * (d[:-1] / total) ** 2 * of[1:])
    first = _end_slope(h[0], h[1], d[0], d[1], of[0], of[1])
    last = _end_slope(h[-1], h[-2], d[-1], d[-2], of[-1], of[-2])
    return np.concatenate([first[np.newaxis], np.where(agree, inner, 0.0), last[np.newaxis]])


def _end_slope(
    h0: FloatArray, h1: FloatArray, d0: FloatArray, d1: FloatArray, of0: FloatArray, of1: FloatArray
) -> FloatArray:
    """Return the slope at an end: of the parabola through three curves, bounded to stay monotone."""
    far = h0 / (h0 + h1)
    slope = (1 + far) * d0 - far * d1
    parabola = (1 + far) * of0 - far * of1
    steep = (d0 * d1 < 0) & (np.abs(slope) > 3 * np.abs(d0))
    return np.where(slope * d0 <= 0, 0.0, np.where(steep, 3 * of0, parabola))

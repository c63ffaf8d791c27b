"""Put a piece of one B-spline into another, exactly: cut, bridge, join.

Notation: t knots, c coefficients, k degree of a clamped spline, as in _bspline.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fdvv.errors import ModelError
from fdvv.model import _bspline
from fdvv.model._curve import ForceCurve
from fdvv.units import FloatArray

NEAR_mm = 1e-9
"""Cuts this close to a knot are moved onto it: a shorter span would only hold rounding."""

BRIDGE_DEGREE = 3
"""A bridge meets a value and a slope at both ends, which takes a cubic."""


class _Piece(NamedTuple):
    """A clamped spline on its own interval."""

    t: FloatArray
    c: FloatArray

    def start(self, k: int) -> tuple[float, float, float]:
        """Give place, value and slope at the start."""
        slope = k * (self.c[1] - self.c[0]) / (self.t[k + 1] - self.t[0])
        return float(self.t[0]), float(self.c[0]), float(slope)

    def end(self, k: int) -> tuple[float, float, float]:
        """Give place, value and slope at the end."""
        slope = k * (self.c[-1] - self.c[-2]) / (self.t[-1] - self.t[-k - 2])
        return float(self.t[-1]), float(self.c[-1]), float(slope)


def splice(
    base: ForceCurve, insert: ForceCurve, segment_mm: tuple[float, float], blend_mm: float
) -> ForceCurve:
    """Make base follow insert on a segment.

    Inside the segment the result is insert, beyond it by more than blend_mm it is base, both to
    rounding; between lies one cubic that continues value and slope on both sides. At an end of base
    there is no bridge, near one it is shorter. The degree is the larger of the two and at least 3; the
    control points of base away from the segment stay as they are where its degree does.

    Raises ModelError if the segment is empty or leaves either curve, if blend_mm is not positive, or if
    a curve that jumps would have to be raised in degree.
    """
    _check(base, insert, segment_mm, blend_mm)
    k = max(base.degree, insert.degree, BRIDGE_DEGREE)
    outer, inner = _elevated(base, k), _elevated(insert, k)
    a, b = (_onto_knot(outer.t, _onto_knot(inner.t, x)) for x in segment_mm)
    middle = _cut(inner, k, a, b)
    pieces = [middle]
    if a > base.start_mm:
        left = _cut(outer, k, base.start_mm, _onto_knot(outer.t, max(base.start_mm, a - blend_mm)))
        before = left.end(k) if left.c.size else outer.start(k)
        pieces = [*([left] if left.c.size else []), _bridge(before, middle.start(k), k), *pieces]
    if b < base.end_mm:
        right = _cut(outer, k, _onto_knot(outer.t, min(base.end_mm, b + blend_mm)), base.end_mm)
        after = right.start(k) if right.c.size else outer.end(k)
        pieces = [*pieces, _bridge(middle.end(k), after, k), *([right] if right.c.size else [])]
    t, c = _joined(pieces, k)
    return ForceCurve(base.stroke, base.velocity_mm_s, k, t, c)


def _check(base: ForceCurve, insert: ForceCurve, segment_mm: tuple[float, float], blend_mm: float) -> None:
    a, b = segment_mm
    if not (np.isfinite([a, b]).all() and b - a > NEAR_mm):
        raise ModelError(f"segment_mm must rise, got {a:g} to {b:g} mm")
    if not (np.isfinite(blend_mm) and blend_mm > NEAR_mm):
        raise ModelError(f"blend_mm must be positive, got {blend_mm}")
    for which, curve in (("edited", base), ("assigned", insert)):
        if a < curve.start_mm - NEAR_mm or b > curve.end_mm + NEAR_mm:
            reach = f"{curve.start_mm:g} to {curve.end_mm:g} mm"
            raise ModelError(
                f"segment {a:g} to {b:g} mm leaves the {which} curve, which reaches from {reach}"
            )


def _onto_knot(t: FloatArray, x: float) -> float:
    nearest = float(t[np.argmin(np.abs(t - x))])
    return nearest if abs(nearest - x) <= NEAR_mm else x


def _elevated(curve: ForceCurve, k: int) -> _Piece:
    """Write a curve in a higher degree: every knot gains a repeat, and the larger space holds the curve."""
    t, c = curve.knots_mm, curve.control_points_cN
    for degree in range(curve.degree, k):
        knots, repeats = np.unique(t, return_counts=True)
        if np.any(repeats[1:-1] > degree):
            raise ModelError(f"a curve of degree {degree} with a jump cannot be raised to degree {k}")
        raised = np.repeat(knots, repeats + 1)
        sites = _bspline.greville(raised, degree + 1)
        values = _bspline.evaluate(t, c, degree, sites)
        t, c = raised, np.asarray(np.linalg.solve(_bspline.design_matrix(raised, degree + 1, sites), values))
    return _Piece(t, c)


def _cut(piece: _Piece, k: int, a: float, b: float) -> _Piece:
    """Restrict a spline to [a, b] by knot insertion; empty if a = b."""
    from scipy.interpolate import BSpline

    if b <= a:
        return _Piece(np.empty(0), np.empty(0))
    spline = BSpline(piece.t, piece.c, k)
    for x in (a, b):
        missing = k - int(np.count_nonzero(spline.t == x))
        if missing > 0:
            spline = spline.insert_knot(x, missing)
    # insert_knot pads the coefficients to the length of the knots
    first, last = np.searchsorted(spline.t, a, "right"), np.searchsorted(spline.t, b, "left")
    t = np.concatenate([np.full(k + 1, a), spline.t[first:last], np.full(k + 1, b)])
    return _Piece(t, np.asarray(spline.c[first - 1 - k : last]))


def _bridge(start: tuple[float, float, float], end: tuple[float, float, float], k: int) -> _Piece:
    """Make one Bézier piece of degree k with the given place, value and slope at either end."""
    (a, y0, m0), (b, y1, m1) = start, end
    second, last_but_one = y0 + (b - a) * m0 / k, y1 - (b - a) * m1 / k
    c = np.concatenate([[y0], np.linspace(second, last_but_one, k - 1), [y1]])
    return _Piece(np.repeat([a, b], k + 1), c)


def _joined(pieces: list[_Piece], k: int) -> tuple[FloatArray, FloatArray]:
    """Join pieces that share value and slope: the control point at a joint is then no freedom of its own."""
    t, c = pieces[0]
    for piece in pieces[1:]:
        t = np.concatenate([t[:-2], piece.t[k + 1 :]])
        c = np.concatenate([c[:-1], piece.c[1:]])
    return t, c

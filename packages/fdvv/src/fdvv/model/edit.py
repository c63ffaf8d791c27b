"""Edit models as values: merge, assign a curve or a piece of one, copy, remove; nothing changes in place.

Put a piece of one B-spline into another, exactly: cut, bridge, join.

Notation: t knots, c coefficients, k degree of a clamped spline, as in bspline.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from enum import StrEnum
from typing import NamedTuple, TypeVar

import numpy as np

from fdvv.errors import ModelError
from fdvv.model import bspline
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.model import FDVVModel, Provenance
from fdvv.model.spread import PointSpread
from fdvv.model.velocity import Interpolation
from fdvv.model.vibration import Vibration
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
        """Return the position, value and slope there."""
        slope = k * (self.c[1] - self.c[0]) / (self.t[k + 1] - self.t[0])
        return float(self.t[0]), float(self.c[0]), float(slope)

    def end(self, k: int) -> tuple[float, float, float]:
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
    outer, inner = _elevate(base, k), _elevate(insert, k)
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
    t, c = _concatenate_pieces(pieces, k)
    return ForceCurve(base.stroke, base.velocity_mm_s, k, t, c)


def _check(base: ForceCurve, insert: ForceCurve, segment_mm: tuple[float, float], blend_mm: float) -> None:
    a, b = segment_mm
    if not (np.isfinite([a, b]).all() and b - a > NEAR_mm):
        raise ModelError(f"segment_mm must rise, got {a:g} to {b:g} mm")
    if not (np.isfinite(blend_mm) and blend_mm > NEAR_mm):
        raise ModelError(f"blend_mm must be positive, got {blend_mm}")
    for which, curve in (("edited", base), ("assigned", insert)):
        if a < curve.start_mm - NEAR_mm or b > curve.end_mm + NEAR_mm:
            reach = f"which reaches from {curve.start_mm:g} to {curve.end_mm:g} mm"
            raise ModelError(f"segment {a:g} to {b:g} mm leaves the {which} curve, {reach}")


def _onto_knot(t: FloatArray, x: float) -> float:
    nearest = float(t[np.argmin(np.abs(t - x))])
    return nearest if abs(nearest - x) <= NEAR_mm else x


def _elevate(curve: ForceCurve, k: int) -> _Piece:
    """Write a curve in a higher degree: every knot gains a repeat, and the larger space holds the curve."""
    t, c = curve.knots_mm, curve.control_points_cN
    for degree in range(curve.degree, k):
        knots, repeats = np.unique(t, return_counts=True)
        if np.any(repeats[1:-1] > degree):
            raise ModelError(f"a curve of degree {degree} with a jump cannot be raised to degree {k}")
        raised = np.repeat(knots, repeats + 1)
        sites = bspline.greville(raised, degree + 1)
        values = bspline.evaluate(t, c, degree, sites)
        t, c = raised, np.asarray(np.linalg.solve(bspline.design_matrix(raised, degree + 1, sites), values))
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
    """Return one Bézier piece of degree k with the given position, value and slope at either end."""
    (a, y0, m0), (b, y1, m1) = start, end
    second, penultimate = y0 + (b - a) * m0 / k, y1 - (b - a) * m1 / k
    c = np.concatenate([[y0], np.linspace(second, penultimate, k - 1), [y1]])
    return _Piece(np.repeat([a, b], k + 1), c)


def _concatenate_pieces(pieces: list[_Piece], k: int) -> tuple[FloatArray, FloatArray]:
    """Join pieces of equal value and slope; a control point at a joint follows from its neighbours."""
    t, c = pieces[0]
    for piece in pieces[1:]:
        t = np.concatenate([t[:-2], piece.t[k + 1 :]])
        c = np.concatenate([c[:-1], piece.c[1:]])
    return t, c


_Part = TypeVar("_Part", ForceCurve, Vibration)

_Value = TypeVar("_Value", float, Interpolation)


class Conflict(StrEnum):
    """What merge does with two different curves, or vibrations, of one stroke and velocity."""

    REFUSE = "refuse"
    FIRST = "first"
    LAST = "last"


def merge(
    parts: Iterable[FDVVModel | ForceCurve],
    name: str,
    *,
    conflict: Conflict | str = Conflict.REFUSE,
    travel_mm: float | None = None,
    actuation_mm: float | None = None,
    reset_mm: float | None = None,
    interpolation: Interpolation | str | None = None,
) -> FDVVModel:
    """Merge curves, each with its stroke and velocity, and models into one FDVV model.

    Parameters
    ----------
    parts : models, whose curves and vibrations are all taken, and single curves.
    name : of the merged model.
    conflict : what to do with two different curves or vibrations of one stroke and velocity: refuse them,
        or keep the first or the last; equal ones count once, and the one that knows its spread is kept.
    travel_mm : as given; else what all models say; without models, where all curves end.
    actuation_mm, reset_mm : as given; else what all models that know it say; else unknown.
    interpolation : as given; else what all models say; without models, the default.

    Curves and vibrations keep their spread, and so does a point at the very place where a model measured it.
    The provenance is that of the models, joined; it is simulated if any of them is. Raises ModelError,
    naming both sides, where they differ and no argument decides, and as FDVVModel does.
    """
    parts = list(parts)
    models = [p for p in parts if isinstance(p, FDVVModel)]
    curves = [(_label(p), c) for p in parts for c in (p.curves if isinstance(p, FDVVModel) else (p,))]
    vibrations = [(_label(m), v) for m in models for v in m.vibrations]
    stated_mm = [(_label(m), m.travel_mm) for m in models] or [(who, c.end_mm) for who, c in curves]
    travel_mm = _agree_on("travel_mm", travel_mm, stated_mm)
    if travel_mm is None or not curves:
        raise ModelError("a merge needs at least one curve or model, got none")
    actuation = _agree_on("actuation_mm", actuation_mm, [(_label(m), m.actuation_mm) for m in models])
    reset = _agree_on("reset_mm", reset_mm, [(_label(m), m.reset_mm) for m in models])
    wanted = None if interpolation is None else Interpolation(interpolation)
    method = _agree_on("interpolation", wanted, [(_label(m), m.interpolation) for m in models])
    return FDVVModel(
        name=name,
        travel_mm=travel_mm,
        curves=_resolve_conflicts("curve", curves, Conflict(conflict)),
        actuation_mm=actuation,
        reset_mm=reset,
        vibrations=_resolve_conflicts("vibration", vibrations, Conflict(conflict)),
        interpolation=method or Interpolation.PCHIP,
        provenance=_merge([m.provenance for m in models], "merged from " + ", ".join(map(_label, parts))),
        travel_spread=_common_spread(travel_mm, [(m.travel_mm, m.travel_spread) for m in models]),
        actuation_spread=_common_spread(actuation, [(m.actuation_mm, m.actuation_spread) for m in models]),
        reset_spread=_common_spread(reset, [(m.reset_mm, m.reset_spread) for m in models]),
    )


def assign(
    model: FDVVModel,
    curve: ForceCurve,
    stroke: Stroke | str,
    velocity_mm_s: float | None,
    segment_mm: tuple[float, float] | None = None,
    blend_mm: float = 0.1,
) -> FDVVModel:
    """Assign a curve, or a segment of one, as its press or release at a velocity.

    Parameters
    ----------
    curve : its own stroke and velocity do not matter, so that a press can serve as a release.
    stroke, velocity_mm_s : where it goes; a curve that is there already is replaced.
    segment_mm : (start, end); only there does the curve that is there already follow the new one.
    blend_mm : width beyond either end of the segment over which one cubic leads from the old curve to
        the new, value and slope continuous; outside it the old curve is unchanged.

    A whole curve that goes where it was measured keeps its spread; at another stroke or velocity, or with a
    segment of another curve in it, it was never measured and has none. Travel, points and vibrations stay;
    the provenance gains a note. Raises ModelError if there is no curve to take a segment, if the segment
    leaves either curve, and as FDVVModel does.
    """
    stroke = Stroke(stroke)
    spread = curve.spread if _at(curve, stroke, velocity_mm_s) else None
    placed = replace(curve, stroke=stroke, velocity_mm_s=velocity_mm_s, spread=spread)
    span = ""
    if segment_mm is not None:
        placed = splice(_find_curve(model, stroke, velocity_mm_s), curve, segment_mm, blend_mm)
        span = f" from {segment_mm[0]:g} to {segment_mm[1]:g} mm"
    others = tuple(c for c in model.curves if not _at(c, stroke, velocity_mm_s))
    return _with_note(model, (*others, placed), f"{_label(placed)}{span} assigned from {_label(curve)}")


def copy_curve(
    model: FDVVModel,
    stroke: Stroke | str,
    velocity_mm_s: float | None,
    to_stroke: Stroke | str,
    to_velocity_mm_s: float | None,
) -> FDVVModel:
    """Copy a curve of a model to another stroke or velocity, replacing what is there.

    Raises ModelError if there is no such curve, and as FDVVModel does.
    """
    return assign(model, _find_curve(model, stroke, velocity_mm_s), to_stroke, to_velocity_mm_s)


def remove_curve(model: FDVVModel, stroke: Stroke | str, velocity_mm_s: float | None) -> FDVVModel:
    """Remove a curve of a model; vibrations stay. Raises ModelError if it is not there or the last one."""
    gone = _find_curve(model, stroke, velocity_mm_s)
    if len(model.curves) == 1:
        raise ModelError(f"the {_label(gone)} is the only curve of {model.name!r}; a model needs one")
    return _with_note(model, tuple(c for c in model.curves if c is not gone), f"{_label(gone)} removed")


def _at(part: ForceCurve | Vibration, stroke: Stroke | str, velocity_mm_s: float | None) -> bool:
    return part.stroke is Stroke(stroke) and part.velocity_mm_s == velocity_mm_s


def _find_curve(model: FDVVModel, stroke: Stroke | str, velocity_mm_s: float | None) -> ForceCurve:
    for curve in model.of(stroke):
        if _at(curve, stroke, velocity_mm_s):
            return curve
    wanted = f"{Stroke(stroke)} curve at {_speed(velocity_mm_s)}"
    raise ModelError(f"{model.name!r} has no {wanted}; it has {', '.join(map(_label, model.curves))}")


def _speed(velocity_mm_s: float | None) -> str:
    return "unknown velocity" if velocity_mm_s is None else f"{velocity_mm_s:g} mm/s"


def _label(part: FDVVModel | ForceCurve | Vibration) -> str:
    return part.name if isinstance(part, FDVVModel) else f"{part.stroke} at {_speed(part.velocity_mm_s)}"


def _common_spread(
    point_mm: float | None, stated: Sequence[tuple[float | None, PointSpread | None]]
) -> PointSpread | None:
    """Return the spread of a point from the models with that very value; None if their spreads differ."""
    spreads = {spread for place_mm, spread in stated if spread is not None and place_mm == point_mm}
    return spreads.pop() if len(spreads) == 1 else None


def _agree_on(what: str, given: _Value | None, stated: Sequence[tuple[str, _Value | None]]) -> _Value | None:
    """Return the value given, else the one on which all models that state it agree."""
    if given is not None:
        return given
    known = [(who, value) for who, value in stated if value is not None]
    for who, value in known[1:]:
        if value != known[0][1]:
            sides = f"{known[0][1]} in {known[0][0]!r} and {value} in {who!r}"
            raise ModelError(f"parts differ in {what}: {sides}; pass {what} to decide")
    return known[0][1] if known else None


def _resolve_conflicts(what: str, parts: Sequence[tuple[str, _Part]], rule: Conflict) -> tuple[_Part, ...]:
    """Keep one part for each stroke and velocity, as the rule says."""
    chosen: dict[tuple[Stroke, float | None], tuple[str, _Part]] = {}
    for who, part in parts:
        key = (part.stroke, part.velocity_mm_s)
        earlier, there = chosen.setdefault(key, (who, part))
        alike = replace(there, spread=None) == replace(part, spread=None)
        if alike and (None in (there.spread, part.spread) or there.spread == part.spread):
            chosen[key] = (earlier, there) if there.spread else (who, part)
            continue
        if rule is Conflict.REFUSE:
            sides = f"one from {earlier!r}, one from {who!r}"
            remedy = 'pass conflict="first" or "last" to decide'
            raise ModelError(f"two different {what}s for {_label(part)}, {sides}; {remedy}")
        if rule is Conflict.LAST:
            chosen[key] = (who, part)
    return tuple(part for _, part in chosen.values())


def _merge(provenances: Sequence[Provenance], note: str) -> Provenance:
    def once(statements: Iterable[str]) -> tuple[str, ...]:
        return tuple(dict.fromkeys(s for s in statements if s))

    return Provenance(
        source="; ".join(once(p.source for p in provenances)),
        licence="; ".join(once(p.licence for p in provenances)),
        citation="; ".join(once(p.citation for p in provenances)),
        method="; ".join((*once(p.method for p in provenances), note)),
        assumptions=once(a for p in provenances for a in p.assumptions),
        simulated=any(p.simulated for p in provenances),
    )


def _with_note(model: FDVVModel, curves: tuple[ForceCurve, ...], note: str) -> FDVVModel:
    return replace(model, curves=curves, provenance=_merge([model.provenance], note))

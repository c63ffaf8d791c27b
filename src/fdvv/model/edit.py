"""Edit models as values: merge, assign a curve or a piece of one, copy, remove; nothing changes in place."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from enum import StrEnum
from typing import TypeVar

from fdvv.errors import ModelError
from fdvv.model._curve import ForceCurve, Stroke
from fdvv.model._model import FDVVModel, Provenance
from fdvv.model._splice import splice
from fdvv.model._spread import PointSpread
from fdvv.model._velocity import Interpolation
from fdvv.model._vibration import Vibration

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
    travel_mm = _decided("travel_mm", travel_mm, stated_mm)
    if travel_mm is None or not curves:
        raise ModelError("a merge needs at least one curve or model, got none")
    actuation = _decided("actuation_mm", actuation_mm, [(_label(m), m.actuation_mm) for m in models])
    reset = _decided("reset_mm", reset_mm, [(_label(m), m.reset_mm) for m in models])
    wanted = None if interpolation is None else Interpolation(interpolation)
    method = _decided("interpolation", wanted, [(_label(m), m.interpolation) for m in models])
    return FDVVModel(
        name=name,
        travel_mm=travel_mm,
        curves=_settled("curve", curves, Conflict(conflict), _same_curve),
        actuation_mm=actuation,
        reset_mm=reset,
        vibrations=_settled("vibration", vibrations, Conflict(conflict), _same_vibration),
        interpolation=method or Interpolation.PCHIP,
        provenance=_joined([m.provenance for m in models], "merged from " + ", ".join(map(_label, parts))),
        travel_spread=_told(travel_mm, [(m.travel_mm, m.travel_spread) for m in models]),
        actuation_spread=_told(actuation, [(m.actuation_mm, m.actuation_spread) for m in models]),
        reset_spread=_told(reset, [(m.reset_mm, m.reset_spread) for m in models]),
    )


def assign(
    model: FDVVModel,
    curve: ForceCurve,
    stroke: Stroke | str,
    velocity_mm_s: float | None,
    segment_mm: tuple[float, float] | None = None,
    blend_mm: float = 0.1,
) -> FDVVModel:
    """Give a model a curve, or a segment of one, as its press or release at a velocity.

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
        placed = splice(_found(model, stroke, velocity_mm_s), curve, segment_mm, blend_mm)
        span = f" from {segment_mm[0]:g} to {segment_mm[1]:g} mm"
    others = tuple(c for c in model.curves if not _at(c, stroke, velocity_mm_s))
    return _noted(model, (*others, placed), f"{_label(placed)}{span} assigned from {_label(curve)}")


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
    return assign(model, _found(model, stroke, velocity_mm_s), to_stroke, to_velocity_mm_s)


def remove_curve(model: FDVVModel, stroke: Stroke | str, velocity_mm_s: float | None) -> FDVVModel:
    """Remove a curve of a model; vibrations stay. Raises ModelError if it is not there or the last one."""
    gone = _found(model, stroke, velocity_mm_s)
    if len(model.curves) == 1:
        raise ModelError(f"the {_label(gone)} is the only curve of {model.name!r}; a model needs one")
    return _noted(model, tuple(c for c in model.curves if c is not gone), f"{_label(gone)} removed")


def _at(part: ForceCurve | Vibration, stroke: Stroke | str, velocity_mm_s: float | None) -> bool:
    return part.stroke is Stroke(stroke) and part.velocity_mm_s == velocity_mm_s


def _found(model: FDVVModel, stroke: Stroke | str, velocity_mm_s: float | None) -> ForceCurve:
    """Find a curve, or refuse with the list of those there are."""
    for curve in model.of(stroke):
        if _at(curve, stroke, velocity_mm_s):
            return curve
    wanted = f"{Stroke(stroke)} curve at {_speed(velocity_mm_s)}"
    raise ModelError(f"{model.name!r} has no {wanted}; it has {', '.join(map(_label, model.curves))}")


def _speed(velocity_mm_s: float | None) -> str:
    return "unknown velocity" if velocity_mm_s is None else f"{velocity_mm_s:g} mm/s"


def _label(part: FDVVModel | ForceCurve | Vibration) -> str:
    """Name a part for a person: a model by its name, others by stroke and velocity."""
    return part.name if isinstance(part, FDVVModel) else f"{part.stroke} at {_speed(part.velocity_mm_s)}"


def _same_curve(a: ForceCurve, b: ForceCurve) -> bool:
    def numbers(c: ForceCurve) -> tuple[int, bytes, bytes]:
        return c.degree, c.knots_mm.tobytes(), c.control_points_cN.tobytes()

    return numbers(a) == numbers(b)


def _same_vibration(a: Vibration, b: Vibration) -> bool:
    return replace(a, spread=None) == replace(b, spread=None)


def _told(
    point_mm: float | None, stated: Sequence[tuple[float | None, PointSpread | None]]
) -> PointSpread | None:
    """Give the spread of a point from those who state it at that very place; None if they differ in it."""
    found = {spread for place_mm, spread in stated if spread is not None and place_mm == point_mm}
    return found.pop() if len(found) == 1 else None


def _decided(what: str, given: _Value | None, stated: Sequence[tuple[str, _Value | None]]) -> _Value | None:
    """Take what is given, else the one value that everyone who knows it states."""
    if given is not None:
        return given
    known = [(who, value) for who, value in stated if value is not None]
    for who, value in known[1:]:
        if value != known[0][1]:
            sides = f"{known[0][1]} in {known[0][0]!r} and {value} in {who!r}"
            raise ModelError(f"parts differ in {what}: {sides}; pass {what} to decide")
    return known[0][1] if known else None


def _settled(
    what: str,
    parts: Sequence[tuple[str, _Part]],
    rule: Conflict,
    same: Callable[[_Part, _Part], bool],
) -> tuple[_Part, ...]:
    """Keep one part per stroke and velocity, by the rule where two differ."""
    kept: dict[tuple[Stroke, float | None], tuple[str, _Part]] = {}
    for who, part in parts:
        key = (part.stroke, part.velocity_mm_s)
        earlier, there = kept.setdefault(key, (who, part))
        if same(there, part) and None in (there.spread, part.spread):
            kept[key] = (earlier, there) if there.spread else (who, part)
            continue
        if same(there, part) and there.spread == part.spread:
            continue
        if rule is Conflict.REFUSE:
            sides = f"one from {earlier!r}, one from {who!r}"
            remedy = 'pass conflict="first" or "last" to decide'
            raise ModelError(f"two different {what}s for {_label(part)}, {sides}; {remedy}")
        if rule is Conflict.LAST:
            kept[key] = (who, part)
    return tuple(part for _, part in kept.values())


def _joined(provenances: Sequence[Provenance], note: str) -> Provenance:
    """Join provenances, each statement once, and add a note to the method."""

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


def _noted(model: FDVVModel, curves: tuple[ForceCurve, ...], note: str) -> FDVVModel:
    return replace(model, curves=curves, provenance=_joined([model.provenance], note))

"""The smallest difference between two models: what a page sends and a journal keeps.

A patch holds both sides of every change, so that it can be inverted by itself and refuses a model that it
was not made of. `web/src/model/patch.ts` does the same; both are checked against one set of cases. Models are
plain records here, as ``json.loads`` gives a model file.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Annotated, Any, Literal, TypeAlias, get_args

import msgspec
from msgspec import Meta

from fdvv.errors import InputError, ModelError
from fdvv.model.curve import Stroke
from fdvv.model.file import model_from_json, model_to_json
from fdvv.model.model import FDVVModel

Record: TypeAlias = dict[str, Any]
OfModel = Literal["name", "travel_mm", "actuation_mm", "reset_mm", "interpolation"]
OfSpread = Literal["travel_spread", "actuation_spread", "reset_spread"]
OfProvenance = Literal["source", "licence", "citation", "method", "assumptions", "simulated"]
Field = Literal[OfModel, OfSpread, OfProvenance]


class _Change(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """A part that came (after), went (before) or is another (both), without its stroke and velocity."""

    stroke: Stroke
    velocity_mm_s: float | None
    before: dict[str, Any] | None = None
    after: dict[str, Any] | None = None


class CurveChange(_Change, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """A curve that came, went, is another, or has control points at other forces.

    points : index, force before and force after; instead of before and after.
    """

    points: list[tuple[Annotated[int, Meta(ge=0)], float, float]] | None = None


class VibrationChange(_Change, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """A vibration that came, went or is another."""


class Patch(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """A difference between two models. fields : of the model or its provenance, before and after."""

    fields: dict[Field, tuple[Any, Any]] = {}
    curves: list[CurveChange] = []
    vibrations: list[VibrationChange] = []


def record_of(model: FDVVModel) -> Record:
    """Return a model as a plain record: what its file holds, vibrations in reading order too."""
    record: Record = json.loads(model_to_json(model))
    return canonical(record)


def model_of(record: Record, source: object) -> FDVVModel:
    """Return a record's model. Raises InputError that names source and the place."""
    try:
        text = json.dumps(record, allow_nan=False)
    except (RecursionError, ValueError) as error:
        raise InputError(source, "$", f"not JSON ({error})", "send a model") from error
    return model_from_json(text, source)


def canonical(record: Record) -> Record:
    """Copy a record in its one form: parts in reading order, no field for a spread that is not known."""
    made = _without_empty(record, *get_args(OfSpread))
    for name in ("curves", "vibrations"):
        parts = [_without_empty(part, "spread") for part in made.get(name, ())]
        made[name] = sorted(parts, key=_order)
    spreads = any("spread" in part for part in (*made["curves"], *made["vibrations"]))
    made["version"] = 2 if spreads or any(name.endswith("_spread") for name in made) else 1
    return made


def _without_empty(record: Mapping[str, Any], *names: str) -> Record:
    return {name: value for name, value in record.items() if name not in names or value is not None}


def _order(part: Mapping[str, Any]) -> tuple[bool, float]:
    return part["stroke"] != Stroke.PRESS, part["velocity_mm_s"] or 0.0


def same(a: Any, b: Any) -> bool:
    """Return whether two values hold the same numbers, texts and fields; an absent field counts as null."""
    if isinstance(a, Mapping) and isinstance(b, Mapping):
        return all(same(a.get(name), b.get(name)) for name in {*a, *b})
    if isinstance(a, list | tuple) and isinstance(b, list | tuple):
        return len(a) == len(b) and all(map(same, a, b))
    # True equals 1 in Python, but not in a file
    return isinstance(a, bool) == isinstance(b, bool) and bool(a == b)


def patch_between(a: Record, b: Record) -> Patch:
    """Find the patch that leads from one model to another."""
    fields = {
        **_fields(a, b, get_args(OfModel) + get_args(OfSpread)),
        **_fields(a["provenance"], b["provenance"], get_args(OfProvenance)),
    }
    curves = [CurveChange(**change) for change in _changes(a["curves"], b["curves"], _points)]
    vibrations = [VibrationChange(**change) for change in _changes(a["vibrations"], b["vibrations"])]
    return Patch(fields, curves, vibrations)


def _fields(a: Record, b: Record, names: Iterable[Any]) -> dict[Field, tuple[Any, Any]]:
    return {name: (a.get(name), b.get(name)) for name in names if not same(a.get(name), b.get(name))}


def _changes(a: Sequence[Record], b: Sequence[Record], finer: Any = None) -> Iterable[Record]:
    old, new = {_key(part): part for part in a}, {_key(part): part for part in b}
    for key in {**old, **new}:
        before, after = old.get(key), new.get(key)
        if same(before, after):
            continue
        at = {"stroke": Stroke(key[0]), "velocity_mm_s": key[1]}
        fine = finer(before, after) if finer and before and after else None
        shapes = {"before": _shape(before), "after": _shape(after)}
        yield {**at, **(fine or shapes)}


def _key(part: Mapping[str, Any]) -> tuple[str, float | None]:
    return part["stroke"], part["velocity_mm_s"]


def _shape(part: Record | None) -> Record | None:
    return part and {name: v for name, v in part.items() if name not in ("stroke", "velocity_mm_s")}


def _points(before: Record, after: Record) -> Record | None:
    """Return the control points that differ, or None if anything else differs."""
    if not all(same(before.get(name), after.get(name)) for name in ("degree", "knots_mm", "spread")):
        return None
    pairs = enumerate(zip(before["control_points_cN"], after["control_points_cN"], strict=True))
    return {"points": [(i, was, now) for i, (was, now) in pairs if was != now]}


def inverse_patch(patch: Patch) -> Patch:
    fields = {name: (b, a) for name, (a, b) in patch.fields.items()}
    return Patch(fields, [_invert(c) for c in patch.curves], [_invert(v) for v in patch.vibrations])


def _invert(change: Any) -> Any:
    swapped = {"before": change.after, "after": change.before}
    if isinstance(change, CurveChange) and change.points is not None:
        swapped["points"] = [(i, b, a) for i, a, b in change.points]
    return msgspec.structs.replace(change, **swapped)


def apply_patch(record: Record, patch: Patch) -> Record:
    """Apply a patch to the model it was made of; numbers are not judged. ModelError on another model."""
    made = {**record, "provenance": dict(record["provenance"])}
    for name, (before, after) in patch.fields.items():
        holder = made["provenance"] if name in get_args(OfProvenance) else made
        _expect(holder.get(name), before, name)
        holder[name] = after
    for curve in patch.curves:
        made["curves"] = _apply_change(made["curves"], curve)
    for vibration in patch.vibrations:
        made["vibrations"] = _apply_change(made["vibrations"], vibration)
    return canonical(made)


def _expect(there: Any, before: Any, what: str) -> None:
    if not same(there, before):
        raise ModelError(f"the edit does not fit the model: its {what} is another")


def _apply_change(parts: Sequence[Record], change: CurveChange | VibrationChange) -> list[Record]:
    key = (str(change.stroke), change.velocity_mm_s)
    there = next((part for part in parts if _key(part) == key), None)
    rest = [part for part in parts if part is not there]
    place = {"stroke": key[0], "velocity_mm_s": key[1]}
    if isinstance(change, CurveChange) and change.points is not None:
        return [*rest, {**(there or place), "control_points_cN": _move_points(there, change)}]
    _expect(_shape(there), change.before, _label(change))
    return [*rest, {**change.after, **place}] if change.after is not None else rest


def _move_points(curve: Record | None, change: CurveChange) -> list[float]:
    points = list(curve["control_points_cN"]) if curve else []
    for i, before, after in change.points or ():
        _expect(points[i] if i < len(points) else None, before, f"control point {i} of {_label(change)}")
        points[i] = after
    return points


def _label(change: CurveChange | VibrationChange) -> str:
    velocity = change.velocity_mm_s
    return f"{change.stroke} at {'unknown velocity' if velocity is None else f'{velocity:g} mm/s'}"

"""Parts of buttons named on a command line: FILE[:press|:release][@VELOCITY]."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from fdvv.errors import InputError
from fdvv.model import Conflict, FDVVModel, ForceCurve, Stroke, merge
from fdvv.workflow._open import open_model

PART = re.compile(r"(?P<file>.+?)(?::(?P<stroke>press|release))?(?:@(?P<velocity>[0-9.eE+-]+))?")


def open_part(spec: str) -> FDVVModel:
    """Open a part: a button, cut to one stroke if asked, its curves declared to be of a velocity if asked.

    Raises InputError, also where a velocity is given to several curves of one stroke.
    """
    if Path(spec).is_file():
        # a file that is there under the whole name is meant, however its name reads
        return open_model(spec)
    found = PART.fullmatch(spec)
    if found is None:
        raise InputError(
            spec or "''", "argument", "is not FILE[:press|:release][@VELOCITY]", "write it that way"
        )
    model = open_model(found["file"])
    curves = model.of(found["stroke"]) if found["stroke"] else model.curves
    if not curves:
        raise InputError(
            spec, "argument", f"the button has no {found['stroke']} curve", "name the other stroke"
        )
    if found["velocity"]:
        curves = _declared(curves, _velocity(spec, found["velocity"]), spec)
    strokes = {curve.stroke for curve in curves}
    vibrations = tuple(v for v in model.vibrations if v.stroke in strokes)
    return replace(model, curves=curves, vibrations=vibrations)


def _velocity(spec: str, text: str) -> float:
    try:
        velocity_mm_s = float(text)
    except ValueError:
        velocity_mm_s = 0.0
    if not 0 < velocity_mm_s < float("inf"):
        raise InputError(spec, "velocity", f"{text!r} is not a speed above 0 mm/s", "write e.g. @50")
    return velocity_mm_s


def _declared(curves: tuple[ForceCurve, ...], velocity_mm_s: float, spec: str) -> tuple[ForceCurve, ...]:
    for stroke in Stroke:
        count = sum(c.stroke is stroke for c in curves)
        if count > 1:
            reason = f"the button has {count} {stroke} curves, one velocity cannot serve them"
            raise InputError(spec, "velocity", reason, "leave out the velocity or name a button of one curve")
    return tuple(_at(c, velocity_mm_s) for c in curves)


def _at(curve: ForceCurve, velocity_mm_s: float) -> ForceCurve:
    """Declare a velocity; a curve that was measured at another one is no longer the measured one."""
    measured = curve.velocity_mm_s in (None, velocity_mm_s)
    return replace(curve, velocity_mm_s=velocity_mm_s, spread=curve.spread if measured else None)


def merge_parts(
    specs: Sequence[str],
    name: str,
    travel_mm: float | None = None,
    actuation_mm: float | None = None,
    reset_mm: float | None = None,
    conflict: Conflict | str = Conflict.REFUSE,
) -> FDVVModel:
    """Merge parts into one FDVV model; where they differ in a point, it must be given.

    conflict : what becomes of two different curves of one stroke and velocity.
    Raises InputError, ModelError.
    """
    parts = [open_part(spec) for spec in specs]
    _check_velocities(specs, parts)
    return merge(
        parts, name, conflict=conflict, travel_mm=travel_mm, actuation_mm=actuation_mm, reset_mm=reset_mm
    )


def _check_velocities(specs: Sequence[str], parts: Sequence[FDVVModel]) -> None:
    """Refuse a curve of unknown velocity beside others of its stroke, naming the part that brings it."""
    for stroke in Stroke:
        curves = [(spec, curve) for spec, part in zip(specs, parts, strict=True) for curve in part.of(stroke)]
        unknown = [spec for spec, curve in curves if curve.velocity_mm_s is None]
        if unknown and len(unknown) < len(curves):
            reason = f"its {stroke} is of unknown velocity, but other parts have a {stroke} too"
            raise InputError(unknown[0], "velocity", reason, f"tell it: {unknown[0]}@VELOCITY in mm/s")


def one_curve(spec: str) -> ForceCurve:
    """Open a part that is a single curve. Raises InputError if it is more."""
    curves = open_part(spec).curves
    if len(curves) != 1:
        told = ", ".join(f"{c.stroke} at {c.velocity_mm_s or 'unknown'} mm/s" for c in curves)
        raise InputError(
            spec, "argument", f"holds {len(curves)} curves ({told}), one is needed", "add :press or :release"
        )
    return curves[0]

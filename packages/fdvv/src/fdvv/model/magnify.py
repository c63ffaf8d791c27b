"""A button with more, or less, of what it has: force, snap, vibration."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fdvv.errors import ModelError
from fdvv.model import bspline
from fdvv.model.bump import find_bump
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.landmarks import dense
from fdvv.model.model import FDVVModel
from fdvv.units import FloatArray

CHECKED = 500
"""Places between which a valley is looked for."""


def magnify(
    model: FDVVModel, force_ratio: float = 1.0, snap_ratio: float = 1.0, vibration_ratio: float = 1.0
) -> FDVVModel:
    """Multiply all forces of a model, the fall of force of its snap, and its vibrations; 1 changes nothing.

    What was measured of spread is left out of what changes. A snap grows about the middle between peak and
    valley: between the two places where the force crosses it, the distance from it is multiplied, so that the
    peak rises as much as the valley falls, and the force elsewhere stays. It grows before the forces do.
    A button cannot pull: the valley of a release stays at no force where it would.

    ModelError where there is no snap or vibration to multiply, or the valley of a press would pull.
    """
    if snap_ratio != 1.0:
        model = replace(model, curves=_with_snap(model, snap_ratio))
    if force_ratio != 1.0:
        curves = (
            replace(curve, control_points_cN=force_ratio * curve.control_points_cN, spread=None)
            for curve in model.curves
        )
        model = replace(model, curves=tuple(curves))
    if vibration_ratio == 1.0:
        return model
    if not model.vibrations:
        raise ModelError(f"{model.name} has no vibration to make stronger")
    vibrations = (
        replace(
            curve,
            modes=tuple(replace(m, amplitude_m_s2=vibration_ratio * m.amplitude_m_s2) for m in curve.modes),
            spread=None,
        )
        for curve in model.vibrations
    )
    return replace(model, vibrations=tuple(vibrations))


def has_snap(model: FDVVModel) -> bool:
    """Return whether the force of every press falls by a bump."""
    presses = model.of(Stroke.PRESS)
    return bool(presses) and all(_bump_of(curve, model.travel_mm) is not None for curve in presses)


def _with_snap(model: FDVVModel, ratio: float) -> tuple[ForceCurve, ...]:
    if not has_snap(model):
        raise ModelError(f"{model.name} has no snap to make stronger")
    return tuple(_curve_with_snap(curve, model, ratio) for curve in model.curves)


def _curve_with_snap(curve: ForceCurve, model: FDVVModel, ratio: float) -> ForceCurve:
    """Multiply the snap of a curve; one without a bump, as of a release that is even, stays."""
    bump = _bump_of(curve, model.travel_mm)
    if bump is None:
        return curve
    middle_cN, ends_mm = bump
    t, c = _with_joints(curve, ends_mm)
    place = bspline.greville(t, curve.degree)
    inside = (place >= ends_mm[0]) & (place <= ends_mm[1])
    more = middle_cN + ratio * (c - middle_cN)
    snapped = replace(curve, knots_mm=t, control_points_cN=np.where(inside, more, c), spread=None)
    x = np.linspace(*ends_mm, CHECKED)
    if snapped.force_cN(x).min() >= min(0.0, float(curve.force_cN(x).min())):
        return snapped
    if curve.stroke is Stroke.PRESS:
        raise ModelError(f"the snap of {model.name} times {ratio:g} would pull at the finger")
    # no control point below zero: no force below zero between them
    c = np.where(inside & (c >= 0.0), np.maximum(more, 0.0), c)
    return replace(curve, knots_mm=t, control_points_cN=c, spread=None)


def _bump_of(curve: ForceCurve, travel_mm: float) -> tuple[float, tuple[float, float]] | None:
    """Return the force midway between peak and valley, and the places around both where it is crossed."""
    x = dense(curve, travel_mm)
    force = curve.force_cN(x)
    bump = find_bump(x, force)
    if bump is None:
        return None
    peak, valley = np.searchsorted(x, (bump.peak_mm, bump.valley_mm))
    middle = 0.5 * float(curve.force_cN(bump.peak_mm) + curve.force_cN(bump.valley_mm))
    before, after = np.flatnonzero(force[:peak] <= middle), np.flatnonzero(force[valley:] >= middle)
    first = _crossing(x, force, middle, int(before[-1])) if before.size else float(x[0])
    last = _crossing(x, force, middle, valley + int(after[0]) - 1) if after.size else float(x[-1])
    return middle, (first, last)


def _crossing(x: FloatArray, force: FloatArray, middle: float, at: int) -> float:
    """Return where the line between a sample and the next one has the middle force."""
    return float(np.interp(middle, force[at : at + 2], x[at : at + 2]))


def _with_joints(curve: ForceCurve, at_mm: tuple[float, float]) -> tuple[FloatArray, FloatArray]:
    """Return knots and control points of the same curve, which may have a corner at each of two places."""
    from scipy.interpolate import BSpline

    spline, k = BSpline(curve.knots_mm, curve.control_points_cN, curve.degree), curve.degree
    for place in at_mm:
        missing = k - int(np.count_nonzero(spline.t == place))
        if missing > 0 and curve.start_mm < place < curve.end_mm:
            spline = spline.insert_knot(place, missing)
    return spline.t, np.asarray(spline.c[: spline.t.size - k - 1])

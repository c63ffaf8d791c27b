"""The points and figures that people compare buttons by."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.model.bump import Bump, CONTACT_cN, STOP_LEAST_cN_mm, find_bump
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.model import FDVVModel
from fdvv.model.spread import PointSpread
from fdvv.units import FloatArray

STEP_mm = 0.005
"""Landmarks are read off the spline at this step, that of the finest benches."""

CONTACT_REACH_mm = 0.4
"""A contact step ends within this of contact; what is steep beyond it is the button's own."""

CUT_SHORT_mm = 0.1
"""A release that ends this far from contact, while the button still pushes, was not recorded to its end."""

mJ_PER_cN_mm = 0.01
"""1 cN mm = 10 mN x 1 mm = 0.01 mJ."""


@dataclass(frozen=True)
class Landmarks:
    """Landmarks of a button at one velocity; None where the button has no such point or it is unknown.

    Attributes
    ----------
    velocity_mm_s : of the press curve they are read from.
    contact_mm : where the press curve begins.
    preload_cN : force at the end of the contact step, the last place within 0.4 mm of contact that is
        steeper than a stop (100 cN/mm); the first force if there is no such step, as on a rubber dome.
    peak_mm, peak_cN, valley_mm, valley_cN : of the bump of the press.
    snap_ratio : (peak - valley) / peak.
    release_peak_cN, release_valley_cN : of the bump of the release.
    actuation_mm, actuation_cN, reset_mm : where the contact closes, the press force there, where it opens.
    bottom_out_mm, bottom_out_cN : where the stop takes over and the force there.
    travel_mm : from contact to bottom-out.
    pre_travel_mm, post_travel_mm : from contact to actuation, from actuation to bottom-out.
    pre_slope_cN_mm : mean slope from the end of the contact step to the peak (to bottom-out if no bump).
    post_slope_cN_mm : mean slope over the last quarter of the travel: the spring rate.
    steepest_fall_cN_mm : most negative slope of the press after the contact step, the sharpness of the snap.
    work_mJ, release_work_mJ : area under each stroke over the travel; None of a release that is cut short.
    hysteresis_loss_mJ : work put in and not given back.
    """

    velocity_mm_s: float | None
    contact_mm: float
    preload_cN: float
    peak_mm: float | None
    peak_cN: float | None
    valley_mm: float | None
    valley_cN: float | None
    snap_ratio: float | None
    release_peak_cN: float | None
    release_valley_cN: float | None
    actuation_mm: float | None
    actuation_cN: float | None
    reset_mm: float | None
    bottom_out_mm: float
    bottom_out_cN: float
    travel_mm: float
    pre_travel_mm: float | None
    post_travel_mm: float | None
    pre_slope_cN_mm: float
    post_slope_cN_mm: float
    steepest_fall_cN_mm: float
    work_mJ: float
    release_work_mJ: float | None
    hysteresis_loss_mJ: float | None

    def to_dict(self) -> dict[str, float | None]:
        return asdict(self)


def _contact_step_end(x: FloatArray, slope: FloatArray) -> int:
    """Return the index of the end of the contact step; 0 if the curve has none."""
    near = slope[: max(2, int(np.searchsorted(x, x[0] + CONTACT_REACH_mm)))]
    steep = np.flatnonzero(near > STOP_LEAST_cN_mm)
    return min(int(steep[-1]) + 1, x.size - 2) if steep.size else 0


def _work_mJ(x: FloatArray, force_cN: FloatArray) -> float:
    return float(np.trapezoid(force_cN, x)) * mJ_PER_cN_mm


def dense(curve: ForceCurve, end_mm: float) -> FloatArray:
    """Return the displacements that landmarks are read at, to the end of the curve or of the travel."""
    end_mm = max(end_mm, curve.start_mm + STEP_mm)
    count = max(8, round((end_mm - curve.start_mm) / STEP_mm) + 1)
    return np.linspace(curve.start_mm, end_mm, count)


def is_cut_short(release: ForceCurve, contact_mm: float) -> bool:
    """Whether a release ends more than 0.1 mm below contact with a force on the button, more than 2 cN."""
    start = release.start_mm
    return start - contact_mm > CUT_SHORT_mm and float(release.force_cN(start)) > CONTACT_cN


def landmarks(model: FDVVModel, velocity_mm_s: float | None = None) -> Landmarks:
    """Read the landmarks of a model from its press curve nearest to a velocity (the slowest by default).

    The release, where there is one, is the curve nearest to the same velocity. Raises ModelError if the
    model has no press curve.
    """
    press = model.nearest(Stroke.PRESS, velocity_mm_s)
    if press is None:
        raise ModelError(f"model {model.name!r} has no press curve to read landmarks from")
    release = model.nearest(Stroke.RELEASE, velocity_mm_s)
    x = dense(press, model.travel_mm)
    force, slope = press.force_cN(x), press.stiffness_cN_mm(x)
    bump = find_bump(x, force)
    step_end = _contact_step_end(x, slope)
    pre_end = int(np.searchsorted(x, bump.peak_mm)) if bump else x.size - 1
    pre_end = max(pre_end, step_end + 1)
    work = _work_mJ(x, force)
    release_bump = release_work = None
    if release is not None:
        xr = dense(release, model.travel_mm)
        given_cN = release.force_cN(xr)
        release_bump = find_bump(xr, given_cN)
        release_work = None if is_cut_short(release, press.start_mm) else _work_mJ(xr, given_cN)
    last = x >= x[-1] - 0.25 * (x[-1] - x[0])
    close = model.actuation_mm
    return Landmarks(
        velocity_mm_s=press.velocity_mm_s,
        contact_mm=press.start_mm,
        preload_cN=float(force[step_end]),
        **(vars(bump) if bump else dict.fromkeys(("peak_mm", "peak_cN", "valley_mm", "valley_cN"))),
        snap_ratio=bump.snap_ratio if bump else None,
        release_peak_cN=release_bump.peak_cN if release_bump else None,
        release_valley_cN=release_bump.valley_cN if release_bump else None,
        actuation_mm=close,
        actuation_cN=None if close is None else float(press.force_cN(close)),
        reset_mm=model.reset_mm,
        bottom_out_mm=model.travel_mm,
        bottom_out_cN=float(force[-1]),
        travel_mm=model.travel_mm - press.start_mm,
        pre_travel_mm=None if close is None else close - press.start_mm,
        post_travel_mm=None if close is None else model.travel_mm - close,
        pre_slope_cN_mm=float((force[pre_end] - force[step_end]) / (x[pre_end] - x[step_end])),
        post_slope_cN_mm=float(np.polyfit(x[last], force[last], 1)[0]),
        steepest_fall_cN_mm=min(0.0, float(slope[step_end:].min())),
        work_mJ=work,
        release_work_mJ=release_work,
        hysteresis_loss_mJ=None if release_work is None else work - release_work,
    )


@dataclass(frozen=True)
class LandmarkError:
    """Standard error of one landmark, in the landmark's own unit, and of how many presses."""

    error: float
    presses: int


def landmark_errors(model: FDVVModel, velocity_mm_s: float | None = None) -> dict[str, LandmarkError]:
    """Return the standard errors of the landmarks at a velocity, by the names of Landmarks.

    Included are forces at positions the curve itself sets (there a shift of it costs no force: peaks,
    valleys, the ends) and positions measured on each press (actuation, reset, travel). A ratio, a
    slope or an area takes how presses differ at several places together, which a model does not keep; what
    is not known is left out, as is everything of a model that was not measured on presses.

    Raises ModelError as landmarks does.
    """
    marks = landmarks(model, velocity_mm_s)
    press, release = (model.nearest(stroke, velocity_mm_s) for stroke in Stroke)
    back = _bump(release, marks.bottom_out_mm)
    errors = {
        "peak_cN": _force(press, marks.peak_mm),
        "valley_cN": _force(press, marks.valley_mm),
        "bottom_out_cN": _force(press, marks.bottom_out_mm),
        "release_peak_cN": _force(release, back.peak_mm if back else None),
        "release_valley_cN": _force(release, back.valley_mm if back else None),
        "actuation_mm": _place(model.actuation_spread),
        "pre_travel_mm": _place(model.actuation_spread) if marks.pre_travel_mm is not None else None,
        "reset_mm": _place(model.reset_spread),
        "bottom_out_mm": _place(model.travel_spread),
        "travel_mm": _place(model.travel_spread),
    }
    return {name: error for name, error in errors.items() if error is not None}


def _bump(curve: ForceCurve | None, end_mm: float) -> Bump | None:
    if curve is None:
        return None
    x = dense(curve, end_mm)
    return find_bump(x, curve.force_cN(x))


def _force(curve: ForceCurve | None, place_mm: float | None) -> LandmarkError | None:
    """Return the error of a force; beyond its end a curve holds its last value, and so its error."""
    if curve is None or curve.spread is None or place_mm is None:
        return None
    error_cN = float(curve.spread.error_cN(min(place_mm, curve.end_mm)))
    return LandmarkError(error_cN, curve.spread.presses) if np.isfinite(error_cN) else None


def _place(spread: PointSpread | None) -> LandmarkError | None:
    return None if spread is None else LandmarkError(spread.error_mm, spread.presses)

"""How well the landmarks of a measured button are known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.model._bump import find_bump
from fdvv.model._curve import ForceCurve, Stroke
from fdvv.model._landmarks import Landmarks, dense, landmarks
from fdvv.model._model import FDVVModel
from fdvv.model._spread import PointSpread


@dataclass(frozen=True)
class LandmarkError:
    """Standard error of one landmark, in the landmark's own unit, and of how many presses."""

    error: float
    presses: int


def landmark_errors(model: FDVVModel, velocity_mm_s: float | None = None) -> dict[str, LandmarkError]:
    """Tell the standard errors of the landmarks at a velocity, by the names of Landmarks.

    Told are forces at places that the curve itself sets (there a shift of the place costs no force: peaks,
    valleys, the ends) and places that each press told on its own (actuation, reset, travel). A ratio, a
    slope or an area takes how presses differ at several places together, which a model does not keep; what
    cannot be told is left out, as is everything of a model that was not measured on presses.

    Raises ModelError as landmarks does.
    """
    marks = landmarks(model, velocity_mm_s)
    press, release = (model.nearest(stroke, velocity_mm_s) for stroke in Stroke)
    found = {
        "peak_cN": _force(press, marks.peak_mm),
        "valley_cN": _force(press, marks.valley_mm),
        "bottom_out_cN": _force(press, marks.bottom_out_mm),
        **_of_release(release, marks),
        "actuation_mm": _place(model.actuation_spread),
        "pre_travel_mm": _place(model.actuation_spread) if marks.pre_travel_mm is not None else None,
        "reset_mm": _place(model.reset_spread),
        "bottom_out_mm": _place(model.travel_spread),
        "travel_mm": _place(model.travel_spread),
    }
    return {name: error for name, error in found.items() if error is not None}


def _of_release(release: ForceCurve | None, marks: Landmarks) -> dict[str, LandmarkError | None]:
    """Tell the errors of the bump of the release, found as landmarks finds it."""
    if release is None:
        return {}
    x = dense(release, marks.bottom_out_mm)
    bump = find_bump(x, release.force_cN(x))
    return {
        "release_peak_cN": _force(release, bump.peak_mm if bump else None),
        "release_valley_cN": _force(release, bump.valley_mm if bump else None),
    }


def _force(curve: ForceCurve | None, place_mm: float | None) -> LandmarkError | None:
    """Tell the error of a force; beyond its end a curve holds its last value, and so its error."""
    if curve is None or curve.spread is None or place_mm is None:
        return None
    error_cN = float(curve.spread.error_cN(min(place_mm, curve.end_mm)))
    return LandmarkError(error_cN, curve.spread.presses) if np.isfinite(error_cN) else None


def _place(spread: PointSpread | None) -> LandmarkError | None:
    return None if spread is None else LandmarkError(spread.error_mm, spread.presses)

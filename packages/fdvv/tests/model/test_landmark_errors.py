from dataclasses import replace

import numpy as np
import pytest

from fdvv.model.curve import ForceCurve, MeasuredCurve, Stroke
from fdvv.model.file import load_builtin
from fdvv.model.fit import fit_curve
from fdvv.model.landmarks import LandmarkError, landmark_errors, landmarks
from fdvv.model.model import FDVVModel
from fdvv.model.spread import CurveSpread, PointSpread

CLEAR = load_builtin("mx-clear")
RISING = CurveSpread(np.array([0.0, 4.0]), np.array([0.0, 8.0]), 16)
"""A spread of 2 cN for every mm, of 16 presses: a standard error of 0.5 cN for every mm."""


def measured() -> FDVVModel:
    return replace(CLEAR, curves=tuple(replace(c, spread=RISING) for c in CLEAR.curves))


def test_a_button_that_was_not_measured_on_presses_has_no_errors() -> None:
    assert landmark_errors(CLEAR) == {}


def test_the_error_of_a_force_is_that_at_its_place() -> None:
    marks, errors = landmarks(CLEAR, 100.0), landmark_errors(measured(), 100.0)
    assert marks.peak_mm is not None
    assert marks.valley_mm is not None
    assert errors["peak_cN"].error == pytest.approx(0.5 * marks.peak_mm)
    assert errors["valley_cN"].error == pytest.approx(0.5 * marks.valley_mm)
    assert errors["bottom_out_cN"].error == pytest.approx(0.5 * marks.bottom_out_mm)
    assert errors["peak_cN"].presses == 16
    assert errors["release_valley_cN"].error > 0


def test_places_have_the_errors_of_their_own_presses() -> None:
    errors = landmark_errors(
        replace(CLEAR, actuation_spread=PointSpread(0.06, 9), travel_spread=PointSpread(0.04, 16))
    )
    assert errors["actuation_mm"] == errors["pre_travel_mm"] == LandmarkError(0.02, 9)
    assert errors["travel_mm"] == errors["bottom_out_mm"] == LandmarkError(0.01, 16)
    assert "reset_mm" not in errors
    assert "peak_cN" not in errors


def test_errors_stand_only_beside_landmarks_that_are_there() -> None:
    errors = landmark_errors(replace(measured(), actuation_spread=PointSpread(0.06, 9)))
    marks = landmarks(measured()).to_dict()
    assert all(marks[name] is not None for name in errors)


def test_a_force_beyond_what_was_measured_has_no_error() -> None:
    short = CurveSpread(np.array([0.0, 1.0]), np.ones(2), 16)
    model = replace(CLEAR, curves=tuple(replace(c, spread=short) for c in CLEAR.curves))
    assert "bottom_out_cN" not in landmark_errors(model)


def test_a_curve_that_ends_before_the_stop_tells_of_the_force_that_it_holds() -> None:
    x_mm = np.linspace(0.0, 3.9, 79)
    curve = ForceCurve(Stroke.PRESS, 50.0, 1, np.array([0.0, 0.0, 3.9, 3.9]), np.array([30.0, 70.0]))
    spread = CurveSpread(x_mm, np.full(79, 2.0), 4)
    model = FDVVModel("short", 4.0, (replace(curve, spread=spread),))
    assert landmark_errors(model)["bottom_out_cN"] == LandmarkError(1.0, 4)


def test_the_error_of_the_peak_is_how_the_peaks_of_repeated_measurements_differ() -> None:
    """Presses differ in scale by 5 %: the mean of 20 gives a peak that differs as its error says."""
    rng = np.random.default_rng(5)
    x_mm = np.linspace(0.0, 4.0, 161)
    true_cN = 30 + 8 * x_mm + 25 * np.exp(-(((x_mm - 1.4) / 0.35) ** 2))
    peaks, errors = [], []
    for _ in range(60):
        presses = true_cN * rng.normal(1.0, 0.05, (20, 1))
        curve = fit_curve(MeasuredCurve(x_mm, presses.mean(axis=0), Stroke.PRESS, 50.0)).curve
        spread = CurveSpread(x_mm, presses.std(axis=0, ddof=1), 20)
        model = FDVVModel("drawn", 4.0, (replace(curve, spread=spread),))
        found = landmarks(model).peak_cN
        assert found is not None
        peaks.append(found)
        errors.append(landmark_errors(model)["peak_cN"].error)
    # the standard deviation of 60 is itself known to 9 %
    assert float(np.std(peaks, ddof=1)) == pytest.approx(float(np.mean(errors)), rel=0.27)

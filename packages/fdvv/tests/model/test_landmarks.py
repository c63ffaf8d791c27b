from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.model.curve import ForceCurve, MeasuredCurve, Stroke
from fdvv.model.file import load_builtin
from fdvv.model.fit import active_part, fit_curve
from fdvv.model.landmarks import LandmarkError, landmark_errors, landmarks
from fdvv.model.model import FDVVModel
from fdvv.model.spread import CurveSpread, PointSpread
from fdvv.units import FloatArray


def line(stroke: Stroke, start_cN: float, slope_cN_mm: float) -> ForceCurve:
    """Make a straight curve of degree 1 over 4 mm."""
    ends_cN = np.array([start_cN, start_cN + 4.0 * slope_cN_mm])
    return ForceCurve(stroke, None, 1, np.array([0.0, 0.0, 4.0, 4.0]), ends_cN)


def tactile(x: FloatArray) -> FloatArray:
    return np.asarray(np.minimum(500 * x, 35 + 8 * x) + 25 * np.exp(-(((x - 1.4) / 0.35) ** 2)))


def test_a_spring_has_the_work_and_slope_of_a_triangle_on_a_box() -> None:
    model = FDVVModel(
        "spring",
        4.0,
        (line(Stroke.PRESS, 30, 10), line(Stroke.RELEASE, 25, 10)),
        actuation_mm=1.5,
        reset_mm=1.2,
    )
    marks = landmarks(model)
    # 4 mm x (30 + 70) / 2 cN = 200 cN mm = 2 mJ; the release lies 5 cN lower: 20 cN mm less
    assert marks.work_mJ == pytest.approx(2.0)
    assert marks.hysteresis_loss_mJ == pytest.approx(0.2)
    assert marks.post_slope_cN_mm == pytest.approx(10.0)
    assert marks.pre_slope_cN_mm == pytest.approx(10.0)
    assert marks.pre_travel_mm == pytest.approx(1.5)
    assert marks.post_travel_mm == pytest.approx(2.5)
    assert marks.actuation_cN == pytest.approx(45.0)
    assert marks.bottom_out_cN == pytest.approx(70.0)
    assert marks.steepest_fall_cN_mm == 0.0


def test_a_linear_button_has_no_peak_valley_or_snap() -> None:
    marks = landmarks(FDVVModel("linear", 4.0, (line(Stroke.PRESS, 30, 10),)))
    assert (marks.peak_mm, marks.peak_cN, marks.valley_mm, marks.valley_cN, marks.snap_ratio) == (None,) * 5
    assert (marks.release_work_mJ, marks.hysteresis_loss_mJ, marks.actuation_mm) == (None,) * 3


def test_a_tactile_button_has_its_bump_where_the_curve_turns() -> None:
    x = np.arange(0, 4.0, 0.005)
    fit = fit_curve(MeasuredCurve(x, tactile(x), Stroke.PRESS))
    marks = landmarks(FDVVModel("tactile", 4.0, (fit.curve,)))
    turning = np.flatnonzero(np.diff(np.sign(np.diff(tactile(x)))))
    assert marks.peak_mm == pytest.approx(x[turning[0]], abs=0.05)
    assert marks.valley_mm == pytest.approx(x[turning[1]], abs=0.05)
    assert marks.peak_cN == pytest.approx(tactile(x)[turning[0]], abs=0.5)
    assert marks.snap_ratio == pytest.approx(1 - tactile(x)[turning[1]] / tactile(x)[turning[0]], abs=0.02)
    assert marks.preload_cN == pytest.approx(35.6, abs=1.5)
    assert marks.steepest_fall_cN_mm < -15


def test_a_model_without_a_press_has_no_landmarks() -> None:
    with pytest.raises(ModelError, match="no press curve"):
        landmarks(FDVVModel("half", 4.0, (line(Stroke.RELEASE, 30, 10),)))


def test_a_release_that_ends_under_load_has_neither_work_nor_loss() -> None:
    press = line(Stroke.PRESS, 30.0, 10.0)
    knots_mm = np.array([1.8, 1.8, 4.0, 4.0])
    short = ForceCurve(Stroke.RELEASE, None, 1, knots_mm, np.array([40.0, 62.0]))
    free = ForceCurve(Stroke.RELEASE, None, 1, knots_mm, np.array([0.0, 62.0]))
    for release, known in ((short, False), (free, True)):
        marks = landmarks(FDVVModel("cut", 4.0, (press, release)))
        assert (marks.release_work_mJ is not None) is known
        assert (marks.hysteresis_loss_mJ is not None) is known


@settings(deadline=None, max_examples=30)
@given(knee_mm=st.floats(2.0, 3.8), seed=st.integers(0, 99))
def test_a_peak_is_above_the_knee(knee_mm: float, seed: int) -> None:
    x = np.arange(-0.2, knee_mm + 0.4, 0.005)
    rng = np.random.default_rng(seed)
    stop = rng.uniform(300, 2000) * np.maximum(x - knee_mm, 0)
    stop[x > knee_mm + 0.1] -= 0.5 * stop[x > knee_mm + 0.1][0]  # a slip deep in the stop
    bump = rng.uniform(0, 30) * np.exp(-(((x - 0.4 * knee_mm) / 0.2) ** 2))
    force = np.where(x < 0, 0.0, np.minimum(500 * x, 35 + 5 * x)) + bump + stop
    part = active_part(MeasuredCurve(x, force, Stroke.PRESS))
    marks = landmarks(FDVVModel("made", part.displacement_mm[-1], (fit_curve(part).curve,)))
    assert marks.bottom_out_mm <= knee_mm + 0.02
    assert marks.peak_mm is None or marks.peak_mm < marks.bottom_out_mm


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

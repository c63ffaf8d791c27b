from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.model.curve import ForceCurve, MeasuredCurve, Stroke
from fdvv.model.fit import active_part, fit_curve
from fdvv.model.landmarks import landmarks
from fdvv.model.model import FDVVModel
from fdvv.units import FloatArray


def line(stroke: Stroke, start_cN: float, slope_cN_mm: float, travel_mm: float = 4.0) -> ForceCurve:
    """Make a straight curve of degree 1."""
    knots = np.array([0.0, 0.0, travel_mm, travel_mm])
    return ForceCurve(stroke, None, 1, knots, np.array([start_cN, start_cN + slope_cN_mm * travel_mm]))


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

"""Which presses may be used."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from fdvv.compensation.presses import AcceptanceLimits, judge_press
from fdvv.errors import ModelError
from fdvv.model.press import Press
from fdvv.units import FloatArray
from tests.support.other_rigs import minimum_jerk

STEP_s = 0.0005


def along(*corners: tuple[float, float], requested_mm_s: float = 100.0) -> Press:
    """Make a press whose cap goes straight between (time, displacement) corners."""
    times, places = zip(*corners, strict=True)
    t = np.arange(0.0, times[-1] + STEP_s / 2, STEP_s)
    return Press(t, np.asarray(np.interp(t, times, places)), np.zeros(t.size), requested_mm_s)


def plain(speed_mm_s: float, requested_mm_s: float = 100.0, depth_mm: float = 4.0) -> Press:
    down = depth_mm / speed_mm_s
    corners = (
        (0.0, 0.0),
        (0.02, 0.0),
        (0.02 + down, depth_mm),
        (0.05 + down, depth_mm),
        (0.05 + 2 * down, 0.0),
    )
    return along(*corners, requested_mm_s=requested_mm_s)


def test_a_press_at_its_speed_down_to_the_stop_is_used() -> None:
    verdict = judge_press(plain(100.0), 4.0)
    assert verdict.reason == ""
    assert verdict.achieved_mm_s == pytest.approx(100.0, rel=0.02)


@given(st.floats(20, 300), st.floats(0.3, 1.7))
def test_a_press_is_used_exactly_when_its_pace_is_within_the_tolerance(asked: float, ratio: float) -> None:
    verdict = judge_press(plain(asked * ratio, asked), 4.0)
    assert (verdict.reason == "") == (abs(verdict.achieved_mm_s / asked - 1) <= 0.35)


def test_too_fast_and_too_slow_say_the_figures_and_what_to_do() -> None:
    assert judge_press(plain(138.0), 4.0).reason == "138 mm/s instead of 100: press slower"
    assert judge_press(plain(62.0), 4.0).reason == "62 mm/s instead of 100: press faster"


def test_the_tolerance_of_the_pace_is_a_setting() -> None:
    assert judge_press(plain(138.0), 4.0, AcceptanceLimits(pace_ratio=0.5)).reason == ""
    assert "slower" in judge_press(plain(120.0), 4.0, AcceptanceLimits(pace_ratio=0.1)).reason
    assert judge_press(plain(350.0), 4.0, AcceptanceLimits().with_pace(float("inf"))).reason == ""


def test_a_press_that_stops_short_has_no_speed_and_says_where_it_stopped() -> None:
    verdict = judge_press(plain(100.0, depth_mm=2.5), 4.0)
    assert verdict.reason == "the press stopped at 2.50 of 4.00 mm; press down to the stop, from the top"
    assert np.isnan(verdict.achieved_mm_s)


def test_a_finger_lifted_during_a_stroke_is_reported_with_the_place() -> None:
    lifted = along((0.0, 0.0), (0.02, 2.1), (0.025, 1.6), (0.05, 4.0), (0.1, 4.0), (0.14, 0.0))
    assert (
        judge_press(lifted, 4.0).reason
        == "the finger was lifted at 2.10 mm on its way down; press without stopping"
    )


def test_a_finger_that_pauses_during_a_stroke_is_reported_with_place_and_time() -> None:
    paused = along((0.0, 0.0), (0.01, 2.1), (0.034, 2.15), (0.044, 4.0), (0.09, 4.0), (0.13, 0.0))
    assert judge_press(paused, 4.0).reason.startswith("the finger paused at 2.1")
    assert "ms; press without stopping" in judge_press(paused, 4.0).reason


@given(st.floats(20, 300), st.floats(1.0, 6.0))
def test_the_smoothest_press_there_is_has_no_pause(speed: float, travel: float) -> None:
    t = np.arange(0.0, 2 * travel / speed + 0.05, STEP_s / 2)
    x = travel * (minimum_jerk(t * speed / travel) - minimum_jerk((t - 0.05) * speed / travel - 1))
    reason = judge_press(Press(t, x, np.zeros(t.size), speed * 1.3), travel).reason
    assert "paused" not in reason
    assert "lifted" not in reason


def cut(press: Press, part: float) -> Press:
    """Cut the commands of the first part of a press."""
    return replace(press, saturated=np.arange(press.t_s.size) < part * press.t_s.size)


def test_a_rig_at_its_limit_for_much_of_the_strokes_teaches_nothing() -> None:
    assert judge_press(cut(plain(100.0), 0.2), 4.0).reason == ""
    assert "at its limit for" in judge_press(cut(plain(100.0), 0.6), 4.0).reason
    assert judge_press(cut(plain(100.0), 0.6), 4.0, AcceptanceLimits(saturated_ratio=1.0)).reason == ""


def test_a_force_sensor_that_tells_one_value_throughout_is_noticed() -> None:
    numb = replace(plain(100.0), sensed_cN=np.full(plain(100.0).t_s.size, 3.0))
    reason = judge_press(numb, 4.0).reason
    assert reason == "the force sensor reads exactly 3.0 cN, pressed or not: look at its cable and amplifier"
    assert judge_press(numb, 4.0, true_position=True).reason == ""


def test_what_is_judged_is_what_the_rig_sensed_at_its_ticks() -> None:
    true = plain(100.0)
    ticks = np.arange(true.t_s.size) % 4 == 0
    # between ticks the sensed column holds nonsense that nobody may look at
    sensed = np.where(ticks, true.displacement_mm, 99.0)
    seen = replace(true, displacement_mm=np.zeros(true.t_s.size), sensed_mm=sensed, tick=ticks)
    assert judge_press(seen, 4.0).reason == ""
    assert "stopped at 0.00" in judge_press(seen, 4.0, true_position=True).reason


def test_too_few_samples_to_tell_the_speed_are_a_reason() -> None:
    t = np.array([0.0, 0.02, 0.04, 0.06])
    press = Press(t, np.array([0.0, 4.0, 4.0, 0.0]), np.zeros(4), 200.0)
    assert "too few samples" in judge_press(press, 4.0).reason


@pytest.mark.parametrize(
    "wrong",
    [
        {"pace_ratio": 0.0},
        {"saturated_ratio": 1.1},
        {"lifted_mm": 0.0},
        {"paused_ratio": -1.0},
        {"patience": 0},
    ],
)
def test_bounds_without_sense_are_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(ModelError, match="ratios"):
        replace(AcceptanceLimits(), **wrong)  # type: ignore[arg-type] # the point of the test


@given(arrays(np.float64, st.integers(2, 60), elements=st.floats(-1, 6) | st.just(np.nan)), st.floats(5, 500))
def test_there_is_a_verdict_on_whatever_a_device_tells(x_mm: FloatArray, asked: float) -> None:
    t = np.arange(x_mm.size) * 0.002
    flags = np.arange(x_mm.size) % 3 == 0
    press = Press(np.asarray(t, dtype=np.float64), x_mm, x_mm, asked, x_mm, x_mm, x_mm, flags, flags)
    for true_position in (False, True):
        verdict = judge_press(press, 4.0, true_position=true_position)
        assert verdict.reason or np.isfinite(verdict.achieved_mm_s)


def test_a_record_without_a_tick_says_so() -> None:
    press = replace(plain(100.0), tick=np.zeros(plain(100.0).t_s.size, dtype=np.bool_))
    assert "no usable samples" in judge_press(press, 4.0).reason

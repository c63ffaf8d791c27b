"""What a known rig can reach of a curve, against closed forms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from fdvv.compensation.feasibility.limits import (
    Motion,
    RigLimits,
    achievable_stroke,
    finger_force_cN,
    inverse_dynamics_cN,
    minimum_jerk,
)
from fdvv.compensation.feasibility.verdict import acceleration_spread_m_s2, estimate_error
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.protocol.tables import Settings
from fdvv.units import FloatArray

TICK_s = 2.5e-4
RIG = RigModel((0.9, 0.05, -0.01), 9e-4, 4e-4, 5e-4, 5.0, 4.5, 3.0, 15.0, 20.0)
IDEAL = RigModel(mass_g=20.0)
LIMITS = RigLimits.of_settings(replace(Settings(), tick_us=250))
X_mm = np.linspace(0.0, 4.0, 401)


def steady(speed_mm_s: float, lasts_s: float = 0.04) -> Motion:
    t = np.arange(round(lasts_s / 3.125e-5), dtype=np.float64) * 3.125e-5
    still = np.zeros(t.size)
    return Motion(Stroke.PRESS, t, speed_mm_s * t, still + speed_mm_s, still)


def bump() -> FloatArray:
    return np.asarray(40.0 + 5.0 * X_mm + 20.0 * np.exp(-(((X_mm - 1.5) / 0.25) ** 2)))


@pytest.mark.parametrize("stroke", list(Stroke))
def test_a_minimum_jerk_covers_the_travel_at_its_mean_speed(stroke: Stroke) -> None:
    motion = minimum_jerk(stroke, 4.0, 100.0, TICK_s)
    assert motion.t_s[-1] == pytest.approx(0.04)
    assert np.abs(motion.velocity_mm_s).max() == pytest.approx(187.5)
    v = np.gradient(motion.displacement_mm, motion.t_s)
    assert_allclose(v, motion.velocity_mm_s, atol=0.2)
    a = 1e-3 * np.gradient(motion.velocity_mm_s, motion.t_s)
    assert_allclose(a[2:-2], motion.acceleration_m_s2[2:-2], atol=0.05)


def test_a_motion_that_turns_back_is_refused() -> None:
    motion = minimum_jerk(Stroke.PRESS, 4.0, 100.0, TICK_s)
    with pytest.raises(ModelError, match="never turns back"):
        replace(motion, stroke=Stroke.RELEASE)


def test_the_command_that_a_force_needs_makes_the_rig_feel_that_force() -> None:
    """Against the rig's own equation, at a steady speed, once its lags have passed."""
    motion, even = steady(80.0), replace(RIG, gain=(0.9, 0.0, 0.0))
    command = inverse_dynamics_cN(even, motion, np.full(motion.t_s.size, 60.0))
    rendered = even.finger_force_cN(
        motion.t_s,
        motion.displacement_mm,
        motion.velocity_mm_s,
        motion.acceleration_m_s2,
        np.interp(motion.t_s + even.delay_s, motion.t_s, command),
    )
    assert_allclose(rendered[200:-100], 60.0, atol=1e-3)


def test_an_ideal_rig_reaches_what_is_intended_with_mass_and_weight_in_the_command() -> None:
    motion = minimum_jerk(Stroke.PRESS, 4.0, 50.0, TICK_s)
    heavy = RigModel(weight_cN=20.0, mass_g=30.0)
    found = achievable_stroke(heavy, LIMITS, motion, X_mm, 40.0 + 5.0 * X_mm)
    assert_allclose(found.achievable_cN, found.intended_cN, atol=0.1)
    a = motion.at_places(motion.acceleration_m_s2, X_mm)
    assert_allclose(found.command_cN, 60.0 + 5.0 * X_mm - 3.0 * a, atol=0.01)
    assert not (found.saturated.any())
    assert not (found.slewed.any())


def test_without_lag_a_saturated_curve_is_the_intended_one_cut_at_the_limit() -> None:
    motion = minimum_jerk(Stroke.RELEASE, 4.0, 5.0, TICK_s)
    intended = 10.0 + 20.0 * X_mm
    found = achievable_stroke(
        RigModel(mass_g=1e-3), replace(LIMITS, force_limit_cN=50.0), motion, X_mm, intended
    )
    assert_allclose(found.achievable_cN, np.minimum(intended, 50.0), atol=0.2)
    assert found.saturated.tolist() == (intended > 51.0).tolist()


def test_a_cap_that_pulls_loses_the_finger() -> None:
    motion = minimum_jerk(Stroke.PRESS, 4.0, 5.0, TICK_s)
    found = achievable_stroke(
        replace(IDEAL, weight_cN=100.0), replace(LIMITS, force_limit_cN=60.0), motion, X_mm, bump()
    )
    assert_allclose(found.achievable_cN, 0.0, atol=1e-9)


def test_a_sine_in_time_shrinks_as_hold_and_lag_say() -> None:
    motion, omega, lag_s = steady(100.0), 2 * np.pi * 250.0, 5e-4
    sine = np.sin(omega * motion.t_s)
    rendered = finger_force_cN(RigModel(electric_lag_s=lag_s), motion, 100.0 + 50.0 * sine, TICK_s)
    middle = slice(200, -200)
    size = 0.5 * np.ptp(rendered[middle])
    x = 0.5 * omega * TICK_s
    assert size == pytest.approx(50.0 * np.sin(x) / x / np.hypot(1.0, omega * lag_s), rel=0.01)


def test_a_ramp_in_time_is_led_and_not_late() -> None:
    motion = steady(100.0)
    ramp = 20.0 + 1000.0 * motion.t_s
    rendered = finger_force_cN(RigModel(electric_lag_s=5e-4), motion, ramp, TICK_s)
    assert_allclose(rendered[200:-200], ramp[200:-200], atol=0.02)


def test_less_of_a_bump_is_left_the_faster_the_press() -> None:
    kept, strong = [], replace(LIMITS, force_limit_cN=1e4, slew_cN_tick=1e4)
    for speed in (20.0, 100.0, 200.0, 400.0):
        found = achievable_stroke(RIG, strong, minimum_jerk(Stroke.PRESS, 4.0, speed, TICK_s), X_mm, bump())
        assert found.kept_ratio is not None
        kept.append(found.kept_ratio)
    assert kept == sorted(kept, reverse=True)
    assert kept[0] > 0.99
    assert kept[3] < 0.8


def test_a_curve_without_a_bump_keeps_none() -> None:
    found = achievable_stroke(
        RIG, LIMITS, minimum_jerk(Stroke.PRESS, 4.0, 100.0, TICK_s), X_mm, 40.0 + 5.0 * X_mm
    )
    assert (found.drop_cN, found.kept_ratio) == (None, None)


def test_a_slew_limit_lets_a_force_rise_no_faster() -> None:
    motion = minimum_jerk(Stroke.PRESS, 4.0, 200.0, TICK_s)
    step = np.where(X_mm < 2.0, 20.0, 120.0)
    slow = replace(LIMITS, slew_cN_tick=2.0)
    found = achievable_stroke(RigModel(mass_g=1e-3), slow, motion, X_mm, step)
    rise = np.diff(motion.at_places(motion.t_s, X_mm))
    steps = np.diff(found.achievable_cN)
    assert (steps <= 1.05 * 2.0 * rise / TICK_s + 0.01).all()
    assert found.slewed.any()
    assert not found.slewed[X_mm < 1.9].any()


def test_a_gain_that_vanishes_is_refused() -> None:
    motion = minimum_jerk(Stroke.PRESS, 4.0, 100.0, TICK_s)
    with pytest.raises(ModelError, match="identify it again"):
        inverse_dynamics_cN(RigModel(gain=(1.0, -0.25, 0.0)), motion, np.zeros(motion.t_s.size))


def test_the_expected_error_of_a_rig_that_only_has_mass_is_its_spread() -> None:
    motion = minimum_jerk(Stroke.PRESS, 4.0, 150.0, TICK_s)
    found = estimate_error(IDEAL, achievable_stroke(IDEAL, LIMITS, motion, X_mm, 40.0 + X_mm), motion, 150.0)
    assert found.inertia_cN == pytest.approx(0.1 * 20.0 * 3.0)
    assert found.mean_cN == pytest.approx(found.limits_cN + found.inertia_cN)
    assert (found.pace_cN, found.model_cN, found.play_cN) == (0.0, 0.0, 0.0)
    assert found.calibration_cN == pytest.approx(0.03 * 42.0)


def test_parts_that_are_chance_add_as_squares() -> None:
    known = replace(IDEAL, drag_N_s_m=4.0, residual_cN=2.0, play_cN=3.0)
    motion = minimum_jerk(Stroke.PRESS, 4.0, 100.0, TICK_s)
    found = estimate_error(known, achievable_stroke(known, LIMITS, motion, X_mm, 40.0 + X_mm), motion, 100.0)
    chance = np.sqrt(found.inertia_cN**2 + found.pace_cN**2 + found.model_cN**2)
    assert found.mean_cN == pytest.approx(found.limits_cN + chance)
    mean_speed = np.abs(motion.at_places(motion.velocity_mm_s, X_mm)).mean()
    assert found.pace_cN == pytest.approx(0.1 * np.sqrt(2 / np.pi) * 0.1 * 4.0 * mean_speed)
    assert found.play_cN == 1.5


def test_the_spread_of_acceleration_goes_through_its_figures_and_on_in_proportion() -> None:
    found = [acceleration_spread_m_s2(v) for v in (0.0, 50.0, 125.0, 200.0, 400.0)]
    assert found == pytest.approx([0.0, 1.0, 2.15, 3.1, 6.2])

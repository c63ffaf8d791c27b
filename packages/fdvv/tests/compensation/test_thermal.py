"""Warmth of the coil, against its equation in small steps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.compensation.feasibility.limits import RigLimits
from fdvv.compensation.feasibility.thermal import derating_onset_s, rise_K, thermal_dose
from fdvv.protocol.tables import Settings

LIMITS = RigLimits.of_settings(Settings())


def settled_K(
    limits: RigLimits, commands_cN: list[tuple[float, float]], lasts_s: float
) -> tuple[float, float]:
    """Step the firmware's equation through (seconds, command); return the end, and the start of derating."""
    heat, time, step, first = 0.0, 0.0, 1e-2, float("inf")
    while time < lasts_s:
        for span_s, command in commands_cN:
            for _ in range(round(span_s / step)):
                end = limits.full_duty_rise_K * (command / limits.full_duty_cN) ** 2
                heat += step * (end - heat) / limits.heat_s
                time += step
                if heat > limits.derate_start_K:
                    first = min(first, time)
    return heat, first


def test_what_presses_without_a_pause_settle_at_is_the_rise_of_their_mean_square() -> None:
    press, release = np.full(10, 200.0), np.full(10, -100.0)
    dose = thermal_dose(LIMITS, press, release, 0.1, 0.0)
    end, _ = settled_K(LIMITS, [(0.1, 200.0), (0.05, 200.0), (0.1, -100.0)], 12 * LIMITS.heat_s)
    assert dose.pressed_rise_K == pytest.approx(end, rel=0.01)
    assert dose.rms_cN == pytest.approx(np.sqrt((0.15 * 200.0**2 + 0.1 * 100.0**2) / 0.25))


def test_at_the_reported_presses_a_minute_derating_begins() -> None:
    hot = replace(LIMITS, full_duty_rise_K=5000.0)
    strong = np.full(10, 0.4 * hot.full_duty_cN)
    hot = replace(hot, force_limit_cN=hot.full_duty_cN)
    dose = thermal_dose(hot, strong, strong, 0.1, 0.1 * hot.full_duty_cN)
    assert dose.presses_per_min is not None
    period_s = 60 / dose.presses_per_min
    cycle = [(dose.cycle_s, strong[0]), (period_s - dose.cycle_s, dose.rest_cN)]
    end, _ = settled_K(hot, cycle, 10 * hot.heat_s)
    # the end of a pause lies half of what one press warms below the mean
    ripple = rise_K(hot, strong[0] ** 2) * dose.cycle_s / hot.heat_s
    assert end + 0.5 * ripple == pytest.approx(hot.derate_start_K, rel=0.01)


def test_a_hold_derates_at_the_reported_time() -> None:
    hot = replace(LIMITS, full_duty_rise_K=2000.0)
    strong = 0.5 * hot.full_duty_cN
    held_s = derating_onset_s(hot, rise_K(hot, strong**2))
    _, found = settled_K(hot, [(1.0, strong)], 2 * hot.heat_s)
    assert held_s == pytest.approx(found, abs=0.1)


def test_a_gentle_button_never_derates() -> None:
    dose = thermal_dose(LIMITS, np.full(10, 60.0), np.full(10, 40.0), 0.04, 20.0)
    assert (dose.presses_per_min, dose.held_s) == (None, None)


def test_a_coil_that_is_too_warm_at_rest_bears_no_press() -> None:
    hot = replace(LIMITS, full_duty_rise_K=20000.0)
    dose = thermal_dose(hot, np.full(10, 400.0), np.full(10, 400.0), 0.04, 350.0)
    assert dose.presses_per_min == 0.0


def test_more_than_the_force_limit_warms_no_more() -> None:
    at, over = (
        thermal_dose(LIMITS, np.full(9, f), np.full(9, f), 0.1, 0.0) for f in (LIMITS.force_limit_cN, 9e3)
    )
    assert at == over


def test_a_duty_limit_bounds_the_command_like_a_force_limit() -> None:
    half = RigLimits.of_settings(replace(Settings(), duty_limit_q15=4096))
    assert half.force_limit_cN == pytest.approx(half.full_duty_cN / 8)
    assert RigLimits.of_settings(Settings()).force_limit_cN == 440.0

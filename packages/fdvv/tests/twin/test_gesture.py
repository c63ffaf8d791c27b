"""Planned presses, their variation, and the pace."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.model.surface import ForceSurface
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import plan, vary
from fdvv.twin.image import image_of
from fdvv.twin.noise import Effort, draw_noise, silence
from fdvv.twin.pace import mean_speed_mm_s, solve_program_pace
from fdvv.twin.rig import Rig
from tests.support.table_press import simulate


def test_a_person_without_variation_presses_as_planned() -> None:
    finger = replace(Finger(), habit=Finger().habit.still())
    assert vary(finger, 0.004, 0.1, 0.1, np.random.default_rng(0)) == plan(finger, 0.004, 0.1)


def test_a_varied_press_spreads_as_the_habit_says() -> None:
    finger, random = Finger(), np.random.default_rng(5)
    drawn = [vary(finger, 0.004, 0.1, 0.2, random) for _ in range(4000)]
    pace = np.array([0.1 / g.press_s for g in drawn])
    stiffness = np.array([g.stiffness_N_m for g in drawn])
    assert pace.mean() == pytest.approx(0.95, abs=0.01)
    assert pace.std() == pytest.approx(0.10, abs=0.005)
    assert stiffness.std() / 450 == pytest.approx(0.15, abs=0.01)
    assert min(g.onset_s for g in drawn) >= 0


def test_the_finger_rests_with_its_resting_force_and_bottoms_with_its_push(tactile: ForceSurface) -> None:
    finger, rig = Finger(), replace(Rig(), mover=replace(Rig().mover, gravity_m_s2=0.0))
    gesture = replace(plan(finger, 0.004, 0.1), onset_s=0.6, dwell_s=0.8)
    trace = simulate(rig, finger, gesture, tactile, 4.0, silence(rig, gesture), 100.0)
    resting, held = np.searchsorted(trace.t_s, [0.6, 1.5])
    assert trace.force_cN[resting] == pytest.approx(100 * finger.habit.rest_N, rel=0.05)
    assert trace.force_cN[held] == pytest.approx(100 * finger.habit.push_N, rel=0.05)


@pytest.mark.parametrize("speed", [50.0, 100.0, 200.0])
def test_the_pace_found_gives_the_speed_asked_for(tactile: ForceSurface, speed: float) -> None:
    rig, finger = Rig(), Finger()
    gesture = plan(finger, 0.004, solve_program_pace(rig, finger, image_of(tactile, 4.0).image, speed))
    trace = simulate(rig, finger, gesture, tactile, 4.0, silence(rig, gesture), speed)
    assert mean_speed_mm_s(trace.t_s, trace.displacement_mm, 4.0) == pytest.approx(speed, rel=0.006)


def test_a_cap_that_sinks_under_the_resting_finger_is_still_pressed_at_the_asked_pace() -> None:
    # 20 cN hold neither the mover nor the finger's 10 cN: the cap rests against a spring of 60 cN/mm
    rig, finger = Rig(), replace(Finger(), habit=Finger().habit.still())
    x = np.linspace(0.0, 4.0, 81)
    weak = np.minimum(20 + 60 * x, 60.0)[np.newaxis]
    surface = ForceSurface(x, np.array([100.0]), weak, weak)
    press_s = solve_program_pace(rig, finger, image_of(surface, 4.0).image, 100.0)
    gesture = plan(finger, 0.004, press_s)
    trace = simulate(rig, finger, gesture, surface, 4.0, silence(rig, gesture), 100.0)
    assert trace.displacement_mm[0] > 0.1
    assert mean_speed_mm_s(trace.t_s, trace.displacement_mm, 4.0) == pytest.approx(100.0, rel=0.006)
    assert np.gradient(trace.displacement_mm, trace.t_s).max() < 250.0


def test_the_mean_speed_runs_from_a_tenth_of_a_millimetre_to_the_stop() -> None:
    t = np.linspace(0.0, 1.0, 1001)
    x = np.interp(t, [0.0, 0.3, 0.35, 0.75, 1.0], [-0.1, 0.09, 0.09, 4.2, 0.0])
    assert mean_speed_mm_s(t, x, 4.0) == pytest.approx(4.11 / 0.4, rel=1e-9)
    assert mean_speed_mm_s(t, x, 5.0) == 0.0


def test_muscle_noise_has_its_spread_and_its_bandwidth() -> None:
    habit = replace(Finger().habit, tremor_ratio=0.0, effort_noise_ratio=0.04)
    noise = Effort(habit, 1e-3).draw(200_000, np.random.default_rng(0))
    assert noise.std() == pytest.approx(0.04, rel=0.05)
    lag = float(np.corrcoef(noise[:-1], noise[1:])[0, 1])
    assert lag == pytest.approx(np.exp(-2 * np.pi * 12 * 1e-3), abs=0.01)


def test_noise_of_the_demodulator_is_common_to_a_burst_and_that_of_the_converter_is_not() -> None:
    rig, gesture = Rig(), plan(Finger(), 0.004, 1.0)
    noise = draw_noise(rig, Finger(), gesture, np.random.default_rng(0)).position_m
    assert noise.mean(axis=1).std() == pytest.approx(np.hypot(5e-6, 0.5 * 3.1e-6 / 5), rel=0.05)
    assert noise.std(axis=1, ddof=1).mean() == pytest.approx(0.5 * 12.7e-3 / 4096, rel=0.05)

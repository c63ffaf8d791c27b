"""The compiled press against closed forms."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from fdvv.model.surface import ForceSurface
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import Gesture, plan
from tests.twin.conftest import (
    FRICTIONLESS,
    LOOSE_PULP,
    PERFECT_POSITION,
    STIFF_SUPPLY,
    Bench,
    flat,
    surface_of,
)

LOCKED: dict[str, Any] = {"mover_mass_kg": 1e9, "frame_mass_kg": 1e9, "gravity_m_s2": 0.0}


def test_a_voltage_step_builds_the_current_of_an_inductance_and_a_resistance() -> None:
    bench = Bench.of(flat(100.0), **LOCKED, **STIFF_SUPPLY, drive_lsb=0.0)
    trace = bench.run()
    m = bench.plant
    after = np.maximum(trace.t_s - 3e-4, 0.0)
    ohm, volts = m.resistance_ohm + m.bridge_ohm, trace.duty_ratio[0] * m.supply_V
    expected = volts / ohm * (1 - np.exp(-after * ohm / m.inductance_H))
    assert expected[-1] == pytest.approx(1 / m.force_constant_N_A, rel=1e-3)
    assert trace.current_A == pytest.approx(expected, abs=1e-6)


def test_a_current_loop_builds_its_current_with_its_own_time_constant() -> None:
    bench = Bench.of(flat(100.0), **LOCKED, drive_lsb=0.0, current_loop_s=1e-4)
    trace = bench.run()
    amps = trace.duty_ratio[0] * bench.plant.supply_V / bench.plant.resistance_ohm
    expected = amps * (1 - np.exp(-np.maximum(trace.t_s - 3e-4, 0.0) / 1e-4))
    assert trace.current_A == pytest.approx(expected, abs=5e-5)


def test_a_cap_without_friction_or_coil_falls_freely() -> None:
    trace = Bench.of(flat(0.0), **FRICTIONLESS, force_constant_N_A=0.0).run()
    falling = trace.t_s < 0.025
    expected_mm = 0.5 * 9.81 * trace.t_s**2 * 1000
    assert trace.displacement_mm[falling] == pytest.approx(expected_mm[falling], abs=1e-9)


def test_a_shorted_coil_brakes_a_falling_cap_to_its_terminal_velocity() -> None:
    bench = Bench.of(flat(0.0), **STIFF_SUPPLY, coulomb_N=0.0, droop_1_m2=0.0)
    m, trace = bench.plant, bench.run()
    drag = m.force_constant_N_A**2 / (m.resistance_ohm + m.bridge_ohm) + m.viscous_N_s_m
    expected_mm_s = m.mover_mass_kg * m.gravity_m_s2 / drag * 1000
    late = int(np.searchsorted(trace.displacement_mm, 3.5))
    assert trace.cap_velocity_mm_s[late] == pytest.approx(expected_mm_s, rel=1e-6)


def test_friction_is_full_once_it_slips() -> None:
    bench = Bench.of(flat(0.0), viscous_N_s_m=0.0, force_constant_N_A=0.0, coulomb_N=0.1, travel_m=0.5)
    trace, m = bench.run(), bench.plant
    late = trace.t_s > 0.1
    gained = np.polyfit(trace.t_s[late], trace.cap_velocity_mm_s[late] / 1000, 1)[0]
    assert gained == pytest.approx(m.gravity_m_s2 - m.coulomb_N / m.mover_mass_kg, rel=1e-9)


def test_a_finger_in_the_air_rings_as_a_damped_oscillator() -> None:
    step_s = 1e-4
    gesture = Gesture(-0.02, -0.018, 0.01, step_s, 0.3, 0.1, 450.0, 0.5)
    bench = Bench.of(flat(40.0), gesture, **LOOSE_PULP)
    trace, m = bench.run(), bench.plant
    t = trace.t_s - 0.01 - step_s / 2
    decay = gesture.damping_N_s_m / (2 * m.finger.finger_mass_kg)
    omega = np.sqrt(gesture.stiffness_N_m / m.finger.finger_mass_kg - decay**2)
    # damping acts on the referent's velocity too: a step response with one zero
    swing = np.cos(omega * t) - decay / omega * np.sin(omega * t)
    expected_mm = -18.0 - 2.0 * np.exp(-decay * t) * swing
    seen = (t > step_s) & (t < 0.2)
    assert trace.finger_mm[seen] == pytest.approx(expected_mm[seen], abs=2e-3)


def test_minimum_jerk_peaks_at_1_875_times_its_mean() -> None:
    gesture = Gesture(-0.02, -0.01, 0.02, 0.1, 0.05, 0.1, 5000.0, 20.0)
    trace = Bench.of(flat(40.0), gesture, **LOOSE_PULP, finger_mass_kg=5e-4).run()
    speed_mm_s = np.gradient(trace.finger_mm, trace.t_s)
    # the finger follows its referent but for m/k of its jerk
    assert speed_mm_s.max() / (10.0 / 0.1) == pytest.approx(1.875, rel=5e-4)


@pytest.mark.parametrize("alpha_s_m", [0.1, 0.3])
def test_a_slow_bounce_keeps_one_minus_alpha_v_of_its_speed(alpha_s_m: float) -> None:
    bench = Bench.of(
        flat(0.0),
        **FRICTIONLESS,
        force_constant_N_A=0.0,
        stop_loss_s_m=1.5 * alpha_s_m,
        stop_stiffness_N_m=4e5,
    )
    velocity = bench.run().cap_velocity_mm_s / 1000
    down = velocity.argmax()
    up = velocity[down : down + 60].min()
    expected = 1 - alpha_s_m * velocity[down]
    assert -up / velocity[down] == pytest.approx(expected, abs=0.3 * (1 - expected))


def test_a_held_stop_gives_way_by_force_over_stiffness() -> None:
    finger = Finger()
    gesture = replace(plan(finger, 0.004, 0.1), dwell_s=0.6)
    bench = Bench.of(flat(50.0), gesture, coulomb_N=0.0)
    trace = bench.run()
    held = int(np.searchsorted(trace.t_s, 0.7))
    m = bench.plant
    kt = m.force_constant_N_A * (
        1 - m.droop_1_m2 * (trace.displacement_mm[held] / 1e3 - m.droop_centre_m) ** 2
    )
    load = trace.force_cN[held] / 100 + m.mover_mass_kg * 9.81 - kt * trace.current_A[held]
    load += m.reluctance_H_m * trace.current_A[held] ** 2 / 2
    assert trace.displacement_mm[held] - 4.0 == pytest.approx(1000 * load / m.stop_stiffness_N_m, abs=1e-4)


@pytest.mark.parametrize("gravity_m_s2", [0.0, 9.81])
def test_a_held_cap_pushes_with_the_table_less_its_weight(gravity_m_s2: float) -> None:
    finger = Finger()
    gesture = replace(plan(finger, 0.004, 0.1), end_m=0.0045, dwell_s=1.5)
    spring = surface_of(np.array([40.0, 200.0]), np.array([40.0, 200.0]))
    bench = Bench.of(
        spring,
        gesture,
        **PERFECT_POSITION,
        **STIFF_SUPPLY,
        drive_lsb=0.0,
        droop_1_m2=0.0,
        coulomb_N=0.0,
        gravity_m_s2=gravity_m_s2,
    )
    trace = bench.run()
    held = int(np.searchsorted(trace.t_s, 1.5))
    x = trace.displacement_mm[held]
    assert 0.5 < x < 3.5
    weight_cN = 100 * bench.plant.mover_mass_kg * gravity_m_s2
    assert trace.force_cN[held] == pytest.approx(40 + 40 * x - weight_cN, abs=0.1)


def test_the_energy_of_a_press_is_accounted_for(tactile: ForceSurface) -> None:
    gesture = plan(Finger(), 0.004, 0.06)
    trace = Bench.of(tactile, gesture).run()
    down = trace.t_s < gesture.onset_s + gesture.press_s
    work_J = np.sum(trace.force_cN[down][1:] / 100 * np.diff(trace.displacement_mm[down]) / 1000)
    assert work_J > 1e-3
    assert trace.energy_J is not None
    assert np.abs(trace.energy_J).max() < 1e-4 * work_J

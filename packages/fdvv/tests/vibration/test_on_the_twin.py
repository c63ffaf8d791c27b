"""Snaps of the twin's buttons, against its truth; simulated."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv.model.curve import Stroke
from fdvv.twin.files import load_button
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import vary
from fdvv.twin.pace import solve_button_pace
from fdvv.twin.rig import ForceSensor
from fdvv.twin.simulate_button import ButtonTrace, draw_button_noise, simulate_button
from fdvv.units import cN_from_N, mm_from_m
from fdvv.vibration.pool import MeasuredVibration, SnapEnergy, measure_vibration, snap_energy
from fdvv.vibration.snap import HeardPress, NotFound

NOISE_m_s2 = 0.03


def pressed(name: str, velocity_mm_s: float, count: int) -> list[ButtonTrace]:
    button, finger, sensor = load_button(name), Finger(), ForceSensor()
    press_s, made = solve_button_pace(button, finger, velocity_mm_s, sensor), []
    for seed in range(count):
        random = np.random.default_rng(seed)
        gesture = vary(finger, button.curve.travel_m, press_s, velocity_mm_s / 1e3, random)
        noise = draw_button_noise(finger, gesture, random, sensor)
        made.append(simulate_button(button, finger, gesture, noise, sensor))
    return made


def energy(name: str) -> SnapEnergy | None:
    button = load_button(name)
    x = mm_from_m(button.curve.step_m) * np.arange(button.press_N.size)
    return snap_energy(x, cN_from_N(button.press_N))


def on_the_housing(traces: list[ButtonTrace]) -> list[HeardPress]:
    """Record presses with an accelerometer on the housing and a bench that places the cap to 0.1 mm."""
    found = []
    for number, trace in enumerate(traces):
        random = np.random.default_rng(1000 + number)
        clean = 1e-3 * np.gradient(trace.plate_velocity_mm_s, float(trace.t_s[1]))
        signal = clean + NOISE_m_s2 * random.standard_normal(clean.size)
        seen_mm = trace.displacement_mm + 0.1 * random.standard_normal()
        found.append(HeardPress(trace.t_s, signal, trace.t_s, seen_mm, Stroke.PRESS, NOISE_m_s2))
    return found


@pytest.mark.slow
def test_onset_frequency_and_duration_of_a_brown_switch_meet_their_targets() -> None:
    traces = pressed("mx-brown", 150.0, 10)
    presses = on_the_housing(traces)
    found = measure_vibration(presses, 150.0, energy("mx-brown"), acceleration=True)
    assert isinstance(found, MeasuredVibration)
    truth = {id(press): trace.closing_s for press, trace in zip(presses, traces, strict=True)}
    for press, snap in zip(found.heard, found.snaps, strict=True):
        assert snap.onset_s == pytest.approx(truth[id(press)], abs=1e-3)
    assert not isinstance(found.ring, NotFound)
    assert found.ring.mode.frequency_Hz == pytest.approx(237.8, rel=0.05)
    assert found.ring.mode.duration_s == pytest.approx(0.01533, rel=0.10)


@pytest.mark.parametrize("name", ["mx-red", "mx-black"])
def test_a_linear_switch_has_no_snap_and_the_reason_is_its_force(name: str) -> None:
    found = measure_vibration(on_the_housing(pressed(name, 100.0, 2)), 100.0, energy(name), acceleration=True)
    assert isinstance(found, NotFound)
    assert "force does not fall" in found.reason

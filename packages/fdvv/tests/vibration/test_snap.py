"""Snaps of made presses: onset, ring, and honest refusals."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.vibration.pool import MeasuredVibration, measure_vibration
from fdvv.vibration.snap import HeardPress, NotFound, Snap, find_snap, noise_rms
from tests.support.snaps import ENERGY, DECAY_1_s, FREQUENCY_Hz, LASTS_s, SNAP_mm, STARTS_s, made_press


@pytest.mark.parametrize("stroke", list(Stroke))
def test_onsets_of_clear_snaps_are_found_to_a_millisecond(stroke: Stroke) -> None:
    made = [made_press(seed, stroke=stroke) for seed in range(10)]
    window = ENERGY.window_mm if stroke is Stroke.PRESS else (1.2, 2.6)
    for press, onset_s in made:
        snap = find_snap(press, window)
        assert isinstance(snap, Snap)
        assert snap.onset_s == pytest.approx(onset_s, abs=1e-3)
        assert snap.stop_s == pytest.approx(STARTS_s + LASTS_s, abs=1.5e-3)


def test_frequency_duration_and_amplitude_of_pooled_presses_meet_their_targets() -> None:
    made = [made_press(seed) for seed in range(8)]
    found = measure_vibration([press for press, _ in made], 100.0, ENERGY, acceleration=True)
    assert isinstance(found, MeasuredVibration)
    assert not isinstance(found.ring, NotFound)
    assert found.ring.mode.frequency_Hz == pytest.approx(FREQUENCY_Hz, rel=0.01)
    assert found.duration_s is not None
    assert found.duration_s.value == pytest.approx(math.log(10) / DECAY_1_s, rel=0.05)
    assert found.amplitude is not None
    assert found.amplitude.value == pytest.approx(1.0, rel=0.15)
    assert found.onset_mm.value == pytest.approx(SNAP_mm, abs=0.03)
    vibration = found.vibration()
    assert vibration.modes[0].frequency_Hz == found.ring.mode.frequency_Hz
    assert vibration.onset_mm == found.onset_mm.value


def test_the_stops_burst_does_not_reach_into_the_ring() -> None:
    quiet = [made_press(seed, amplitude=0.0)[0] for seed in range(20)]
    found = [find_snap(press, ENERGY.window_mm) for press in quiet]
    assert sum(isinstance(snap, Snap) for snap in found) <= 1
    assert isinstance(measure_vibration(quiet, 100.0, ENERGY), NotFound)


def test_a_snap_too_weak_is_refused_with_the_reason() -> None:
    weak = [made_press(seed, amplitude=0.01)[0] for seed in range(6)]
    found = measure_vibration(weak, 100.0, ENERGY)
    assert isinstance(found, NotFound)
    assert "0 of 6 presses" in found.reason
    assert "by chance" in found.reason


def test_a_microphone_of_unknown_scale_gives_no_amplitude_and_a_known_one_the_derivative() -> None:
    presses = [made_press(seed)[0] for seed in range(6)]
    found = measure_vibration(presses, 100.0, ENERGY, acceleration=False)
    assert isinstance(found, MeasuredVibration)
    with pytest.raises(ModelError, match="scale"):
        found.vibration()
    assert not isinstance(found.ring, NotFound)
    mode = found.ring.mode
    assert found.amplitude is not None
    size = math.hypot(2 * math.pi * mode.frequency_Hz, mode.decay_1_s) * found.amplitude.value / 2.0
    assert found.vibration(scale=2.0).modes[0].amplitude_m_s2 == pytest.approx(size)


@pytest.mark.parametrize("noise", [1e-6, 0.01, 100.0])
def test_noise_is_estimated_from_the_record_itself(noise: float) -> None:
    t = np.arange(2000) / 10_000
    drawn = noise * np.random.default_rng(0).standard_normal(t.size)
    assert noise_rms(drawn + 3 * noise * np.sin(2 * np.pi * 20 * t)) == pytest.approx(noise, rel=0.1)


def test_bad_presses_are_refused() -> None:
    press, _ = made_press(0)
    with pytest.raises(ModelError, match="rising times"):
        HeardPress(press.t_s[::-1], press.signal, press.place_s, press.place_mm, Stroke.PRESS)
    with pytest.raises(ModelError, match="one or more presses"):
        measure_vibration([], 100.0, ENERGY)
    short = find_snap(press, (5.0, 6.0))
    assert isinstance(short, NotFound)

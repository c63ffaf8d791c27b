"""The ring in a key's sound: made ones exactly, recorded ones with the part that modes carry."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import FitError
from fdvv.recording.read import read_log
from fdvv.units import FloatArray
from fdvv.vibration.sound import LEAST_CARRIED, sound_ring

RATE_Hz = 44_100.0


def ring(noise: float, seed: int = 0) -> FloatArray:
    """Make two damped modes from 30 ms on, over white noise of so many parts of their rms."""
    t = np.arange(round(0.2 * RATE_Hz)) / RATE_Hz
    after = t - 0.03
    modes = [(1900.0, 250.0, 1.0), (700.0, 150.0, 0.6)]
    sound = sum(a * np.exp(-d * after) * np.sin(2 * np.pi * f * after + 1.2) for f, d, a in modes)
    sound = np.where(after >= 0, sound, 0.0)
    heard = sound[(after >= 0) & (after < 0.025)]
    room = np.random.default_rng(seed).normal(0, noise * np.sqrt(np.mean(heard**2)), t.size)
    return np.asarray(sound + room)


@pytest.mark.parametrize("seed", range(5))
def test_made_modes_are_found_with_their_onset_and_carry_all(seed: int) -> None:
    found = sound_ring(ring(0.01, seed=seed), RATE_Hz)
    assert found.onset_s == pytest.approx(0.03, abs=2e-4)
    strongest = [mode for mode in found.modes if mode.amplitude > 0.2]
    assert sorted(mode.frequency_Hz for mode in strongest) == pytest.approx([700, 1900], rel=0.01)
    assert found.carried_ratio > 0.99
    assert not found.cut


@pytest.mark.parametrize("noise", [0.25, 0.5])
def test_the_part_that_modes_carry_is_that_of_what_is_no_noise(noise: float) -> None:
    found = sound_ring(ring(noise), RATE_Hz)
    assert found.carried_ratio == pytest.approx(1 / (1 + noise**2), abs=0.06)


def test_a_burst_of_noise_is_no_ring() -> None:
    t = np.arange(8000) / RATE_Hz
    envelope = np.where(t > 0.03, np.exp(-200 * (t - 0.03)), 1e-4)
    found = sound_ring(envelope * np.random.default_rng(1).standard_normal(t.size), RATE_Hz)
    assert found.carried_ratio < LEAST_CARRIED


def test_a_file_that_begins_inside_the_sound_says_so() -> None:
    found = sound_ring(ring(0.01)[round(0.031 * RATE_Hz) :], RATE_Hz)
    assert (found.cut, found.onset_s) == (True, 0.0)


def test_silence_and_a_steady_noise_are_refused() -> None:
    with pytest.raises(FitError, match="silent"):
        sound_ring(np.zeros(5000), RATE_Hz)
    steady = np.random.default_rng(3).normal(size=9000)
    steady[5000] = 6.0
    with pytest.raises(FitError, match="no sudden sound"):
        sound_ring(steady, RATE_Hz)


@pytest.mark.shared
def test_of_recorded_keys_some_ring_in_modes_and_some_do_not(shared_data: Path) -> None:
    files = sorted((shared_data / "audio-bucklespring" / "wav").glob("*.wav"))
    parts = []
    for path in files:
        stream = read_log(path).takes[0].streams[0]
        parts.append(sound_ring(stream.values, stream.rate_Hz).carried_ratio)
    assert len(parts) == 10
    assert min(parts) < 0.2
    assert 0.7 < max(parts) < 0.9
    assert 3 <= sum(part >= LEAST_CARRIED for part in parts) <= 7

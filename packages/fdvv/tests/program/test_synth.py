from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.model.file import load_builtin
from fdvv.model.vibration import Mode, Vibration
from fdvv.program.synth import RATE_HZ, SILENCE_counts, Slot, Waveform, render, slot_of_vibration
from tests.support.program.slot_strategies import SLOTS, STRENGTHS

STEADY = Slot(Waveform.SINE, frequency_Hz16=16 * 250, duration_samples=6400, amplitude_counts=1000)


@given(SLOTS, STRENGTHS)
def test_a_sample_is_never_outside_the_converter(slot: Slot, strength: int) -> None:
    counts = render(slot, min(slot.duration_samples, 4000) + 8, strength)
    assert counts.min() >= 1
    assert counts.max() <= 4095


@given(SLOTS, STRENGTHS)
def test_after_the_end_there_is_exactly_silence(slot: Slot, strength: int) -> None:
    counts = render(slot, slot.duration_samples + 40, strength)
    assert (counts[slot.duration_samples :] == SILENCE_counts).all()


@given(SLOTS)
def test_strength_0_is_silence(slot: Slot) -> None:
    assert (render(slot, 300, 0) == SILENCE_counts).all()


@given(SLOTS, STRENGTHS, st.integers(0, 300))
def test_a_shorter_rendering_is_the_beginning_of_a_longer_one(
    slot: Slot, strength: int, samples: int
) -> None:
    np.testing.assert_array_equal(render(slot, samples, strength), render(slot, 310, strength)[:samples])


def test_a_steady_sine_is_the_sine_within_two_counts() -> None:
    middles_s = (np.arange(6400) + 0.5) / RATE_HZ
    wanted = SILENCE_counts + 1000 * np.sin(2 * np.pi * 250 * middles_s)
    assert np.max(np.abs(render(STEADY, 6400) - wanted)) < 2


@given(st.integers(16 * 20, 65_535))
def test_every_frequency_keeps_its_phase_for_a_quarter_of_a_second(frequency_Hz16: int) -> None:
    slot = Slot(Waveform.SINE, frequency_Hz16, 4000, 2047)
    middles_s = (np.arange(4000) + 0.5) / RATE_HZ
    wanted = SILENCE_counts + 2047 * np.sin(2 * np.pi * frequency_Hz16 / 16 * middles_s)
    assert np.max(np.abs(render(slot, 4000) - wanted)) < 2.5


def test_the_envelope_falls_by_the_ratio_in_every_block() -> None:
    # a playback rate of 0 holds the one sample, so that only the envelope is heard
    slot = Slot(Waveform.SAMPLED, 0, 320, 2000, decay_q16=32_768, wave=(127,))
    counts = render(slot, 320).astype(int) - SILENCE_counts
    begins = counts[::32]
    assert begins[0] == round(2000 * 127 / 128)
    for block, begin in enumerate(begins):
        assert begin == pytest.approx(begins[0] / 2**block, abs=1)
        middle = counts[32 * block + 16]
        assert middle == pytest.approx(0.75 * begin, abs=1.5)


def test_a_wave_is_interpolated_between_its_samples_and_down_to_silence() -> None:
    # one wave sample lasts four samples of the converter, which are taken at 1/8, 3/8, 5/8 and 7/8
    slot = Slot(Waveform.SAMPLED, 16 * 4000, 100, 1280, wave=(0, 64, -64))
    counts = render(slot, 16).astype(int) - SILENCE_counts
    wanted = np.interp((np.arange(12) + 0.5) / 4, [0, 1, 2, 3], [0, 640, -640, 0])
    np.testing.assert_allclose(counts[:12], wanted, atol=12)
    assert (counts[12:] == 0).all()


def test_half_the_strength_is_half_the_amplitude() -> None:
    whole = render(STEADY, 640).astype(int) - SILENCE_counts
    half = render(STEADY, 640, 127).astype(int) - SILENCE_counts
    np.testing.assert_allclose(half, whole * 127 / 256, atol=1.5)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"frequency_Hz16": 65_536}, "frequency_Hz16 must be a whole number from 0 to 65535, got 65536"),
        ({"frequency_Hz16": 100.5}, "frequency_Hz16 must be a whole number from 0 to 65535, got 100.5"),
        ({"frequency_Hz16": math.nan}, "frequency_Hz16 must be a whole number from 0 to 65535, got nan"),
        ({"duration_samples": 0}, "duration_samples must be a whole number from 1 to 65535, got 0"),
        ({"amplitude_counts": 2048}, "amplitude_counts must be a whole number from 0 to 2047, got 2048"),
        ({"decay_q16": -1}, "decay_q16 must be a whole number from 0 to 65535, got -1"),
        ({"wave": (1,)}, "length of the wave of a sine must be a whole number from 0 to 0, got 1"),
        ({"waveform": 1}, "length of the wave must be a whole number from 1 to 512, got 0"),
        (
            {"waveform": 1, "wave": (128,)},
            "sample of the wave must be a whole number from -128 to 127, got 128",
        ),
    ],
)
def test_numbers_that_are_no_slot_are_refused(change: dict[str, Any], said: str) -> None:
    fields = {"waveform": 0, "frequency_Hz16": 1, "duration_samples": 1, "amplitude_counts": 1} | change
    with pytest.raises(ModelError, match=said):
        Slot(**fields)


SNAP = Mode(frequency_Hz=239.0, amplitude_m_s2=4.6, decay_1_s=130.7)


def vibration(*modes: Mode, duration_s: float = 0.016) -> Vibration:
    return Vibration("press", None, 2.3, duration_s, modes)  # type: ignore[arg-type]


def test_the_clears_snap_becomes_a_sine_in_whole_units_within_two_hundredths() -> None:
    converted = slot_of_vibration(load_builtin("mx-clear").vibrations[0], 400.0)
    assert converted.error_ratio < 0.02
    slot = converted.slot
    assert slot.waveform is Waveform.SINE
    assert (slot.frequency_Hz16, slot.duration_samples, slot.amplitude_counts) == (3824, 256, 1840)
    assert slot.decay_q16 == round(65_536 * np.exp(-130.7 * 0.002))


@given(st.floats(20, 1500), st.floats(0.001, 5), st.floats(0, 300), st.floats(0.001, 0.05))
def test_the_stated_bounds_hold_for_a_sine(
    frequency_Hz: float, amplitude_m_s2: float, decay_1_s: float, duration_s: float
) -> None:
    mode = Mode(frequency_Hz, amplitude_m_s2, decay_1_s)
    slot = slot_of_vibration(vibration(mode, duration_s=duration_s), 400.0).slot
    assert abs(slot.frequency_Hz16 / 16 - frequency_Hz) <= 1 / 32
    assert abs(slot.duration_samples / RATE_HZ - duration_s) <= 0.5 / RATE_HZ * (1 + 1e-9)
    assert abs(slot.amplitude_counts - 400 * amplitude_m_s2) <= 0.5
    assert abs(slot.decay_q16 / 65_536 - np.exp(-decay_1_s * 0.002)) <= 2**-16


@given(st.floats(20, 1000), st.floats(0.1, 5), st.floats(0, 200))
def test_the_error_of_a_sine_is_that_of_its_roundings(
    frequency_Hz: float, amplitude_m_s2: float, decay: float
) -> None:
    snap = vibration(Mode(frequency_Hz, amplitude_m_s2, decay))
    peak = 400 * amplitude_m_s2
    # chords above the exponential, half a count of amplitude, 1/32 Hz at the end, arithmetic
    chords = peak * (decay * 0.002) ** 2 / 8
    phase = peak * 2 * np.pi * snap.duration_s / 32
    assert slot_of_vibration(snap, 400.0).error_counts <= chords + phase + 0.5 + 2.5


def test_the_error_is_the_largest_distance_from_the_vibration() -> None:
    snap = vibration(SNAP)
    converted = slot_of_vibration(snap, 400.0)
    played = render(converted.slot, 300).astype(float) - SILENCE_counts
    exact = 400.0 * snap.acceleration_m_s2((np.arange(300) + 0.5) / RATE_HZ)
    assert converted.error_counts == pytest.approx(np.max(np.abs(played - exact)))


def test_several_modes_become_a_wave_within_a_twentieth() -> None:
    rich = vibration(SNAP, Mode(560.0, 1.2, 40.0, phase_rad=0.7))
    converted = slot_of_vibration(rich, 300.0)
    assert converted.slot.waveform is Waveform.SAMPLED
    assert converted.error_ratio < 0.05


def test_a_mode_that_starts_elsewhere_or_upside_down_becomes_a_wave() -> None:
    for mode in (Mode(239.0, 4.6, 130.7, phase_rad=1.0), Mode(239.0, -4.6, 130.7)):
        converted = slot_of_vibration(vibration(mode), 400.0)
        assert converted.slot.waveform is Waveform.SAMPLED
        assert converted.error_ratio < 0.05


def test_a_long_wave_uses_the_room_of_the_pool() -> None:
    slot = slot_of_vibration(vibration(SNAP, Mode(60.0, 1.0, 5.0), duration_s=0.3), 300.0).slot
    assert 500 <= len(slot.wave) <= 512


def test_modes_of_no_amplitude_are_silence_without_error() -> None:
    still = vibration(Mode(100.0, 0.0, 1.0), Mode(200.0, 0.0, 1.0))
    converted = slot_of_vibration(still, 400.0)
    assert (render(converted.slot, 300) == SILENCE_counts).all()
    assert (converted.error_counts, converted.error_ratio) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("modes", "duration_s", "gain", "said"),
    [
        ((SNAP,), 0.016, 500.0, "amplitude_counts must be a whole number from 0 to 2047, got 2300"),
        ((SNAP, SNAP), 0.016, 400.0, "amplitude_counts must be a whole number from 0 to 2047"),
        ((SNAP,), 5.0, 400.0, "duration_samples must be a whole number from 1 to 65535, got 80000"),
        ((Mode(5000.0, 1.0, 1.0),), 0.016, 400.0, "frequency_Hz16 must be a whole number from 0 to 65535"),
        ((SNAP, Mode(2100.0, 1.0, 1.0)), 0.016, 100.0, "holds frequencies below 2047.97 Hz, got 2100 Hz"),
        ((SNAP,), 0.016, 0.0, "counts_per_m_s2 must be positive, got 0.0"),
        ((SNAP,), 0.016, np.inf, "counts_per_m_s2 must be positive, got inf"),
    ],
)
def test_a_vibration_beyond_the_board_is_refused(
    modes: tuple[Mode, ...], duration_s: float, gain: float, said: str
) -> None:
    with pytest.raises(ModelError, match=said):
        slot_of_vibration(vibration(*modes, duration_s=duration_s), gain)

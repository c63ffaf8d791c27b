from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.program.synth import RATE_HZ, SILENCE_counts, Slot, Waveform, render
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

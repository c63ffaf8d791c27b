"""Amplitudes of known frequencies in what a slow sensor tells."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import FitError
from fdvv.units import FloatArray
from fdvv.vibration import clear_frequencies_Hz, clock_ratio, measure_tone

T_s: FloatArray = np.arange(2000, dtype=np.float64) * 1e-3


@given(st.floats(0.1, 10.0), st.floats(0.0, 6.28), st.sampled_from([260.0, 380.0, 620.0, 820.0]))
@settings(max_examples=40, deadline=None)
def test_a_tone_is_found_beside_a_drift_even_above_half_the_rate(
    amplitude: float, phase_rad: float, frequency_Hz: float
) -> None:
    samples = amplitude * np.sin(2 * np.pi * frequency_Hz * T_s + phase_rad) + 3.0 - 2.0 * T_s + 0.5 * T_s**2
    tone = measure_tone(T_s, samples, frequency_Hz)
    assert tone.amplitude == pytest.approx(amplitude, rel=1e-9)
    assert tone.error < 1e-9


def test_the_standard_error_is_the_spread_of_repeats() -> None:
    random = np.random.default_rng(1)
    clean = np.sin(2 * np.pi * 330.0 * T_s)
    found = [measure_tone(T_s, clean + random.normal(0, 2.0, T_s.size), 330.0) for _ in range(300)]
    spread = np.std([tone.amplitude for tone in found])
    assert np.mean([tone.error for tone in found]) == pytest.approx(spread, rel=0.15)


@pytest.mark.parametrize("frequency_Hz", [1000.0, 500.0])
def test_a_frequency_that_this_rate_cannot_tell_is_refused(frequency_Hz: float) -> None:
    with pytest.raises(FitError, match="cannot be told at this rate"):
        measure_tone(T_s, np.sin(T_s), frequency_Hz)


def test_too_few_samples_are_refused() -> None:
    with pytest.raises(FitError, match="a tone needs 25 samples, got 10"):
        measure_tone(T_s[:10], T_s[:10], 300.0)


def test_frequencies_with_an_alias_the_loop_can_follow_or_of_one_phase_are_left_out() -> None:
    wanted = np.array([100.0, 300.0, 480.0, 520.0, 600.0, 900.0, 1000.0])
    assert clear_frequencies_Hz(wanted, 1000.0, 150.0).tolist() == [300.0, 600.0]
    assert clear_frequencies_Hz(wanted, 10_000.0, 90.0).tolist() == wanted.tolist()


@pytest.mark.parametrize("true", [0.9953, 1.0, 1.0062])
def test_the_ratio_of_two_clocks_is_found_from_all_tones_together(true: float) -> None:
    random = np.random.default_rng(2)
    frequencies = [300.0, 460.0, 700.0]
    records = [
        (T_s, np.sin(2 * np.pi * f * true * T_s) + random.normal(0, 1.0, T_s.size) + T_s) for f in frequencies
    ]
    assert clock_ratio(records, frequencies) == pytest.approx(true, abs=1 / (8 * 700.0 * 2.0))

"""Likeness of vibrations: identities, and figures of the published implementation."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv.vibration.inverse import correlation, delay_samples, spectral_similarity, spqi, st_sim

T_s = np.arange(1024) / 8000
SNAP = np.sin(2 * np.pi * 239 * T_s) * np.exp(-100 * T_s)
SNAP /= np.abs(SNAP).max()

# vibromaf 0.0.8 (MIT, github.com/hofbi/vibromaf): st_sim and spqi of disturbed(seed) to SNAP
PUBLISHED = [
    (0.7183768294554913, 0.09516696103550315),
    (0.6430679237921575, 0.1014935899831042),
    (0.6875286457300815, 0.10312097520831665),
    (0.6434291136188416, 0.10450549780841986),
]


def disturbed(seed: int) -> FloatArray:
    noise = np.random.default_rng(seed).normal(0, 0.002, T_s.size)
    return np.asarray(SNAP * 0.8 + 0.02 * np.sin(2 * np.pi * (300 + 100 * seed) * T_s) + noise)


@pytest.mark.parametrize("seed", range(4))
def test_both_metrics_give_the_figures_of_the_published_implementation(seed: int) -> None:
    found = st_sim(disturbed(seed), SNAP, 8000.0), spqi(disturbed(seed), SNAP, 8000.0)
    assert found == pytest.approx(PUBLISHED[seed], rel=1e-9)


@given(st.integers(-200, 200), st.floats(0.01, 100.0), st.booleans())
@settings(max_examples=40, deadline=None)
def test_delay_strength_and_sign_do_not_change_a_correlation(shift: int, gain: float, turned: bool) -> None:
    padded = np.pad(SNAP, 300)
    rendered = (-gain if turned else gain) * np.roll(padded, shift)
    assert correlation(rendered, padded) == pytest.approx(1.0)
    assert delay_samples(rendered, padded) == shift


def test_a_correlation_is_the_largest_of_all_delays() -> None:
    random = np.random.default_rng(3)
    a, b = random.normal(size=50), random.normal(size=30)
    slow = np.abs(np.correlate(a, b, "full")).max() / np.linalg.norm(a) / np.linalg.norm(b)
    assert correlation(a, b) == pytest.approx(slow)


def test_ringing_after_the_end_costs_likeness() -> None:
    longer = np.concatenate([SNAP, 0.5 * SNAP])
    assert correlation(longer, SNAP) < 0.95


@pytest.mark.parametrize("measure", [spectral_similarity, st_sim, spqi])
def test_a_vibration_is_fully_like_itself(measure: object) -> None:
    assert callable(measure)
    assert measure(SNAP, SNAP, 8000.0) == pytest.approx(1.0)


def test_spectra_are_alike_whatever_the_phase_and_unlike_at_other_frequencies() -> None:
    shifted = np.cos(2 * np.pi * 239 * T_s) * np.exp(-100 * T_s)
    other = np.sin(2 * np.pi * 600 * T_s) * np.exp(-100 * T_s)
    assert spectral_similarity(shifted, SNAP, 8000.0) > 0.97
    assert spectral_similarity(other, SNAP, 8000.0) < 0.4


def test_silence_is_unlike_anything_and_nothing_is_compared_with_it() -> None:
    quiet = np.zeros(100)
    assert correlation(quiet, SNAP) == 0.0
    assert spectral_similarity(quiet, SNAP, 8000.0) == 0.0
    with pytest.raises(ModelError, match="not silent"):
        st_sim(SNAP, quiet, 8000.0)
    with pytest.raises(ModelError, match="weight must lie between 0 and 1"):
        st_sim(SNAP, SNAP, 8000.0, weight=1.0)

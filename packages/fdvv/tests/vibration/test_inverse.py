"""The inverse of an exciter; likeness by identities and by figures of the published implementation."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.model.vibration import Mode, Vibration
from fdvv.units import FloatArray
from fdvv.vibration.exciter import KnownExciter
from fdvv.vibration.inverse import (
    InverseSettings,
    acceleration_m_s2,
    correlation,
    delay_samples,
    drive_for,
    spectral_similarity,
    spqi,
    st_sim,
)

EXCITER = KnownExciter(24.0, 670.0, 2.0)
SNAP = Vibration(Stroke.PRESS, None, 2.0, 0.016, (Mode(239.0, 3.0, 100.0),))


def played(exciter: KnownExciter, drive_V: FloatArray, rate_Hz: float) -> FloatArray:
    """What a stepwise solution of the equation of motion gives for a wave as the board interpolates it."""
    times = (np.arange(1200) + 0.5) / 16_000
    volts = np.interp(times * rate_Hz, np.arange(drive_V.size + 1), [*drive_V, 0.0], right=0.0)
    omega, fine_s = 2 * np.pi * exciter.resonance_Hz, 1 / 16_000 / 20
    x, v, rendered = 0.0, 0.0, []
    for held in np.repeat(volts, 20):
        # x is the magnet's place in the cap, in units in which its acceleration is the cap's
        a = exciter.gain_m_s2_V * held - omega / exciter.quality * v - omega**2 * x
        v += a * fine_s
        x += v * fine_s
        rendered.append(a)
    return np.asarray(np.array(rendered).reshape(-1, 20).mean(axis=1), dtype=np.float64)


def test_acceleration_is_what_solving_the_equation_of_motion_gives() -> None:
    drive = drive_for(EXCITER, SNAP)
    times = (np.arange(1200) + 0.5) / 16_000
    volts = np.interp(times * drive.rate_Hz, np.arange(drive.volts.size + 1), [*drive.volts, 0.0], right=0.0)
    ours = acceleration_m_s2(EXCITER, volts)
    assert correlation(ours, played(EXCITER, drive.volts, drive.rate_Hz)) > 0.999


def test_the_drive_makes_the_cap_follow_a_weak_vibration_closely() -> None:
    drive = drive_for(EXCITER, SNAP, InverseSettings(lead_s=0.002))
    rendered = played(EXCITER, drive.volts, drive.rate_Hz)
    wanted = SNAP.acceleration_m_s2((np.arange(1200) + 0.5) / 16_000 - drive.lead_s)
    assert correlation(rendered, wanted) > 0.97
    assert correlation(rendered, wanted) == pytest.approx(drive.likeness, abs=0.01)
    assert 0.9 < drive.strength_ratio < 1.05


def test_it_beats_playing_the_waveform_as_it_is() -> None:
    times = (np.arange(1200) + 0.5) / 16_000
    plain = acceleration_m_s2(EXCITER, SNAP.acceleration_m_s2(times))
    wanted = SNAP.acceleration_m_s2(times)
    assert correlation(plain, wanted) < 0.8
    assert drive_for(EXCITER, SNAP).likeness > 0.95


@given(
    st.floats(80.0, 900.0), st.floats(0.1, 200.0), st.floats(0.0, 400.0), st.floats(0.004, 0.05),
    st.floats(300.0, 900.0), st.floats(0.5, 6.0),
)  # fmt: skip
@settings(max_examples=15, deadline=None)
def test_no_drive_exceeds_the_limit_and_what_is_too_strong_is_reported(
    frequency: float, amplitude: float, decay: float, lasts_s: float, resonance: float, quality: float
) -> None:
    vibration = Vibration(Stroke.PRESS, None, 1.0, lasts_s, (Mode(frequency, amplitude, decay),))
    drive = drive_for(KnownExciter(20.0, resonance, quality), vibration)
    assert np.abs(drive.volts).max() <= 2.43 * (1 + 1e-9)
    assert 0 <= drive.likeness <= 1 + 1e-9
    assert drive.strength_ratio <= 1 + 1e-6


def test_more_gain_never_makes_the_expected_cap_less_like_a_weak_vibration() -> None:
    likeness = [drive_for(EXCITER, SNAP, InverseSettings(gain_dB=g)).likeness for g in (0.0, 6.0, 12.0, 18.0)]
    assert all(b >= a - 1e-3 for a, b in pairwise(likeness))


def test_a_long_vibration_is_played_more_slowly_or_refused() -> None:
    long = Vibration(Stroke.PRESS, None, 2.0, 0.2, (Mode(239.0, 3.0, 10.0),))
    drive = drive_for(EXCITER, long)
    assert drive.volts.size <= 512
    assert drive.rate_Hz < 4095
    shrill = Vibration(Stroke.PRESS, None, 2.0, 0.2, (Mode(1500.0, 3.0, 10.0),))
    with pytest.raises(ModelError, match="shorten it or leave out that mode"):
        drive_for(EXCITER, shrill)


@pytest.mark.parametrize("bad", [{"limit_V": 0.0}, {"limit_V": 3.0}, {"lead_s": -1.0}, {"tail_s": 1.0}])
def test_impossible_settings_are_refused(bad: dict[str, float]) -> None:
    with pytest.raises(ModelError, match=next(iter(bad))):
        InverseSettings(**bad)


T_s = np.arange(1024) / 8000
RING = np.sin(2 * np.pi * 239 * T_s) * np.exp(-100 * T_s)
RING /= np.abs(RING).max()

# vibromaf 0.0.8 (MIT, github.com/hofbi/vibromaf): st_sim and spqi of disturbed(seed) to RING
PUBLISHED = [
    (0.7183768294554913, 0.09516696103550315),
    (0.6430679237921575, 0.1014935899831042),
    (0.6875286457300815, 0.10312097520831665),
    (0.6434291136188416, 0.10450549780841986),
]


def disturbed(seed: int) -> FloatArray:
    noise = np.random.default_rng(seed).normal(0, 0.002, T_s.size)
    return np.asarray(RING * 0.8 + 0.02 * np.sin(2 * np.pi * (300 + 100 * seed) * T_s) + noise)


@pytest.mark.parametrize("seed", range(4))
def test_both_metrics_give_the_figures_of_the_published_implementation(seed: int) -> None:
    found = st_sim(disturbed(seed), RING, 8000.0), spqi(disturbed(seed), RING, 8000.0)
    assert found == pytest.approx(PUBLISHED[seed], rel=1e-9)


@given(st.integers(-200, 200), st.floats(0.01, 100.0), st.booleans())
@settings(max_examples=40, deadline=None)
def test_delay_strength_and_sign_do_not_change_a_correlation(shift: int, gain: float, turned: bool) -> None:
    padded = np.pad(RING, 300)
    rendered = (-gain if turned else gain) * np.roll(padded, shift)
    assert correlation(rendered, padded) == pytest.approx(1.0)
    assert delay_samples(rendered, padded) == shift


def test_a_correlation_is_the_largest_of_all_delays() -> None:
    random = np.random.default_rng(3)
    a, b = random.normal(size=50), random.normal(size=30)
    slow = np.abs(np.correlate(a, b, "full")).max() / np.linalg.norm(a) / np.linalg.norm(b)
    assert correlation(a, b) == pytest.approx(slow)


def test_ringing_after_the_end_costs_likeness() -> None:
    longer = np.concatenate([RING, 0.5 * RING])
    assert correlation(longer, RING) < 0.95


@pytest.mark.parametrize("measure", [spectral_similarity, st_sim, spqi])
def test_a_vibration_is_fully_like_itself(measure: object) -> None:
    assert callable(measure)
    assert measure(RING, RING, 8000.0) == pytest.approx(1.0)


def test_spectra_are_alike_whatever_the_phase_and_unlike_at_other_frequencies() -> None:
    shifted = np.cos(2 * np.pi * 239 * T_s) * np.exp(-100 * T_s)
    other = np.sin(2 * np.pi * 600 * T_s) * np.exp(-100 * T_s)
    assert spectral_similarity(shifted, RING, 8000.0) > 0.97
    assert spectral_similarity(other, RING, 8000.0) < 0.4


def test_silence_is_unlike_anything_and_nothing_is_compared_with_it() -> None:
    quiet = np.zeros(100)
    assert correlation(quiet, RING) == 0.0
    assert spectral_similarity(quiet, RING, 8000.0) == 0.0
    with pytest.raises(ModelError, match="not silent"):
        st_sim(RING, quiet, 8000.0)
    with pytest.raises(ModelError, match="weight must lie between 0 and 1"):
        st_sim(RING, RING, 8000.0, weight=1.0)

"""Decaying sinusoids: exact without noise, as good as noise allows with it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import FitError, ModelError
from fdvv.units import FloatArray
from fdvv.vibration.damped import cramer_rao, duration_s, fit_damped, fit_decaying_sinusoid
from fdvv.vibration.modes import fit_modes

RATE_Hz = 10_000.0
T_s = np.arange(300) / RATE_Hz


def ring(t: FloatArray, f: float, d: float, amplitude: float, phase: float = 0.0) -> FloatArray:
    return np.asarray(amplitude * np.exp(-d * t) * np.sin(2 * np.pi * f * t + phase))


@settings(max_examples=25, deadline=None)
@given(
    f=st.floats(150.0, 2000.0),
    d=st.floats(20.0, 500.0),
    amplitude=st.floats(1e-3, 1e3),
    phase=st.floats(-3.0, 3.0),
)
def test_a_single_ring_without_noise_is_found_exactly(
    f: float, d: float, amplitude: float, phase: float
) -> None:
    (mode,) = fit_modes(ring(T_s, f, d, amplitude, phase), RATE_Hz, count=1).modes
    assert mode.frequency_Hz == pytest.approx(f, rel=1e-6)
    assert mode.decay_1_s == pytest.approx(d, rel=1e-5)
    assert mode.amplitude == pytest.approx(amplitude, rel=1e-6)
    assert np.angle(np.exp(1j * (mode.phase_rad - phase))) == pytest.approx(0.0, abs=1e-5)


@settings(max_examples=15, deadline=None)
@given(scale=st.floats(1e-4, 1e4), seed=st.integers(0, 1000))
def test_the_unit_of_the_signal_scales_amplitudes_and_nothing_else(scale: float, seed: int) -> None:
    noise = 0.05 * np.random.default_rng(seed).standard_normal(T_s.size)
    signal = ring(T_s, 239, 150, 1.0) + noise
    (one,), (other,) = (fit_modes(k * signal, RATE_Hz, count=1).modes for k in (1.0, scale))
    assert other.frequency_Hz == pytest.approx(one.frequency_Hz, rel=1e-4)
    assert other.decay_1_s == pytest.approx(one.decay_1_s, rel=1e-3)
    assert other.amplitude == pytest.approx(scale * one.amplitude, rel=1e-3)


def test_two_rings_over_a_straight_line_are_distinguished_and_counted() -> None:
    signal = ring(T_s, 239, 150, 2.0, 0.3) + ring(T_s, 900, 340, 1.0) + 0.5 - 20 * T_s
    fit = fit_modes(signal + 0.02 * np.random.default_rng(0).standard_normal(T_s.size), RATE_Hz, degree=1)
    assert [mode.frequency_Hz for mode in fit.modes] == pytest.approx([239, 900], rel=0.01)
    assert [mode.decay_1_s for mode in fit.modes] == pytest.approx([150, 340], rel=0.05)


def test_noise_alone_holds_no_mode() -> None:
    random = np.random.default_rng(1)
    counts = [len(fit_modes(random.standard_normal(200), RATE_Hz).modes) for _ in range(20)]
    assert counts.count(0) >= 19


def test_errors_reach_the_bound_of_cramer_and_rao_and_are_reported_truly() -> None:
    random, noise = np.random.default_rng(2), 0.2
    fits = [
        fit_modes(ring(T_s, 239, 150, 2.0, 0.3) + noise * random.standard_normal(T_s.size), RATE_Hz, count=1)
        for _ in range(200)
    ]
    found = np.array([(fit.modes[0].frequency_Hz, fit.modes[0].decay_1_s) for fit in fits])
    reported_sd = np.array([(fit.modes[0].frequency_sd_Hz, fit.modes[0].decay_sd_1_s) for fit in fits])
    bound = cramer_rao([T_s], (239, 150, 2.0, 0.3), noise)
    # 200 draws know a spread to 5 %
    assert found.std(axis=0) == pytest.approx(bound, rel=0.15)
    assert np.median(reported_sd, axis=0) == pytest.approx(bound, rel=0.1)


def test_the_bound_falls_as_noise_does_and_with_the_root_of_the_presses() -> None:
    mode = (239.0, 150.0, 1.0, 0.0)
    one = np.array(cramer_rao([T_s], mode, 0.1, 2))
    assert np.array(cramer_rao([T_s], mode, 0.05, 2)) == pytest.approx(one / 2)
    assert np.array(cramer_rao([T_s] * 4, mode, 0.1, 2)) == pytest.approx(one / 2)


def test_presses_unfold_what_one_press_aliases_only_if_their_phases_are_one() -> None:
    random = np.random.default_rng(3)
    times = [np.arange(25) / 1000 + phase for phase in random.uniform(0, 1e-3, 15)]
    signals = [ring(t, 900, 120, 1.0, 0.4) + 0.05 * random.standard_normal(t.size) for t in times]
    one = {f: fit_damped(times, signals, [f], [100.0], same_phase=True) for f in (100.0, 900.0)}
    assert one[900.0].modes[0].frequency_Hz == pytest.approx(900, rel=0.005)
    assert one[900.0].noise < 0.3 * one[100.0].noise
    own = {f: fit_damped(times, signals, [f], [100.0]).noise for f in (100.0, 900.0)}
    assert own[100.0] == pytest.approx(own[900.0], rel=1e-3)


def test_the_papers_single_sinusoid_is_found_on_uneven_times_and_over_a_slope() -> None:
    t = np.sort(np.random.default_rng(4).uniform(0, 0.03, 120))
    fit = fit_decaying_sinusoid(t, ring(t, 239, 150, 3.0) + 1 - 10 * t, degree=1)
    (mode,) = fit.modes
    assert (mode.frequency_Hz, mode.decay_1_s) == pytest.approx((239, 150), rel=1e-4)
    assert mode.duration_s == pytest.approx(np.log(10) / 150, rel=1e-4)


def test_the_papers_frequency_and_duration_agree_at_a_tenth_of_critical_damping() -> None:
    assert duration_s(0.1 * 2 * np.pi * 239) == pytest.approx(0.016, rel=0.05)


def test_bad_signals_are_refused_in_one_line() -> None:
    with pytest.raises(ModelError, match="finite"):
        fit_modes([0.0, np.nan, 1.0], RATE_Hz)
    with pytest.raises(ModelError, match="rate_Hz"):
        fit_modes(np.zeros(50), 0.0)
    with pytest.raises(FitError, match="no 4 modes"):
        fit_modes(np.ones(60), RATE_Hz, count=4)
    with pytest.raises(FitError, match="more than"):
        fit_damped([T_s[:4]], [T_s[:4]], [100.0], [10.0])

"""The exciter from its tones, and its file."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import FitError, InputError, ModelError
from fdvv.units import FloatArray
from fdvv.vibration.exciter import (
    KnownExciter,
    Tone,
    ToneBench,
    clear_frequencies_Hz,
    clock_ratio,
    fit_exciter,
    load_exciter,
    measure_tone,
    save_exciter,
)

TRUE = KnownExciter(24.0, 680.0, 1.8)

BENCH = ToneBench(2.4, lag_s=5e-4, lag_ratio=0.05)

FREQUENCIES_Hz = np.array([260.0, 300, 340, 380, 420, 460, 540, 580, 620, 660, 700, 740, 780, 820])


def tones(noise_m: float = 0.0, seed: int = 0) -> list[Tone]:
    """What the position sensor would show of a cap held at 80 Hz: written apart from the fit."""
    random = np.random.default_rng(seed)
    found = []
    for f in FREQUENCIES_Hz:
        w, w0 = 2 * np.pi * f, 2 * np.pi * TRUE.resonance_Hz
        gain = TRUE.gain_m_s2_V * w**2 / np.hypot(w0**2 - w**2, w * w0 / TRUE.quality)
        moved = BENCH.drive_V * gain / w**2 / (1 - (80.0 / f) ** 2) / np.sqrt(1 + (w * BENCH.lag_s) ** 2)
        seen = moved + complex(*random.normal(0, noise_m, 2))
        found.append(Tone(float(f), abs(seen), noise_m))
    return found


def test_the_response_is_that_of_two_masses_and_a_spring() -> None:
    magnet_kg, cap_kg, stiffness, damping, motor = 0.006, 0.014, 74_000.0, 9.0, 0.27
    reduced = magnet_kg * cap_kg / (magnet_kg + cap_kg)
    exciter = KnownExciter(
        motor / cap_kg, np.sqrt(stiffness / reduced) / 2 / np.pi, np.sqrt(stiffness * reduced) / damping
    )
    for f in (50.0, 239.0, 700.0, 3000.0):
        s = 2j * np.pi * f
        equations = np.array(
            [
                [cap_kg * s**2 + damping * s + stiffness, -damping * s - stiffness],
                [-damping * s - stiffness, magnet_kg * s**2 + damping * s + stiffness],
            ]
        )
        cap, _ = np.linalg.solve(equations, [motor, -motor])
        assert complex(exciter.response(f)) == pytest.approx(complex(s**2 * cap), rel=1e-9)


def test_clean_tones_give_the_exciter_back() -> None:
    found = fit_exciter(tones(noise_m=1e-12), BENCH, latency_s=0.007, simulated=True)
    assert found.gain_m_s2_V == pytest.approx(24.0, rel=0.02)
    assert found.resonance_Hz == pytest.approx(680.0, rel=0.005)
    assert found.quality == pytest.approx(1.8, rel=0.02)
    assert (found.latency_s, found.simulated, found.tones) == (0.007, True, 14)
    assert found.residual_ratio < 0.01


def test_standard_errors_cover_what_noise_does() -> None:
    found = [fit_exciter(tones(noise_m=1.2e-7, seed=seed), BENCH) for seed in range(30)]
    for name in ("gain_m_s2_V", "resonance_Hz", "quality"):
        off = [np.log(getattr(f, name) / getattr(TRUE, name)) / f.error[name] for f in found]
        assert np.sqrt(np.mean(np.square(off))) < 1.5
        assert np.abs(off).max() > 0.1  # the errors are not merely huge


def test_an_unknown_lag_of_the_sensor_leaves_the_gain_unsure_and_the_shape_not() -> None:
    known = fit_exciter(tones(noise_m=1e-7), BENCH)
    guessed = fit_exciter(tones(noise_m=1e-7), ToneBench(BENCH.drive_V))
    assert guessed.error["gain_m_s2_V"] > 2 * known.error["gain_m_s2_V"]
    assert guessed.resonance_Hz == pytest.approx(680.0, rel=0.05)


def test_tones_that_nobody_hears_are_refused() -> None:
    with pytest.raises(FitError, match="0 of 14 tones rise above the noise"):
        fit_exciter([replace(tone, error=1.0) for tone in tones()], BENCH)
    with pytest.raises(FitError, match="needs 6 tones, got 3"):
        fit_exciter(tones()[:3], BENCH)


@pytest.mark.parametrize("name", ["gain_m_s2_V", "resonance_Hz", "quality"])
@pytest.mark.parametrize("value", [0.0, -1.0, float("nan")])
def test_impossible_numbers_are_refused(name: str, value: float) -> None:
    numbers = {each: value if each == name else 2.0 for each in ("gain_m_s2_V", "resonance_Hz", "quality")}
    with pytest.raises(ModelError, match=f"{name} must be positive"):
        KnownExciter(numbers["gain_m_s2_V"], numbers["resonance_Hz"], numbers["quality"])


def test_a_file_gives_the_exciter_back(tmp_path: Path) -> None:
    exciter = fit_exciter(tones(noise_m=1e-7), BENCH, latency_s=0.0002, simulated=True)
    save_exciter(exciter, tmp_path / "rig.exciter.json")
    assert load_exciter(tmp_path / "rig.exciter.json") == exciter


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"format": "fdvv-model"}, "not a known exciter"),
        ({"quality": "high"}, "quality"),
        ({"quality": -1.0}, "quality must be positive"),
        ({"more": 1}, "more"),
    ],
)
def test_a_file_that_is_none_is_refused_in_one_line(
    tmp_path: Path, change: dict[str, object], message: str
) -> None:
    path = tmp_path / "rig.exciter.json"
    save_exciter(TRUE, path)
    path.write_text(json.dumps(json.loads(path.read_text()) | change))
    with pytest.raises(InputError, match=message) as caught:
        load_exciter(path)
    assert "\n" not in str(caught.value)
    assert "identify the exciter again" in str(caught.value)


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
    with pytest.raises(FitError, match="cannot be measured at this rate"):
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

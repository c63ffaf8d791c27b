"""The exciter from its tones, and its file."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import FitError, InputError, ModelError
from fdvv.vibration import KnownExciter, Tone, ToneBench, fit_exciter, load_exciter, save_exciter

TRUE = KnownExciter(24.0, 680.0, 1.8)
BENCH = ToneBench(2.4, lag_s=5e-4, lag_ratio=0.05)
FREQUENCIES_Hz = np.array([260.0, 300, 340, 380, 420, 460, 540, 580, 620, 660, 700, 740, 780, 820])


def tones(
    exciter: KnownExciter = TRUE, grip_Hz: float = 80.0, noise_m: float = 0.0, seed: int = 0
) -> list[Tone]:
    """What the position sensor would show: written apart from the fit."""
    random = np.random.default_rng(seed)
    found = []
    for f in FREQUENCIES_Hz:
        w, w0 = 2 * np.pi * f, 2 * np.pi * exciter.resonance_Hz
        gain = exciter.gain_m_s2_V * w**2 / np.hypot(w0**2 - w**2, w * w0 / exciter.quality)
        moved = BENCH.drive_V * gain / w**2 / (1 - (grip_Hz / f) ** 2) / np.sqrt(1 + (w * BENCH.lag_s) ** 2)
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
    ("change", "told"),
    [
        ({"format": "fdvv-model"}, "not a known exciter"),
        ({"quality": "high"}, "quality"),
        ({"quality": -1.0}, "quality must be positive"),
        ({"more": 1}, "more"),
    ],
)
def test_a_file_that_is_none_is_refused_in_one_line(
    tmp_path: Path, change: dict[str, object], told: str
) -> None:
    path = tmp_path / "rig.exciter.json"
    save_exciter(TRUE, path)
    path.write_text(json.dumps(json.loads(path.read_text()) | change))
    with pytest.raises(InputError, match=told) as caught:
        load_exciter(path)
    assert "\n" not in str(caught.value)
    assert "identify the exciter again" in str(caught.value)

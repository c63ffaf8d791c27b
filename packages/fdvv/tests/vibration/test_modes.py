"""How many modes are found: those that exist, none that noise, a fading drive or half of a pair would be."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv.units import FloatArray
from fdvv.vibration.damped import DampedFit, DampedMode
from fdvv.vibration.modes import drives, most_likely, overlaps, sound

PERIOD_s, NOISE = 1e-4, 0.03


def records(
    terms: list[tuple[float, float, float]], seed: int = 0
) -> tuple[list[FloatArray], list[FloatArray]]:
    """Draw 12 records of (frequency, decay, amplitude) with phases of their own, over a slope and noise."""
    random, times, signals = np.random.default_rng(seed), [], []
    for _ in range(12):
        t = np.asarray((np.arange(150) + random.uniform()) * PERIOD_s, dtype=np.float64)
        y = 0.3 - 20 * t + NOISE * random.standard_normal(t.size)
        for f, d, a in terms:
            y += a * np.exp(-d * t) * np.sin(2 * np.pi * f * t + random.uniform(0, 6.28))
        times.append(t)
        signals.append(y)
    return times, signals


def mode(frequency_Hz: float, decay_1_s: float) -> DampedMode:
    return DampedMode(frequency_Hz, decay_1_s, 1.0, 0.0, 0.1, 0.1, 0.1)


def fit(*modes: DampedMode) -> DampedFit:
    return DampedFit(modes, np.ones((1, len(modes))), 1.0, 100, 0.0)


def test_two_modes_are_two_and_noise_is_none() -> None:
    found = most_likely(*records([(239, 150, 1.0), (895, 330, 0.8)]), PERIOD_s)
    assert sorted(m.frequency_Hz for m in found.modes) == pytest.approx([239, 895], rel=0.01)
    counts = [len(most_likely(*records([], seed), PERIOD_s).modes) for seed in range(10)]
    assert counts == [0] * 10


def test_a_fading_drive_beside_a_mode_does_not_bend_it() -> None:
    times, signals = records([(239, 150, 1.0), (260, 700, 2.0)])
    bent = [
        min(found.modes, key=lambda m: m.decay_1_s).decay_1_s
        for most in (0, 1)
        for found in (most_likely(times, signals, PERIOD_s, most_drives=most),)
    ]
    assert bent[1] == pytest.approx(150, rel=0.05)
    assert abs(bent[0] - 150) > 3 * abs(bent[1] - 150)


def test_a_known_mode_stays_as_it_is_and_leaves_its_amplitude() -> None:
    found = most_likely(*records([(239, 150, 1.0), (895, 330, 0.8)]), PERIOD_s, known=(239.0, 150.0))
    (held,) = (m for m in found.modes if m.frequency_Hz == 239.0)
    assert (held.decay_1_s, held.frequency_sd_Hz) == (150.0, 0.0)
    assert held.amplitude == pytest.approx(1.0, rel=0.03)


@pytest.mark.parametrize(
    ("modes", "is_sound"),
    [
        ((mode(239, 150), mode(895, 330)), True),
        ((mode(247, 150), mode(233, 150)), False),
        ((mode(30, 10),), False),
        ((mode(4500, 150),), False),
        ((mode(239, 1),), False),
        ((mode(239, 150), mode(250, 900)), True),
        ((mode(239, 150), mode(250, 900), mode(300, 900)), False),
    ],
)
def test_modes_lie_in_the_band_fall_and_are_no_halves_of_a_pair(
    modes: tuple[DampedMode, ...], is_sound: bool
) -> None:
    assert sound(fit(*modes), 0.02, PERIOD_s, most_drives=1) == is_sound


def test_modes_nearer_than_they_are_wide_overlap_unless_one_is_a_drive() -> None:
    one, near, drive = mode(881, 300), mode(945, 300), mode(900, 2000)
    assert overlaps(one, (one, near))
    assert drives(drive)
    assert not overlaps(one, (one, drive, mode(1200, 300)))

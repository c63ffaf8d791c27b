"""A vibration beside the one asked for, on cap motions whose vibration is known."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.model.jnd_file import jnds_of
from fdvv.model.vibration import Mode, Vibration
from fdvv.units import FloatArray
from fdvv.vibration.compare import BANDS_Hz, CapMotions, RATE_Hz, band_power, compare_vibration, least_s
from tests.support.jnds import as_literature, record_of

SNAP = Vibration(Stroke.PRESS, None, 2.3, 0.016, (Mode(239.0, 4.6, 130.0),))
BEFORE = 80
SINCE_s = (np.arange(BEFORE + 208) - BEFORE) / RATE_Hz


def motions(
    presses: int, seed: int, *vibrations: tuple[Vibration, float, float], noise: float = 0.0
) -> CapMotions:
    """Presses of several speeds with a motion below 60 Hz, and vibrations with gain and delay on top."""
    random = np.random.default_rng(seed)
    speed = 100.0 * (1 + 0.1 * random.standard_normal(presses))
    phase = random.uniform(0, 2 * np.pi, presses)
    slow = [8.0 * np.sin(2 * np.pi * 0.4 * v * SINCE_s + p) for v, p in zip(speed, phase, strict=True)]
    rows = np.array(slow) + noise * random.standard_normal((presses, SINCE_s.size))
    for wave, gain, delay_s in vibrations:
        rows = rows + gain * wave.acceleration_m_s2(SINCE_s - delay_s)
    return CapMotions(rows, speed, BEFORE)


def test_a_perfect_rendering_is_on_time_at_its_level_and_not_to_be_noticed() -> None:
    found = compare_vibration(SNAP, motions(6, 1), motions(6, 2, (SNAP, 1.0, 0.0)))
    assert found.onset_ms == pytest.approx(0.0, abs=0.13)
    assert found.level_dB == pytest.approx(0.0, abs=0.1)
    assert found.likeness == pytest.approx(1.0, abs=0.01)
    assert found.total_JND < 0.15


@settings(max_examples=25, deadline=None)
@given(st.floats(0.25, 4.0), st.integers(-40, 60), st.integers(0, 1000))
def test_a_known_shift_and_gain_come_out(gain: float, late_samples: int, seed: int) -> None:
    late_s = late_samples / RATE_Hz
    found = compare_vibration(SNAP, motions(8, seed), motions(8, seed + 1, (SNAP, gain, late_s)))
    assert found.onset_ms == pytest.approx(1e3 * late_s, abs=0.3)
    assert found.onset_mm == pytest.approx(0.1 * 1e3 * late_s, abs=0.08)
    assert found.level_dB == pytest.approx(20 * np.log10(gain), abs=0.3)
    assert found.onset_JND == pytest.approx(abs(1e3 * late_s) / 5.5, abs=0.06)


def test_twice_the_amplitude_is_6_dB_more() -> None:
    silent = motions(5, 3)
    once, twice = (
        compare_vibration(SNAP, silent, replace(motions(5, 3, (SNAP, gain, 0.0)), paired=True)).level_dB
        for gain in (0.7, 1.4)
    )
    assert once is not None
    assert twice is not None
    assert twice - once == pytest.approx(20 * np.log10(2.0), abs=1e-9)


def test_a_pair_of_one_press_shows_a_vibration_far_below_the_caps_own_motion() -> None:
    silent = motions(4, 5, noise=20.0)
    rows = silent.acceleration_m_s2 + 0.5 * SNAP.acceleration_m_s2(SINCE_s - 0.001)
    found = compare_vibration(SNAP, silent, CapMotions(rows, silent.speed_mm_s, BEFORE, paired=True))
    assert found.onset_ms == pytest.approx(1.0, abs=0.01)
    assert found.level_dB == pytest.approx(-6.0206, abs=0.01)
    assert found.own_dB > 15


def test_the_shape_is_found_at_any_phase_as_an_exciter_may_be_connected_either_way() -> None:
    played = motions(6, 8, (SNAP, -1.0, 0.002))
    found = compare_vibration(SNAP, motions(6, 7), played)
    assert found.onset_ms == pytest.approx(2.0, abs=0.2)
    assert found.likeness == pytest.approx(1.0, abs=0.01)


def test_another_frequency_is_found_and_counts() -> None:
    other = replace(SNAP, modes=(replace(SNAP.modes[0], frequency_Hz=2 * 239.0),))
    silent = motions(5, 9)
    mixed = motions(5, 10, (other, 1.0, 0.0), (SNAP, 1.0, 0.0))
    assert compare_vibration(SNAP, silent, mixed).likeness == pytest.approx(np.sqrt(0.5), abs=0.12)
    nearby = replace(SNAP, modes=(replace(SNAP.modes[0], frequency_Hz=1.2 * 239.0),))
    found = compare_vibration(SNAP, silent, motions(5, 11, (nearby, 1.0, 0.0)))
    assert found.frequency_ratio == pytest.approx(1.2, abs=0.05)
    assert found.frequency_JND == pytest.approx(1.0, abs=0.25)


def test_noise_alone_has_no_onset() -> None:
    silent, played = motions(8, 12, noise=3.0), motions(8, 13, noise=3.0)
    found = compare_vibration(SNAP, silent, played)
    assert found.onset_ms is None
    assert found.onset_JND is None


def test_where_nothing_is_played_the_caps_own_motion_is_set_beside_what_was_asked() -> None:
    found = compare_vibration(SNAP, motions(5, 14, (SNAP, 2.0, 0.0)), None)
    assert not found.played
    assert found.added_m_s2 is None
    assert found.own_dB == pytest.approx(6.02, abs=0.1)
    assert found.level_JND > 0


def test_people_with_twice_the_jnd_notice_half_as_much_of_the_level() -> None:
    once, twice = (
        compare_vibration(SNAP, motions(5, 15), None, jnds_of(record_of(as_literature("vibration", times))))
        for times in (1.0, 2.0)
    )
    assert twice.level_JND == pytest.approx(0.5 * once.level_JND)
    assert once.level_JND == pytest.approx(compare_vibration(SNAP, motions(5, 15), None).level_JND)


def test_a_vibration_left_out_is_noticed_less_where_the_cap_shakes_anyway() -> None:
    quiet, shaken = (compare_vibration(SNAP, motions(5, 15, noise=n), None).level_JND for n in (0.1, 10.0))
    assert quiet > 2 * shaken


@given(st.floats(50.0, 700.0), st.floats(0.1, 10.0))
def test_the_bands_hold_the_mean_square_of_a_tone(frequency_Hz: float, amplitude: float) -> None:
    tone: FloatArray = amplitude * np.sin(2 * np.pi * frequency_Hz * np.arange(8000) / RATE_Hz)
    power = band_power(tone[None, :])[0]
    edge = min(abs(frequency_Hz - one) for band in BANDS_Hz for one in band)
    assert power.sum() == pytest.approx(amplitude**2 / 2, rel=0.02)
    if edge > 5:
        inside = [low <= frequency_Hz < high for low, high in BANDS_Hz]
        assert power[int(np.argmax(inside))] > 0.95 * power.sum()


def test_presses_that_were_cut_differently_are_refused() -> None:
    silent, played = motions(3, 16), motions(3, 17)
    with pytest.raises(ModelError, match="cut alike"):
        compare_vibration(SNAP, silent, replace(played, before=BEFORE - 1))


def test_a_period_of_the_slowest_mode_must_lie_in_the_stroke() -> None:
    two = replace(SNAP, modes=(*SNAP.modes, Mode(100.0, 1.0, 50.0)))
    assert least_s(two) == pytest.approx(0.01)

"""JNDs of force and vibration, against closed forms."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.model.curve import Stroke
from fdvv.model.noticeable import (
    LITERATURE,
    Jnds,
    acceleration_above_threshold,
    vibration_threshold_um,
    weber_steps,
)
from fdvv.model.vibration import Mode, Vibration
from fdvv_people.study.simulation.perception import Senses, vibration_above_threshold

RATE_Hz = 8000.0


def test_the_jnd_of_force_is_7_percent_far_up_and_stricter_than_what_push_buttons_gave() -> None:
    assert float(LITERATURE.force_cN(100_000.0)) == pytest.approx(7000.0, rel=1e-3)
    for force_cN in (50.0, 80.0, 110.0):
        assert float(LITERATURE.force_cN(force_cN)) < LITERATURE.snap_cN


def test_the_jnd_of_force_is_10_to_15_percent_where_that_is_quoted() -> None:
    force_cN = np.array([30.0, 60.0, 69.0])
    ratio = LITERATURE.force_cN(force_cN) / force_cN
    assert ratio.max() <= 0.15
    assert ratio.min() >= 0.10


@given(st.floats(-500.0, 500.0))
def test_the_jnd_of_force_is_positive_and_the_same_for_both_signs(force_cN: float) -> None:
    assert float(LITERATURE.force_cN(force_cN)) > 0
    assert float(LITERATURE.force_cN(force_cN)) == float(LITERATURE.force_cN(-force_cN))


@given(st.floats(0.02, 0.5), st.floats(1.0, 100.0), st.floats(1.0, 500.0))
def test_steps_add_up_what_one_jnd_is_at_every_size(ratio: float, floor: float, size: float) -> None:
    sizes = np.linspace(0.0, size, 4001)
    jnds = ratio * (sizes + floor)
    expected = np.trapezoid(1 / jnds, sizes)
    assert float(weber_steps(size, ratio, floor)) == pytest.approx(float(expected), rel=1e-3)


def test_steps_and_jnds_of_force_and_vibration_are_of_one_law() -> None:
    jnds = Jnds(force_ratio=0.1, force_floor_cN=20.0, vibration_ratio=0.3, vibration_floor=4.0)
    for steps, jnd in ((jnds.force_steps, jnds.force_cN), (jnds.vibration_steps, jnds.vibration)):
        slope = (steps(50.001) - steps(50.0)) / 0.001
        assert float(1 / slope) == pytest.approx(float(jnd(50.0)), rel=1e-3)


def test_every_jnd_states_its_source_or_says_that_none_was_read() -> None:
    for one in LITERATURE.sources:
        assert one.source or "no source" in one.assumed
        assert one.assumed


def test_the_figures_in_a_file_are_those_that_judge_and_say_whose_they_are() -> None:
    found = LITERATURE.to_dict()
    assert (found["force_ratio"], found["force_floor_cN"], found["snap_cN"]) == (0.07, 30.0, 10.0)
    assert found["origin"] == "JNDs from the literature"
    assert "sources" not in found


def test_the_threshold_is_lowest_at_250_Hz_and_rises_by_12_dB_in_an_octave() -> None:
    at_Hz = np.arange(40.0, 1000.0)
    assert at_Hz[np.argmin(vibration_threshold_um(at_Hz))] == 250.0
    octave = vibration_threshold_um(40.0) / vibration_threshold_um(80.0)
    assert 20 * np.log10(octave) == pytest.approx(12.0, abs=0.2)


@given(st.floats(80.0, 300.0), st.floats(0.5, 20.0))
def test_a_sampled_vibration_is_felt_as_its_modes_say(frequency_Hz: float, amplitude_m_s2: float) -> None:
    # long, so that it has one frequency; higher up the sudden start is felt beside it
    wave = Vibration(Stroke.PRESS, None, 2.0, 0.5, (Mode(frequency_Hz, amplitude_m_s2, 8.0),))
    sampled = wave.acceleration_m_s2(np.arange(4800) / RATE_Hz)
    expected = vibration_above_threshold(wave, Senses())
    assert acceleration_above_threshold(sampled, RATE_Hz) == pytest.approx(expected, rel=0.03)


@given(st.floats(0.1, 10.0))
def test_twice_the_amplitude_is_twice_as_far_above_threshold(gain: float) -> None:
    wave = np.sin(2 * np.pi * 239 * np.arange(200) / RATE_Hz)
    once, more = (acceleration_above_threshold(k * wave, RATE_Hz) for k in (1.0, gain))
    assert more == pytest.approx(gain * once)


def test_steps_are_one_at_threshold_and_one_per_ratio_far_above() -> None:
    assert float(LITERATURE.vibration_steps(0.0)) == 0.0
    assert float(LITERATURE.vibration_steps(1.0)) == pytest.approx(1.0, abs=0.1)
    far = LITERATURE.vibration_steps(np.array([1e4, 1.17e4]))
    assert float(far[1] - far[0]) == pytest.approx(np.log(1.17) / 0.17, rel=1e-3)

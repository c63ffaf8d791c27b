"""What a finger could feel of a button, in just noticeable differences."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.model.curve import ForceCurve, Stroke
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.model.vibration import Mode, Vibration
from fdvv_people.study.simulation.perception import (
    Senses,
    haptic_features,
    perceived_difference,
    vibration_above_threshold,
)

SENSES = Senses()


def flat(force_cN: float, travel_mm: float = 4.0, velocity_mm_s: float | None = None) -> ForceCurve:
    """Return a curve of one force all the way."""
    knots_mm = np.array([0.0, 0.0, travel_mm, travel_mm])
    return ForceCurve(
        stroke=Stroke.PRESS,
        velocity_mm_s=velocity_mm_s,
        degree=1,
        knots_mm=knots_mm,
        control_points_cN=np.full(2, force_cN),
    )


def button(*curves: ForceCurve, vibrations: tuple[Vibration, ...] = ()) -> FDVVModel:
    return FDVVModel("flat", 4.0, curves, vibrations=vibrations)


@settings(max_examples=25)
@given(st.floats(5, 300), st.floats(0.1, 4))
def test_steps_of_force_follow_the_weber_law_with_a_floor(force_cN: float, steps: float) -> None:
    above_cN = (force_cN + SENSES.floor_cN) * math.exp(steps * SENSES.weber_ratio) - SENSES.floor_cN
    weaker, stronger = (haptic_features(button(flat(one))) for one in (force_cN, above_cN))
    found = perceived_difference(weaker, stronger)
    assert found.force_JND == pytest.approx(steps)
    assert found.total_JND == pytest.approx(steps)
    assert found.speed_JND == pytest.approx(0, abs=1e-9)
    assert found.vibration_JND == 0


@pytest.mark.parametrize(("force_cN", "low", "high"), [(60, 4.0, 9.0), (30, 3.0, 4.5), (500, 35.0, 50.0)])
def test_one_step_lies_where_forces_of_keys_and_of_newtons_were_found_to(
    force_cN: float, low: float, high: float
) -> None:
    assert low <= SENSES.weber_ratio * (force_cN + SENSES.floor_cN) <= high


def test_a_difference_that_comes_with_speed_alone_is_distinguished_from_one_at_all_speeds() -> None:
    paces = SENSES.paces_mm_s
    rising = button(flat(50, velocity_mm_s=float(paces[0])), flat(60, velocity_mm_s=float(paces[-1])))
    features = haptic_features(rising)
    middle = features.force_JND.mean(axis=1, keepdims=True)
    steady = replace(features, force_JND=np.broadcast_to(middle, features.force_JND.shape))
    found = perceived_difference(features, steady)
    assert found.force_JND == pytest.approx(0, abs=1e-12)
    assert found.speed_JND == pytest.approx(features.force_JND[0, :, 0].std())
    assert perceived_difference(features, steady, replace(SENSES, speed_weight=0.0)).total_JND < 1e-12


def test_a_difference_at_one_place_counts_more_the_higher_the_pooling() -> None:
    clear, brown = (haptic_features(load_builtin(name)) for name in ("mx-clear", "mx-brown"))
    totals = [
        perceived_difference(clear, brown, replace(SENSES, pooling=p)).force_JND
        for p in (1.0, 2.0, 8.0, 400.0)
    ]
    assert totals == sorted(totals)
    largest = np.abs((clear.force_JND - brown.force_JND).mean(axis=1)).max(axis=1)
    assert totals[-1] == pytest.approx(math.sqrt(np.mean(largest**2)), rel=0.02)


def test_a_vibration_at_the_threshold_of_its_frequency_that_lasts_long_enough_is_one_step() -> None:
    amplitude_m_s2 = 1e-6 * SENSES.threshold_um * (2 * math.pi * 250) ** 2
    steady = Vibration(Stroke.PRESS, None, 2.0, 0.2, (Mode(250.0, amplitude_m_s2, 0.0),))
    assert vibration_above_threshold(steady, SENSES) == pytest.approx(1.0)
    assert vibration_above_threshold(replace(steady, duration_s=0.1), SENSES) == pytest.approx(math.sqrt(0.5))
    assert vibration_above_threshold(None, SENSES) == 0


@settings(max_examples=25)
@given(st.floats(1, 300), st.floats(0.002, 0.2))
def test_a_decaying_vibration_has_the_energy_of_its_samples(decay_1_s: float, duration_s: float) -> None:
    amplitude_m_s2 = 1e-6 * SENSES.threshold_um * (2 * math.pi * 250) ** 2
    decaying = Vibration(Stroke.PRESS, None, 2.0, duration_s, (Mode(250.0, amplitude_m_s2, decay_1_s),))
    t_s = (np.arange(20_000) + 0.5) * duration_s / 20_000
    energy = np.sum(np.exp(-2 * decay_1_s * t_s)) * duration_s / 20_000 / 0.2
    assert vibration_above_threshold(decaying, SENSES) == pytest.approx(math.sqrt(energy), rel=1e-4)


def test_a_difference_is_none_between_the_same_and_the_same_both_ways() -> None:
    clear, dome = (haptic_features(load_builtin(name)) for name in ("mx-clear", "rubber-dome"))
    assert perceived_difference(clear, clear).total_JND == 0
    assert perceived_difference(clear, dome).total_JND == pytest.approx(
        perceived_difference(dome, clear).total_JND
    )


def test_a_button_that_tells_nothing_of_release_has_the_press_stand_for_it() -> None:
    features = haptic_features(button(flat(50)))
    np.testing.assert_array_equal(features.force_JND[0], features.force_JND[1])


def test_forces_in_ratio_are_those_of_a_model_in_ratio() -> None:
    heavier = haptic_features(button(flat(66)))
    np.testing.assert_allclose(
        haptic_features(button(flat(60)), force_ratio=1.1).force_JND, heavier.force_JND
    )


def test_senses_that_nobody_has_are_refused() -> None:
    for wrong in ({"weber_ratio": 0.0}, {"pooling": 0.5}, {"threshold_um": math.nan}, {"speed_weight": -1.0}):
        with pytest.raises(ModelError):
            Senses(**wrong)

"""All paces of a button together: what one tells serves the others, and none makes another's up."""

from __future__ import annotations

from dataclasses import replace

import pytest
from tests.vibration.test_snap import ENERGY, DECAY_1_s, FREQUENCY_Hz, made_press

from fdvv.model import Stroke
from fdvv.vibration import MeasuredVibration, NotFound, PacePresses, Ring, measure_paces


def pace(velocity_mm_s: float, amplitude: float, seeds: range) -> PacePresses:
    presses = tuple(made_press(seed, amplitude)[0] for seed in seeds)
    return PacePresses(Stroke.PRESS, velocity_mm_s, presses, ENERGY)


def test_paces_share_the_mode_that_they_ring_in_and_keep_their_own_amplitudes() -> None:
    found, mode = measure_paces(
        [pace(50.0, 0.5, range(6)), pace(100.0, 1.5, range(6, 12))], acceleration=True
    )
    assert mode is not None
    assert mode.frequency_Hz == pytest.approx(FREQUENCY_Hz, rel=0.01)
    assert mode.decay_1_s == pytest.approx(DECAY_1_s, rel=0.05)
    for one, amplitude in zip(found, (0.5, 1.5), strict=True):
        assert isinstance(one, MeasuredVibration)
        assert isinstance(one.ring, Ring)
        assert one.ring.mode.frequency_Hz == mode.frequency_Hz
        assert one.amplitude is not None
        assert one.amplitude.value == pytest.approx(amplitude, rel=0.15)


def test_a_pace_that_shows_nothing_is_not_given_what_others_show() -> None:
    paces = [
        pace(50.0, 0.0, range(4)),
        pace(100.0, 1.0, range(6)),
        PacePresses(Stroke.PRESS, 150.0, (), ENERGY),
        replace(pace(200.0, 1.0, range(2)), energy=None),
    ]
    quiet, heard, empty, linear = measure_paces(paces, acceleration=True)[0]
    assert isinstance(heard, MeasuredVibration)
    assert isinstance(quiet, NotFound)
    assert "presses show a snap" in quiet.reason
    assert isinstance(empty, NotFound)
    assert empty.reason == "no press of it was heard"
    assert isinstance(linear, NotFound)
    assert "force does not fall" in linear.reason

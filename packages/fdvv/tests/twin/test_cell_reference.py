"""The compiled rig with a load cell against a hybrid automaton, written from the twin's page."""

from __future__ import annotations

from dataclasses import replace

import pytest

from fdvv.twin.gesture import Gesture
from tests.support.campaign import campaign, in_turn
from tests.support.reference.cell_press import (
    Departure,
    compiled_press,
    departure,
    gesture_at,
    reference_press,
)
from tests.support.reference.hybrid import Method

SEED = 3
ASKED_cN = 0.1
SHORT_ticks = 600


def replayed(
    gesture: Gesture, velocity_mm_s: float, method: Method = "DOP853", ticks: int | None = None
) -> Departure:
    """Press both with the drive that the compiled one was given."""
    compiled = compiled_press(gesture, velocity_mm_s, SEED, ticks)
    return departure(compiled, reference_press(gesture, velocity_mm_s, SEED, compiled.drive, method))


def check(found: Departure) -> None:
    assert found.between_cN < ASKED_cN
    assert found.impact_cN < ASKED_cN
    # what neither can know better than a converter: a reading on the brink of a step
    assert found.most_counts <= 1
    assert found.counts_ratio < 0.05


def test_a_replayed_press_agrees_with_the_reference_between_and_at_the_stops() -> None:
    # down and 20 ms at the bottom; the way back is in the slow ones
    check(replayed(replace(gesture_at(200.0), onset_s=0.001), 200.0, ticks=SHORT_ticks))


@pytest.mark.slow
@campaign("velocity_mm_s", [50.0, 100.0, 200.0], part=1)
def test_whole_replayed_presses_agree_too(velocity_mm_s: float) -> None:
    check(replayed(gesture_at(velocity_mm_s), velocity_mm_s))


@pytest.mark.slow
def test_a_finger_that_comes_from_above_and_leaves_agrees_too() -> None:
    check(replayed(gesture_at(150.0, lift_m=0.002), 150.0))


@pytest.mark.slow
@in_turn(3)
def test_an_implicit_solver_finds_the_same_press() -> None:
    check(replayed(gesture_at(200.0), 200.0, "Radau"))


@pytest.mark.slow
@campaign("velocity_mm_s", [50.0, 100.0, 200.0], part=1)
def test_presses_whose_loop_closes_on_their_own_readings_agree(velocity_mm_s: float) -> None:
    gesture = gesture_at(velocity_mm_s)
    # a converter step that falls the other way leads the two apart, as far as the loop lets them
    own = reference_press(gesture, velocity_mm_s, SEED)
    assert departure(compiled_press(gesture, velocity_mm_s, SEED), own).between_cN < ASKED_cN

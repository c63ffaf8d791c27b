"""Each rule names its part on a record by formula that shows the fault, and nothing on a sound one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.compensation.parts.facts import PressFacts
from fdvv.compensation.parts.rules import RULES, SURE_RULES, force_silent, part_at_fault, was_touched
from tests.compensation.parts.scripted_press import Scripted, TRAVEL_mm

SOUND = Scripted().facts()
STILL = np.full(SOUND.place_mm.size, 0.01)
NOISE = 0.002 * np.random.default_rng(1).standard_normal(STILL.size)


def named(facts: PressFacts) -> str:
    found = part_at_fault(facts)
    return found.part if found else ""


def felt(facts: PressFacts) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    assert facts.force_cN is not None
    return np.asarray(facts.force_cN)


@pytest.mark.parametrize("rule", SURE_RULES)
def test_a_sound_press_breaks_no_rule(rule: object) -> None:
    assert rule(SOUND) is None  # type: ignore[operator]
    assert was_touched(SOUND)


def test_a_place_above_the_top_stop_is_read_backwards() -> None:
    assert named(replace(SOUND, place_mm=-SOUND.place_mm)) == "position sensor"


def test_a_place_without_noise_under_a_finger_is_frozen_and_nobody_is_blamed() -> None:
    frozen = replace(SOUND, place_mm=STILL)
    assert named(frozen) == "position sensor"
    assert "exactly 0.010 mm" in str(part_at_fault(frozen))


def test_a_place_without_noise_that_no_finger_pushes_is_no_fault() -> None:
    assert named(replace(SOUND, place_mm=STILL, force_cN=0.2 * NOISE)) == ""


def test_a_cap_that_bears_a_finger_without_a_way_is_stuck() -> None:
    assert named(replace(SOUND, place_mm=STILL + NOISE)) == "mover"


def test_a_cap_on_its_stop_that_bears_a_finger_is_not_stuck() -> None:
    heavy = replace(SOUND, place_mm=TRAVEL_mm + NOISE, commanded_cN=STILL + 25.0)
    assert named(heavy) == ""


def test_a_reading_that_a_stroke_does_not_change_is_dead() -> None:
    found = part_at_fault(replace(SOUND, force_cN=np.zeros(STILL.size)))
    assert found is not None
    assert found.part == "force sensor"
    assert found.seen == "the force sensor reads 0.0 cN and nothing else while the motor pushes up to 65 cN"


def test_a_reading_that_stands_still_from_before_the_deepest_on_is_dead() -> None:
    force = felt(SOUND).copy()
    force[150:] = 0.0
    assert named(replace(SOUND, force_cN=force)) == "force sensor"


def test_a_reading_that_stands_still_as_the_finger_has_left_is_no_fault() -> None:
    force = felt(SOUND).copy()
    force[300:] = 0.0
    assert named(replace(SOUND, force_cN=force)) == ""


def test_a_reading_that_stands_still_to_the_end_counts_where_the_board_says_that_something_is_wrong() -> None:
    force = felt(SOUND).copy()
    force[230:] = 0.0
    facts = replace(SOUND, force_cN=force)
    assert part_at_fault(facts, RULES) is None
    found = part_at_fault(facts, SURE_RULES)
    assert found is not None
    assert found.part == "force sensor"


def test_a_finger_that_seems_to_pull_is_felt_backwards() -> None:
    assert named(Scripted(scale=-1.0).facts()) == "force sensor"


def test_a_zero_far_below_nothing_is_the_force_sensors() -> None:
    assert named(Scripted(zero_cN=-25.0).facts()) == "force sensor"


def test_a_sensor_without_noise_is_silent() -> None:
    assert force_silent(SOUND) is None
    assert force_silent(replace(SOUND, force_cN=np.full(STILL.size, 3.0))) is not None


@pytest.mark.parametrize("depth_mm", [5.6, 2.5])
def test_a_stop_far_from_where_it_was_asked_to_be_is_the_limiters(depth_mm: float) -> None:
    facts = Scripted(depth_mm=depth_mm).facts()
    assert named(facts) == "travel limiter"
    assert f"{depth_mm:.1f} mm instead of 4.0" in str(part_at_fault(facts))


def test_a_stop_that_yields_under_a_finger_and_a_coil_is_no_fault() -> None:
    deep = Scripted(depth_mm=4.6).facts()
    assert named(deep) == "travel limiter"
    assert named(replace(deep, commanded_cN=deep.commanded_cN - 300.0)) == ""


def test_a_person_who_turns_early_is_not_the_limiter() -> None:
    turned = Scripted(depth_mm=2.5).facts()
    force = np.minimum(felt(turned), 60.0)
    assert named(replace(turned, force_cN=force)) == ""


def test_a_cap_that_lies_there_under_more_than_its_weight_has_no_coil() -> None:
    lying = replace(SOUND, place_mm=TRAVEL_mm - 0.5 * SOUND.place_mm / TRAVEL_mm, commanded_cN=STILL + 80.0)
    assert named(lying) == "coil"
    assert named(replace(lying, commanded_cN=STILL + 25.0)) == ""


def test_without_a_force_sensor_only_places_are_judged() -> None:
    blind = replace(SOUND, force_cN=None)
    assert named(blind) == ""
    assert named(replace(blind, place_mm=-SOUND.place_mm)) == "position sensor"
    assert named(replace(blind, place_mm=STILL)) == "position sensor"

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


def felt(facts: PressFacts = SOUND) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    assert facts.force_cN is not None
    return np.asarray(facts.force_cN)


def dead_from(row: int) -> PressFacts:
    """Return a sound press whose force reads nothing from a row on."""
    return replace(SOUND, force_cN=np.where(np.arange(STILL.size) < row, felt(), 0.0))


def on_the_stop(commanded_cN: float) -> PressFacts:
    """Return a press of a cap that lies on its stop and moves little."""
    place_mm = TRAVEL_mm - 0.5 * SOUND.place_mm / TRAVEL_mm
    return replace(SOUND, place_mm=place_mm, commanded_cN=STILL + commanded_cN)


BLIND = replace(SOUND, force_cN=None)
DEEP, TURNED = Scripted(depth_mm=4.6).facts(), Scripted(depth_mm=2.5).facts()
NAMED = {
    "a place above the top stop": (replace(SOUND, place_mm=-SOUND.place_mm), "position sensor"),
    "a place without noise under a finger": (replace(SOUND, place_mm=STILL), "position sensor"),
    "a place without noise that no finger pushes": (replace(SOUND, place_mm=STILL, force_cN=0.2 * NOISE), ""),
    "a cap that bears a finger without a way": (replace(SOUND, place_mm=STILL + NOISE), "mover"),
    "a cap on its stop that bears a finger": (
        replace(SOUND, place_mm=TRAVEL_mm + NOISE, commanded_cN=STILL + 25.0),
        "",
    ),
    "a reading that a stroke does not change": (dead_from(0), "force sensor"),
    "a reading that stands still from before the deepest on": (dead_from(150), "force sensor"),
    "a reading that stands still as the finger has left": (dead_from(300), ""),
    "a finger that seems to pull": (Scripted(scale=-1.0).facts(), "force sensor"),
    "a zero far below nothing": (Scripted(zero_cN=-25.0).facts(), "force sensor"),
    "a stop too deep": (DEEP, "travel limiter"),
    "a stop that yields under a finger and a coil": (
        replace(DEEP, commanded_cN=DEEP.commanded_cN - 300.0),
        "",
    ),
    "a person who turns early": (replace(TURNED, force_cN=np.minimum(felt(TURNED), 60.0)), ""),
    "a cap that lies there under more than its weight": (on_the_stop(80.0), "coil"),
    "a cap that lies there under little more than its weight": (on_the_stop(25.0), ""),
    "a sound press without a force sensor": (BLIND, ""),
    "a place above the top stop, without one": (replace(BLIND, place_mm=-SOUND.place_mm), "position sensor"),
    "a place without noise, without one": (replace(BLIND, place_mm=STILL), "position sensor"),
}


@pytest.mark.parametrize("record", NAMED)
def test_a_record_names_the_part_at_fault_or_nothing(record: str) -> None:
    facts, part = NAMED[record]
    found = part_at_fault(facts)
    assert (found.part if found else "") == part


@pytest.mark.parametrize("rule", SURE_RULES)
def test_a_sound_press_breaks_no_rule(rule: object) -> None:
    assert rule(SOUND) is None  # type: ignore[operator]
    assert was_touched(SOUND)


def test_a_place_without_noise_is_reported_with_its_value() -> None:
    assert "exactly 0.010 mm" in str(part_at_fault(replace(SOUND, place_mm=STILL)))


def test_a_reading_that_a_stroke_does_not_change_is_dead() -> None:
    found = part_at_fault(dead_from(0))
    assert found is not None
    assert found.seen == "the force sensor reads 0.0 cN and nothing else while the motor pushes up to 65 cN"


def test_a_reading_that_stands_still_to_the_end_counts_where_the_board_says_that_something_is_wrong() -> None:
    assert part_at_fault(dead_from(230), RULES) is None
    found = part_at_fault(dead_from(230), SURE_RULES)
    assert found is not None
    assert found.part == "force sensor"


def test_a_sensor_without_noise_is_silent() -> None:
    assert force_silent(SOUND) is None
    assert force_silent(replace(SOUND, force_cN=np.full(STILL.size, 3.0))) is not None


@pytest.mark.parametrize("depth_mm", [5.6, 2.5])
def test_a_stop_far_from_where_it_was_asked_to_be_is_the_limiters(depth_mm: float) -> None:
    found = part_at_fault(Scripted(depth_mm=depth_mm).facts())
    assert found is not None
    assert found.part == "travel limiter"
    assert f"{depth_mm:.1f} mm instead of 4.0" in str(found)

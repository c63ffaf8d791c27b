"""Labels under a simulated finger: what was rendered is recorded, and what failed is seen in it."""

from __future__ import annotations

from pathlib import Path

import pytest

from fdvv.errors import DeviceError, InputError
from fdvv.protocol.tables import Fault
from fdvv_people.study.plan.plan import Stimulus
from fdvv_people.study.stimulus.finger import SimulatedFingerRenderer

FD = Stimulus(name="FD", button="mx-clear", rendered="FD")
FDVV = Stimulus(name="FDVV", button="mx-clear")


def prepared(**labels: Stimulus) -> SimulatedFingerRenderer:
    stage = SimulatedFingerRenderer(Path(), presses=2)
    stage.prepare(labels)
    return stage


def test_every_label_that_is_shown_is_pressed_and_judged_against_its_own_intention() -> None:
    stage = prepared(B=FDVV, A=FD, X=FDVV)
    for label in ("A", "B", "A"):
        stage.show(label)
    a, b, x = stage.rendered()
    assert [(one.label, one.stimulus, one.presses) for one in (a, b, x)] == [
        ("A", "FD", 4),
        ("B", "FDVV", 2),
        ("X", "FDVV", 0),
    ]
    assert max(error for error in a.error_cN if error is not None) < 2
    assert max(error for error in b.error_cN if error is not None) < 8
    assert all(speed is not None and 30 < speed < 150 for speed in (*a.velocity_mm_s, *b.velocity_mm_s))
    assert (a.vibrations, b.vibrations, x.vibrations) == (0, 4, 0), "one on the way down, one on the way up"
    assert not any(one.faults for one in (a, b, x))


def test_the_same_seed_renders_the_same() -> None:
    first, second = prepared(A=FD, B=FDVV), prepared(A=FD, B=FDVV)
    for stage in (first, second):
        stage.show("B")
    assert first.rendered() == second.rendered()


def test_preparing_forgets_what_was_rendered_before() -> None:
    stage = prepared(A=FD)
    stage.show("A")
    stage.prepare({"A": FD})
    assert [one.presses for one in stage.rendered()] == [0]


@pytest.mark.parametrize("fault", [Fault.POSITION_STUCK, Fault.VIBRATION_BOARD])
def test_a_fault_ends_the_stage_in_one_line_and_is_kept(fault: Fault) -> None:
    stage = prepared(A=FD, B=FDVV)
    stage.live("B").fail(fault)
    with pytest.raises(DeviceError, match=fault.name.lower()) as caught:
        stage.show("B")
    assert "\n" not in str(caught.value)
    assert not any(letter.isdigit() for letter in str(caught.value)), "a force could tell what was rendered"
    assert stage.rendered()[1].faults == (fault.name.lower(),)
    with pytest.raises(DeviceError):
        stage.show("A")


def test_a_label_that_was_not_prepared_is_refused() -> None:
    with pytest.raises(InputError, match="none of this trial"):
        prepared(A=FD).show("C")


def test_a_closed_stage_shows_nothing() -> None:
    stage = prepared(A=FD)
    stage.close()
    stage.close()
    with pytest.raises(DeviceError, match="closed"):
        stage.show("A")

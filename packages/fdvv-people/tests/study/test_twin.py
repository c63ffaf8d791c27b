"""Labels under a person's hand: led, seen, heard, judged; nothing tells them apart but pressing them."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import DeviceError, InputError
from fdvv.protocol.tables import Fault
from fdvv_people.study.plan.plan import Stimulus
from fdvv_people.study.stimulus.renderer import stimulus_model
from fdvv_people.study.stimulus.twin import PersonFrame, TwinRenderer, within_reach
from fdvv_studio.live.binary_finger import BinaryFinger
from fdvv_studio.live.press import LivePress
from fdvv_studio.live.press_subject import model_subject
from fdvv_studio.live.run import FRESH_s
from tests.support.campaign import campaign

FD = Stimulus(name="FD", button="mx-clear", rendered="FD")
FDVV = Stimulus(name="FDVV", button="mx-clear")
HAND = BinaryFinger.of(model_subject(stimulus_model(FDVV, Path())))


class Screen:
    """Collects frames and lines, and waits for what is to come."""

    def __init__(self) -> None:
        self.frames: list[PersonFrame] = []
        self.lines: list[str] = []
        self._more = threading.Condition()

    def show(self, frame: PersonFrame) -> None:
        with self._more:
            self.frames.append(frame)
            self._more.notify_all()

    def failed(self, line: str) -> None:
        with self._more:
            self.lines.append(line)
            self._more.notify_all()

    def wait_for(self, found: Callable[[], object]) -> None:
        with self._more:
            assert self._more.wait_for(lambda: bool(found()), timeout=20.0)

    def deep(self, place_mm: float) -> bool:
        return bool(self.frames) and bool(self.frames[-1].displacement_mm[-1] > place_mm)

    @property
    def pressed(self) -> int:
        return sum(frame.pressed for frame in self.frames)


@pytest.fixture
def screen() -> Screen:
    return Screen()


@pytest.fixture
def stage(screen: Screen) -> Iterator[TwinRenderer]:
    made = TwinRenderer(Path(), screen.show, screen.failed, switch_s=0.05, silent_s=60.0)
    made.prepare({"B": FD, "A": FDVV})
    yield made
    made.close()


def press(stage: TwinRenderer, screen: Screen) -> None:
    """Press to the bottom and let go, once."""
    before = screen.pressed
    HAND.down(stage)  # type: ignore[arg-type]
    screen.wait_for(lambda: screen.deep(3.9))
    HAND.up(stage)  # type: ignore[arg-type]
    screen.wait_for(lambda: screen.pressed > before)


def test_the_hand_presses_the_label_that_is_shown_and_each_press_is_judged(
    stage: TwinRenderer, screen: Screen
) -> None:
    for label in ("A", "B"):
        stage.show(label)
        press(stage, screen)
    press(stage, screen)
    stage.close()
    a, b = stage.rendered()
    assert [(one.label, one.stimulus, one.presses) for one in (a, b)] == [("A", "FDVV", 1), ("B", "FD", 2)]
    assert all(error is not None and error < 8 for error in (*a.error_cN, *b.error_cN))
    assert (a.vibrations, b.vibrations) == (2, 0)
    assert {frame.label for frame in screen.frames} == {"A", "B"}


def test_a_screen_receives_travel_key_and_sound_and_nothing_else(stage: TwinRenderer, screen: Screen) -> None:
    stage.show("A")
    press(stage, screen)
    names = {"label", "t_s", "displacement_mm", "key", "clicks", "pressed", "sequence", "dropped_s"}
    assert {field.name for field in fields(PersonFrame)} == names
    t = np.concatenate([frame.t_s for frame in screen.frames])
    assert (np.diff(t) > 0).all()
    assert max(frame.key for frame in screen.frames) == 1
    clicks = [click for frame in screen.frames for click in frame.clicks]
    assert [stage.sounds[click.sound].duration_s for click in clicks] == [0.016, 0.016]


def test_a_label_that_nobody_presses_is_shown_on_whatever_it_hides(
    stage: TwinRenderer, screen: Screen
) -> None:
    stage.show("A")
    screen.wait_for(lambda: screen.frames)
    begun_s = screen.frames[0].t_s[0]
    screen.wait_for(lambda: screen.frames[-1].t_s[-1] > begun_s + FRESH_s + 0.3)


def test_what_is_known_before_a_press_is_the_same_whichever_label_hides_what() -> None:
    known = []
    for labels in ({"A": FD, "B": FDVV}, {"A": FDVV, "B": FD}):
        stage = TwinRenderer(Path(), lambda _frame: None)
        stage.prepare(labels)
        known.append((stage.travel_mm, stage.sounds, stage.problem))
        stage.close()
    assert known[0] == known[1]


def test_while_labels_change_the_hand_moves_nothing_and_the_screen_shows_nothing(screen: Screen) -> None:
    slept: list[float] = []

    def sleep(time_s: float) -> None:
        if not slept:
            time.sleep(0.03)  # a frame that was on its way is there by now
            screen.frames.clear()
            HAND.down(stage)  # type: ignore[arg-type]
        slept.append(time_s)
        time.sleep(time_s)
        shown.append(len(screen.frames))

    shown: list[int] = []
    stage = TwinRenderer(Path(), screen.show, switch_s=0.1, sleep=sleep, silent_s=60.0)
    stage.prepare({"A": FD, "B": FDVV})
    stage.show("A")
    press(stage, screen)
    slept.clear()
    shown.clear()
    stage.show("B")
    assert shown[0] == 0
    screen.wait_for(lambda: screen.frames)
    assert screen.frames[-1].displacement_mm.max() < 0.2, "the key that was held did not press"
    stage.close()


@pytest.mark.parametrize("fault", [Fault.POSITION_STUCK, Fault.VIBRATION_BOARD])
def test_a_fault_ends_force_and_stage_in_one_line_and_is_kept(
    stage: TwinRenderer, screen: Screen, fault: Fault
) -> None:
    stage.show("A")
    HAND.down(stage)  # type: ignore[arg-type]
    screen.wait_for(lambda: screen.deep(1.0))
    assert stage._run is not None
    stage._run.ask(lambda press: press.fail(fault))
    screen.wait_for(lambda: screen.lines)
    assert fault.name.lower() in stage.problem
    with pytest.raises(DeviceError, match=fault.name.lower()) as caught:
        stage.show("B")
    assert "\n" not in str(caught.value)
    assert not any(letter.isdigit() for letter in str(caught.value)), "a force could tell what was rendered"
    assert screen.lines == [stage.problem]
    assert stage.rendered()[0].faults == (fault.name.lower(),)
    assert not stage.rendered()[1].faults


@campaign("button", ["mx-clear", "mx-blue", "rubber-dome"], part=1)
def test_no_hand_however_wild_makes_the_rig_fail(button: str) -> None:
    """As far, as fast and as hard as a page may say; without real time."""
    of = Stimulus(name="FDVV", button=button)
    press = LivePress(model_subject(stimulus_model(of, Path())), 0)
    random = np.random.default_rng(1)
    for _ in range(100):
        asked = random.uniform(-30.0, 30.0), random.uniform(-9000.0, 9000.0), random.uniform(1.0, 1000.0)
        if random.random() < 0.2:
            press.push(float(random.uniform(0.0, 400.0)))
        else:
            press.lead(*within_reach(press.subject.travel_mm, *asked))
        press.advance(float(random.uniform(0.004, 0.03)))
    assert press.fault().fault is Fault.NONE


def test_a_label_that_is_none_is_refused_and_a_closed_stage_shows_nothing(stage: TwinRenderer) -> None:
    with pytest.raises(InputError, match="none of this trial"):
        stage.show("C")
    stage.close()
    stage.close()
    with pytest.raises(DeviceError, match="closed"):
        stage.show("A")

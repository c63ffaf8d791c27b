"""Real pace: nothing runs unseen, nothing is made up for in a burst."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from fdvv.errors import DeviceError
from fdvv.model.file import load_builtin
from fdvv.program.library import MAKERS, load_shipped
from fdvv.protocol.tables import Mode
from fdvv_studio.live.press import LiveEventKind, LivePress
from fdvv_studio.live.press_subject import PressSubject, model_subject, program_subject
from fdvv_studio.live.press_trace import PressTrace
from fdvv_studio.live.run import LiveFrame, LiveRun, RealTimeClock, stirs


class Seen:
    """Collects frames and lines, and waits for what is to come."""

    def __init__(self) -> None:
        self.frames: list[LiveFrame] = []
        self.lines: list[str] = []
        self._more = threading.Condition()

    def show(self, frame: LiveFrame) -> None:
        with self._more:
            self.frames.append(frame)
            self._more.notify_all()

    def add_line(self, line: str) -> None:
        with self._more:
            self.lines.append(line)
            self._more.notify_all()

    def wait_for(self, found: Callable[[], object]) -> None:
        with self._more:
            assert self._more.wait_for(lambda: bool(found()), timeout=20.0)

    @property
    def kinds(self) -> list[LiveEventKind]:
        return [event.kind for frame in self.frames for event in frame.events]

    def wait_until_still(self) -> float:
        """Wait until no frame has come for 0.3 s; return the simulated time of the last tick."""
        count, pause = -1, threading.Event()
        while count != len(self.frames):
            count = len(self.frames)
            pause.wait(0.3)
        return float(self.frames[-1].columns.t_s[-1])


def start_run(
    silent_s: float = 60.0, rest_after_s: float = math.inf, subject: PressSubject | None = None
) -> tuple[Seen, LiveRun]:
    press, seen = LivePress(subject or model_subject(load_builtin("mx-clear"))), Seen()
    show, line = seen.show, seen.add_line
    return seen, LiveRun(press, show, line, line, silent_s=silent_s, rest_after_s=rest_after_s)


def test_time_that_cannot_be_kept_up_with_is_dropped_and_counted() -> None:
    times = iter([0.0, 0.01, 0.02, 0.52, 0.53])
    pace = RealTimeClock(lambda: next(times))
    found = [pace.due() for _ in range(5)]
    assert np.array(found) == pytest.approx(
        np.array([(0.0, 0.0), (0.01, 0.0), (0.01, 0.0), (0.1, 0.4), (0.01, 0.0)])
    )


def test_a_run_goes_on_at_real_pace_and_tells_back_what_led_it() -> None:
    start = time.monotonic()
    seen, run = start_run()
    run.ask(lambda press: press.lead(8.0), 17)
    seen.wait_for(lambda: LiveEventKind.ACTUATION in seen.kinds)
    run.ask(LivePress.lift, 18)
    seen.wait_for(lambda: LiveEventKind.PRESSED in seen.kinds)
    run.close()
    passed_s = time.monotonic() - start
    last = seen.frames[-1]
    assert last.sequence == 18
    assert [frame.sequence for frame in seen.frames] == sorted(frame.sequence for frame in seen.frames)
    simulated_s = last.columns.t_s[-1] + last.dropped_s
    assert simulated_s <= passed_s
    t = np.concatenate([frame.columns.t_s for frame in seen.frames])
    assert np.diff(t) == pytest.approx(np.full(t.size - 1, 1e-4)), "no tick is missing between frames"


@pytest.mark.clock
def test_simulated_time_and_what_a_frame_adds_make_the_time_of_the_clock() -> None:
    asked = [0.0]

    def late(press: LivePress) -> None:
        asked[0] = press.time_s
        time.sleep(0.3)  # three times what is made up for: 0.2 s are dropped
        press.lead(8.0)

    seen, run = start_run()
    seen.wait_for(lambda: seen.frames)
    began_s = time.monotonic()
    run.ask(late)
    seen.wait_for(lambda: LiveEventKind.ACTUATION in seen.kinds)
    ended_s = time.monotonic()
    run.close()
    first = seen.frames[0]
    assert began_s - 0.05 < first.columns.t_s[-1] + first.zero_s < began_s
    last = next(f for f in seen.frames if LiveEventKind.ACTUATION in [e.kind for e in f.events])
    pressed_s = next(e.t_s for e in last.events if e.kind is LiveEventKind.ACTUATION) + last.zero_s
    # what is made up for, 0.1 s, counts as the last before the clock was read
    assert began_s + 0.2 < pressed_s < ended_s
    assert last.zero_s - first.zero_s == pytest.approx(last.dropped_s - first.dropped_s, abs=1e-9)


@pytest.mark.clock
def test_a_page_that_says_nothing_is_not_simulated_for_and_its_finger_is_lifted() -> None:
    seen, run = start_run(silent_s=0.2)
    run.ask(lambda press: press.lead(8.0))
    seen.wait_for(lambda: LiveEventKind.ACTUATION in seen.kinds)
    last_s = seen.frames[-1].columns.t_s[-1]
    stopped = threading.Event()
    while not stopped.wait(0.3):  # until no frame has come in so long
        if seen.frames[-1].columns.t_s[-1] == last_s:
            stopped.set()
        last_s = seen.frames[-1].columns.t_s[-1]
    run.here()
    seen.wait_for(lambda: LiveEventKind.PRESSED in seen.kinds)
    run.close()
    resumed = next(frame for frame in seen.frames if frame.columns.t_s[0] > last_s)
    assert resumed.columns.t_s[0] - last_s < 0.01, "the pause was not simulated"
    assert resumed.dropped_s == seen.frames[0].dropped_s or resumed.dropped_s < 0.2


def test_a_pause_lasts_until_the_page_is_seen_again() -> None:
    seen, run = start_run()
    seen.wait_for(lambda: seen.frames)
    run.pause()
    run.here()
    count = len(seen.frames)
    seen.wait_for(lambda: len(seen.frames) > count)
    run.close()


def test_an_impossible_request_is_reported_and_the_rest_goes_on() -> None:
    def impossible(_press: LivePress) -> None:
        raise DeviceError("it cannot be done")

    seen, run = start_run()
    run.ask(impossible)
    seen.wait_for(lambda: seen.lines)
    count = len(seen.frames)
    seen.wait_for(lambda: len(seen.frames) > count)
    run.close()
    assert seen.lines == ["it cannot be done"]


@pytest.mark.clock
def test_where_nothing_goes_on_time_stops_until_something_is_asked() -> None:
    began_s = time.monotonic()
    seen, run = start_run(rest_after_s=0.2)
    run.ask(lambda press: press.lead(-0.3))  # above the cap
    seen.wait_for(lambda: seen.frames)
    last_s = seen.wait_until_still()
    count, before = len(seen.frames), seen.frames[-1]
    run.here()
    time.sleep(0.2)
    assert len(seen.frames) == count, "a page that watches is no reason to go on"
    run.ask(lambda press: press.lead(8.0), 5)
    seen.wait_for(lambda: LiveEventKind.ACTUATION in seen.kinds)
    run.close()
    passed_s = time.monotonic() - began_s
    first = next(frame for frame in seen.frames[count:] if frame.columns.t_s.size)
    assert first.columns.t_s[0] - last_s == pytest.approx(1e-4), "the rest was not simulated"
    assert first.columns.finger_mm[0] == pytest.approx(before.columns.finger_mm[-1], abs=0.05), "no jump"
    assert first.dropped_s == before.dropped_s, "it was not too slow either"
    assert 0.2 < first.zero_s - before.zero_s < passed_s, "simulated time still makes a time of the clock"
    assert first.sequence in (0, 5)
    assert seen.frames[-1].sequence == 5


def test_a_finger_that_holds_the_cap_is_simulated_on() -> None:
    seen, run = start_run(rest_after_s=0.2)
    run.ask(lambda press: press.lead(8.0))
    seen.wait_for(lambda: LiveEventKind.ACTUATION in seen.kinds)
    held_s = seen.frames[-1].columns.t_s[-1]
    seen.wait_for(lambda: seen.frames[-1].columns.t_s[-1] > held_s + 0.6)
    run.close()


@pytest.mark.clock
def test_a_trace_is_replayed_to_its_end_and_then_time_stops() -> None:
    seen, run = start_run(rest_after_s=0.2)
    time_s = np.linspace(0.0, 1.6, 161)
    late = PressTrace("late", "", time_s, np.where(time_s > 1.2, 3.0, 0.0))
    run.ask(lambda press: press.replay(late))
    seen.wait_for(lambda: LiveEventKind.PRESSED in seen.kinds)
    assert seen.wait_until_still() > 1.6
    run.close()


@pytest.mark.clock
def test_a_rest_that_a_hidden_page_ends_lifts_the_finger() -> None:
    seen, run = start_run(rest_after_s=0.2)
    run.ask(lambda press: press.lead(-0.3))
    seen.wait_for(lambda: seen.frames)
    last_s = seen.wait_until_still()
    run.pause()
    time.sleep(0.2)
    run.here()
    seen.wait_for(lambda: seen.frames[-1].columns.t_s[-1] > last_s + 0.1)
    run.close()
    assert seen.frames[-1].columns.finger_mm[-1] < -1.0


def test_a_program_that_acts_by_time_alone_never_rests() -> None:
    seen, run = start_run(rest_after_s=0.2, subject=program_subject(load_shipped("returning-later")))
    seen.wait_for(lambda: seen.frames and seen.frames[-1].columns.t_s[-1] > 0.8)
    run.close()


def test_programs_that_act_by_time_alone_are_known() -> None:
    timed = {name for name in MAKERS if program_subject(load_shipped(name)).has_timers}
    assert timed == {"dwell-ticks", "fast-tapping", "returning-later"}
    assert not model_subject(load_builtin("mx-clear")).has_timers


def test_a_coil_that_cools_is_simulated_until_the_whole_force_is_back() -> None:
    press = LivePress(model_subject(load_builtin("mx-clear")))
    columns, _ = press.advance(0.02)
    still = LiveFrame(columns, (), 0, 0.0, 0.0, 0.0)
    warm = replace(still, columns=replace(columns, mode=np.full_like(columns.mode, Mode.DERATED)))
    assert (stirs(still), stirs(warm)) == (False, True)


@pytest.mark.clock
def test_a_press_that_nobody_has_touched_rests_sooner() -> None:
    seen, run = start_run(rest_after_s=3600.0)
    seen.wait_for(lambda: seen.frames)
    seen.wait_until_still()
    run.here()
    run.ask(lambda press: press.lead(8.0))
    seen.wait_for(lambda: LiveEventKind.ACTUATION in seen.kinds)
    run.close()

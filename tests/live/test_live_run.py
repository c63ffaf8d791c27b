"""Real pace: nothing runs unseen, nothing is made up for in a burst."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

import numpy as np
import pytest

from fdvv.errors import DeviceError
from fdvv.live.press import LiveEventKind, LivePress
from fdvv.live.press_subject import model_subject
from fdvv.live.run import LiveFrame, LiveRun, RealTimeClock
from fdvv.model.file import load_builtin


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


def start_run(seen: Seen, silent_s: float = 60.0) -> LiveRun:
    press = LivePress(model_subject(load_builtin("mx-clear")))
    return LiveRun(press, seen.show, seen.add_line, seen.add_line, silent_s=silent_s)


def test_time_that_cannot_be_kept_up_with_is_dropped_and_counted() -> None:
    times = iter([0.0, 0.01, 0.02, 0.52, 0.53])
    pace = RealTimeClock(lambda: next(times))
    found = [pace.due() for _ in range(5)]
    assert np.array(found) == pytest.approx(
        np.array([(0.0, 0.0), (0.01, 0.0), (0.01, 0.0), (0.1, 0.4), (0.01, 0.0)])
    )


def test_a_run_goes_on_at_real_pace_and_tells_back_what_led_it() -> None:
    seen, start = Seen(), time.monotonic()
    run = start_run(seen)
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


def test_simulated_time_and_what_a_frame_adds_make_the_time_of_the_clock() -> None:
    seen, asked = Seen(), [0.0]

    def late(press: LivePress) -> None:
        asked[0] = press.time_s
        time.sleep(0.3)  # three times what is made up for: 0.2 s are dropped
        press.lead(8.0)

    run = start_run(seen)
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


def test_a_page_that_says_nothing_is_not_simulated_for_and_its_finger_is_lifted() -> None:
    seen = Seen()
    run = start_run(seen, silent_s=0.2)
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
    seen = Seen()
    run = start_run(seen)
    seen.wait_for(lambda: seen.frames)
    run.pause()
    run.here()
    count = len(seen.frames)
    seen.wait_for(lambda: len(seen.frames) > count)
    run.close()


def test_an_impossible_request_is_reported_and_the_rest_goes_on() -> None:
    def impossible(_press: LivePress) -> None:
        raise DeviceError("it cannot be done")

    seen = Seen()
    run = start_run(seen)
    run.ask(impossible)
    seen.wait_for(lambda: seen.lines)
    count = len(seen.frames)
    seen.wait_for(lambda: len(seen.frames) > count)
    run.close()
    assert seen.lines == ["it cannot be done"]

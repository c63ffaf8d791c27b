"""A live press in real time, in a thread of its own, shown as frames."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from threading import Condition, Thread

import numpy as np

from fdvv.errors import FdvvError
from fdvv.protocol.tables import Mode
from fdvv.twin.interactive import InteractiveTicks
from fdvv_studio.live.press import LiveEvent, LivePress

LONGEST_s = 0.1
"""Longest time simulated at once: more would be motion without input; it is dropped and reported."""


class RealTimeClock:
    """Paces simulated time by a monotonic clock (s).

    last_s : the clock as due() read it last; None before.
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self.last_s: float | None = None

    def due(self) -> tuple[float, float]:
        """Return the time due since the last call, and the time dropped; zeros at first."""
        now_s = self._clock()
        passed_s = 0.0 if self.last_s is None else now_s - self.last_s
        self.last_s = now_s
        due_s = min(passed_s, LONGEST_s)
        return due_s, passed_s - due_s


STEP_s = 0.004
"""Step of the simulation; input takes effect with the next one."""

FRAME_s = 1 / 60  # the refresh of a usual display: it shows no more pictures

REST_AFTER_s = 5.0
"""Time stops where nothing happened for so long; pictures of the last seconds show nothing either."""

FRESH_s = 1.0
"""The same of a press that nobody has touched yet: no picture shows a past."""

STILL_mm = 0.02
"""A cap that moves by less in a frame is not seen to move."""

SILENT_s = 3.0
"""A page that is silent for this long is taken as closed."""


@dataclass(frozen=True, eq=False)
class LiveFrame:
    """What happened since the last frame, simulated.

    Attributes
    ----------
    columns, events : of that time.
    sequence : number of the last lead that had taken effect before its last tick.
    dropped_s : real time not simulated since the run began, because this machine was too slow.
    busy_ratio : part of real time that simulation took since the last frame.
    zero_s : the clock at simulated time 0, as of the last tick; dropped time advances it. A
        simulated time and this make a time of the run's clock.
    """

    columns: InteractiveTicks
    events: tuple[LiveEvent, ...]
    sequence: int
    dropped_s: float
    busy_ratio: float
    zero_s: float


def stirs(seen: LiveFrame) -> bool:
    """Return whether something went on: an event, a touch, a motion of the cap, cooling before more force."""
    columns = seen.columns
    if seen.events or not columns.t_s.size:
        return bool(seen.events)
    moved = columns.force_cN.any() or np.ptp(columns.displacement_mm) > STILL_mm
    return bool(moved or columns.mode[-1] == Mode.DERATED)


class LiveRun:
    """Runs a live press while a page watches.

    Parameters
    ----------
    press : to be used through this run only, from now on.
    show : called with every frame, in the run's thread.
    refused : called with one line when a request fails; the rest continues.
    failed : called once with one line if the press cannot go on.
    clock : monotonic, s.
    silent_s : a page that is silent for this long is taken as closed.
    rest_after_s : time stops after so long without input, touch, motion and events, after FRESH_s if there
        were none yet.

    It runs until close(), pauses with the finger lifted when no page watches, and resumes with the next
    call. It also stops where nothing goes on, until something is asked: a page that is left open costs
    nothing. A program that does something by time alone never stops. All methods may be called from any
    thread.
    """

    def __init__(
        self,
        press: LivePress,
        show: Callable[[LiveFrame], None],
        refused: Callable[[str], None],
        failed: Callable[[str], None],
        clock: Callable[[], float] = time.monotonic,
        silent_s: float = SILENT_s,
        rest_after_s: float = REST_AFTER_s,
    ) -> None:
        self._press, self._show, self._clock, self._silent_s = press, show, clock, silent_s
        self._rest_after_s = rest_after_s
        self._refused, self._failed = refused, failed
        self._changed = Condition()
        self._requests: list[Callable[[LivePress], None]] = []
        self._sequence, self._over, self._looking = 0, False, True
        self._dropped_s, self._shown_sequence = 0.0, 0
        self._stirred_s = clock() + FRESH_s - rest_after_s
        self._heard_s = clock()
        self._thread = Thread(target=self._run, name="live press", daemon=True)
        self._thread.start()

    def ask(self, work: Callable[[LivePress], None], sequence: int | None = None) -> None:
        """Queue work on the press before its next tick. sequence : number that frames return."""
        with self._changed:
            self._requests.append(work)
            if sequence is not None:
                self._sequence = sequence
            self._hear()

    def here(self) -> None:
        with self._changed:
            self._hear()

    def pause(self) -> None:
        """Lift the finger and stop time until the next call."""
        with self._changed:
            self._looking = False
            self._changed.notify()

    def close(self) -> None:
        """End, and wait for the thread."""
        with self._changed:
            self._over = True
            self._changed.notify()
        self._thread.join()

    def _hear(self) -> None:
        self._heard_s, self._looking = self._clock(), True
        self._changed.notify()

    def _run(self) -> None:
        try:
            while not self._over:
                rests = self._look()
                with self._changed:
                    if rests:
                        self._changed.wait_for(lambda: self._over or self._requests or not self._looking)
                    else:
                        self._changed.wait_for(lambda: self._over or self._looking)
                        self._stirred_s = self._clock()  # the finger is on its way up
        except FdvvError as error:
            self._failed(str(error))
        except Exception:
            self._failed("the live press failed; the studio's terminal tells why")
            raise

    def _look(self) -> bool:
        """Simulate in real time until it rests; without a page, lift the finger. Return whether it rests."""
        pace, gathered = RealTimeClock(self._clock), _Gathered(self._clock())
        rests = False
        while not rests and self._goes_on():
            due_s, lost_s = pace.due()
            self._dropped_s += lost_s
            gathered.led |= self._run_requests()
            began_s = self._clock()
            gathered.take(*self._press.advance(due_s), self._clock() - began_s)
            gathered.zero_s = (pace.last_s or 0.0) - self._press.due_s
            if gathered.due(self._clock()):
                gathered = self._frame(gathered)
                rests = self._rests()
        if gathered.columns:
            self._frame(gathered)
        if not rests:
            self._press.lift()
        return rests

    def _frame(self, gathered: _Gathered) -> _Gathered:
        """Show a frame, and start the next."""
        now_s = self._clock()
        seen = gathered.frame(self._shown_sequence, self._dropped_s, now_s)
        if stirs(seen):
            self._stirred_s = now_s
        self._show(seen)
        return _Gathered(now_s)

    def _rests(self) -> bool:
        busy = self._press.replaying or self._press.subject.has_timers
        return not busy and self._clock() - self._stirred_s > self._rest_after_s

    def _goes_on(self) -> bool:
        """Wait for the next step; return False once no page watches."""
        with self._changed:
            self._changed.wait(STEP_s)
            if self._clock() - self._heard_s > self._silent_s:
                self._looking = False
            return self._looking and not self._over

    def _run_requests(self) -> bool:
        """Do the queued work; return whether there was any."""
        with self._changed:
            requests, self._requests, self._shown_sequence = self._requests, [], self._sequence
        for work in requests:
            try:
                work(self._press)
            except FdvvError as error:
                self._refused(str(error))
        if requests:
            self._stirred_s = self._clock()
        return bool(requests)


class _Gathered:
    """Accumulates the next frame."""

    def __init__(self, now_s: float) -> None:
        self.since_s, self.led, self.zero_s, self._busy_s = now_s, False, 0.0, 0.0
        self.columns: list[InteractiveTicks] = []
        self._events: list[LiveEvent] = []

    def due(self, now_s: float) -> bool:
        """Whether to show it: at once with events, after half a frame with input, else after a frame."""
        waited_s = now_s - self.since_s
        return bool(self._events) or waited_s >= (FRAME_s / 2 if self.led else FRAME_s)

    def take(self, columns: InteractiveTicks, events: tuple[LiveEvent, ...], busy_s: float) -> None:
        self.columns.append(columns)
        self._events += events
        self._busy_s += busy_s

    def frame(self, sequence: int, dropped_s: float, now_s: float) -> LiveFrame:
        columns, events = InteractiveTicks.concatenate(self.columns), tuple(self._events)
        busy_ratio = self._busy_s / max(now_s - self.since_s, 1e-9)
        return LiveFrame(columns, events, sequence, dropped_s, busy_ratio, self.zero_s)

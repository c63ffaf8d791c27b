"""A live press at real pace in a thread of its own, shown as frames."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from threading import Condition, Thread

from fdvv.errors import FdvvError
from fdvv.twin import LedTicks
from fdvv.workflow._live_event import LiveEvent
from fdvv.workflow._live_press import LivePress
from fdvv.workflow._real_pace import RealPace

STEP_s = 0.004
"""The rig goes on so often; what the hand does takes effect with the next one."""
FRAME_s = 1 / 60
SILENT_s = 3.0
"""A page that says nothing for so long looks no more."""


@dataclass(frozen=True, eq=False)
class LiveFrame:
    """What happened since the last frame, simulated.

    Attributes
    ----------
    columns, events : of that time.
    sequence : number of the last lead that had taken effect before its last tick.
    dropped_s : real time that was not simulated since the run began, for this machine was too slow.
    busy_ratio : part of real time that simulating took, lately.
    zero_s : the clock when simulated time was 0, as of the last tick; time that is dropped moves it on. A
        simulated time and this make a time of the run's clock.
    """

    columns: LedTicks
    events: tuple[LiveEvent, ...]
    sequence: int
    dropped_s: float
    busy_ratio: float
    zero_s: float


class LiveRun:
    """Runs a live press while somebody looks.

    Parameters
    ----------
    press : to be used through this run only, from now on.
    show : called with every frame, in the run's thread.
    refused : called with one line when something asked for cannot be done; the rest goes on.
    failed : called once with one line if the press cannot go on.
    clock : monotonic, s.
    silent_s : a page that says nothing for so long looks no more.

    It runs until close(), pauses with the finger lifted when nobody looks, and goes on with the next thing
    that is heard. All methods may be called from any thread.
    """

    def __init__(
        self,
        press: LivePress,
        show: Callable[[LiveFrame], None],
        refused: Callable[[str], None],
        failed: Callable[[str], None],
        clock: Callable[[], float] = time.monotonic,
        silent_s: float = SILENT_s,
    ) -> None:
        self._press, self._show, self._clock, self._silent_s = press, show, clock, silent_s
        self._refused, self._failed = refused, failed
        self._changed = Condition()
        self._asked: list[Callable[[LivePress], None]] = []
        self._sequence, self._over, self._looking = 0, False, True
        self._dropped_s, self._shown_sequence = 0.0, 0
        self._heard_s = clock()
        self._thread = Thread(target=self._run, name="live press", daemon=True)
        self._thread.start()

    def ask(self, work: Callable[[LivePress], None], sequence: int | None = None) -> None:
        """Have something done to the press before its next tick. sequence : number that frames tell back."""
        with self._changed:
            self._asked.append(work)
            if sequence is not None:
                self._sequence = sequence
            self._hear()

    def here(self) -> None:
        """Somebody looks."""
        with self._changed:
            self._hear()

    def pause(self) -> None:
        """Nobody looks: lift the finger and let no time pass until something is heard."""
        with self._changed:
            self._looking = False
            self._changed.notify()

    def close(self) -> None:
        """End; waits until the thread has."""
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
                self._look()
                self._wait_for_someone()
        except FdvvError as error:
            self._failed(str(error))
        except Exception:
            self._failed("the live press failed; the studio's terminal tells why")
            raise

    def _wait_for_someone(self) -> None:
        with self._changed:
            self._changed.wait_for(lambda: self._over or self._looking)

    def _look(self) -> None:
        """Simulate at real pace while somebody looks; then lift the finger."""
        pace, gathered = RealPace(self._clock), _Gathered(self._clock())
        while self._goes_on():
            due_s, lost_s = pace.due()
            self._dropped_s += lost_s
            gathered.led |= self._do_asked()
            began_s = self._clock()
            gathered.take(*self._press.advance(due_s), self._clock() - began_s)
            gathered.zero_s = pace.last_s - self._press.due_s
            if gathered.due(self._clock()):
                gathered = self._frame(gathered)
        if not gathered.empty:
            self._frame(gathered)
        self._press.lift()

    def _frame(self, gathered: _Gathered) -> _Gathered:
        """Show a frame, and begin to gather the next."""
        now_s = self._clock()
        self._show(gathered.frame(self._shown_sequence, self._dropped_s, now_s))
        return _Gathered(now_s)

    def _goes_on(self) -> bool:
        """Wait for the next step; False once nobody looks."""
        with self._changed:
            self._changed.wait(STEP_s)
            if self._clock() - self._heard_s > self._silent_s:
                self._looking = False
            return self._looking and not self._over

    def _do_asked(self) -> bool:
        """Do what was asked for; tell whether anything was."""
        with self._changed:
            asked, self._asked, self._shown_sequence = self._asked, [], self._sequence
        for work in asked:
            try:
                work(self._press)
            except FdvvError as error:
                self._refused(str(error))
        return bool(asked)


class _Gathered:
    """What is gathered for the next frame."""

    def __init__(self, now_s: float) -> None:
        self.since_s, self.led, self.zero_s = now_s, False, 0.0
        self._columns: list[LedTicks] = []
        self._events: list[LiveEvent] = []
        self._busy_s = 0.0

    def due(self, now_s: float) -> bool:
        """Whether to show it: at once what happened, sooner what the hand did than what goes on by itself."""
        waited_s = now_s - self.since_s
        return bool(self._events) or waited_s >= (FRAME_s / 2 if self.led else FRAME_s)

    @property
    def empty(self) -> bool:
        return not self._columns

    def take(self, columns: LedTicks, events: tuple[LiveEvent, ...], busy_s: float) -> None:
        self._columns.append(columns)
        self._events += events
        self._busy_s += busy_s

    def frame(self, sequence: int, dropped_s: float, now_s: float) -> LiveFrame:
        ratio = self._busy_s / max(now_s - self.since_s, 1e-9)
        return LiveFrame(
            LedTicks.joined(self._columns), tuple(self._events), sequence, dropped_s, ratio, self.zero_s
        )

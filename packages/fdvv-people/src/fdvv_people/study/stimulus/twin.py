"""Labels pressed by a person in the browser, on the twin in real time."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fdvv.program.program import Signal
from fdvv.twin.plant import NEAR_1_s
from fdvv.units import FloatArray
from fdvv_people.study.plan.plan import Stimulus
from fdvv_people.study.stimulus.renderer import ConstantTimeSwitch, PreparedStimulus, TwinLabels, check_label
from fdvv_studio.live.press import LiveEventKind, LivePress
from fdvv_studio.live.press_subject import TABLES_RIG
from fdvv_studio.live.run import LiveFrame, LiveRun, SILENT_s

ROW_s = 0.001
"""Interval of the rows that a screen is sent."""

BEYOND_mm, LIFTED_mm, PUSH_cN = 10.0, 3.0, 400.0
FASTEST_mm_s, NEAREST_1_s = 500.0, 200.0
"""What a hand may do with every label alike, whatever a page says. From twice the speed on the cap bounces
faster than the firmware believes of a cap, and it falls to zero force."""


@dataclass(frozen=True)
class PersonClick:
    """A vibration that starts, at a time of its frame. sound : its place among the trial's sounds."""

    t_s: float
    sound: int
    velocity_mm_s: float


@dataclass(frozen=True, eq=False)
class PersonFrame:
    """What happened since the last frame. Simulated.

    Attributes
    ----------
    label : that is under the hand.
    t_s, displacement_mm : (n,) of the cap, every millisecond; seconds since the renderer was opened.
    key : level that is down, 0: up. clicks : vibrations to be heard. pressed : presses that ended.
    sequence : number of the last lead that had taken effect. dropped_s : real time that was not simulated.
    """

    label: str
    t_s: FloatArray
    displacement_mm: FloatArray
    key: int
    clicks: tuple[PersonClick, ...]
    pressed: int
    sequence: int
    dropped_s: float


class TrialSounds:
    """The vibrations of all labels of a trial in one list, whose order reveals nothing.

    Attributes
    ----------
    signals : each once, sorted by what they sound like; clicks name them by place.
    """

    def __init__(self, of: Iterable[PreparedStimulus] = ()) -> None:
        shared = {_sound(signal): signal for one in of for signal in one.subject.signals}
        self.signals: tuple[Signal, ...] = tuple(shared[key] for key in sorted(shared, key=repr))
        self._places: Mapping[object, int] = {_sound(one): place for place, one in enumerate(self.signals)}

    def place(self, signal: Signal) -> int:
        return self._places[_sound(signal)]


def _sound(signal: Signal) -> tuple[float, tuple[object, ...]]:
    return signal.duration_s, signal.modes


class TwinRenderer(TwinLabels):
    """A simulated rig that a participant presses in the browser. Simulated.

    Parameters
    ----------
    folder : of the study, where its files are.
    show : called with every frame for the participant's screen, from a thread of the renderer.
    failed : called once with one line when the rig has fallen to zero force.
    switch_s : every change of labels takes as long. rig_name, seed : see TwinLabels.
    clock, sleep : of time. silent_s : a page that says nothing for so long looks no more.

    While a change goes on the finger is lifted and no frame is shown. Any thread may lead the hand; the rest
    is for one thread at a time, and not for the one that frames come from.
    """

    def __init__(
        self,
        folder: Path,
        show: Callable[[PersonFrame], None],
        failed: Callable[[str], None] = lambda _line: None,
        switch_s: float = 0.6,
        rig_name: str = TABLES_RIG,
        seed: int = 0,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
        silent_s: float = SILENT_s,
    ) -> None:
        super().__init__(folder, rig_name, seed)
        self._show, self._failed, self._clock, self._silent_s = show, failed, clock, silent_s
        self._switch, self._sounds = ConstantTimeSwitch(switch_s, clock, sleep), TrialSounds()
        self._run: LiveRun | None = None
        self._label, self._opened_s = "", clock()

    @property
    def travel_mm(self) -> float:
        """The scale of the trial's drawing: the longest travel of its labels, the same for all."""
        return max((one.model.travel_mm for one in self._prepared.values()), default=0.0)

    @property
    def sounds(self) -> tuple[Signal, ...]:
        """The sounds that the clicks of this trial refer to by index."""
        return self._sounds.signals

    # -- what a trial asks for -----------------------------------------------------------------------------

    def prepare(self, labels: Mapping[str, Stimulus]) -> None:
        """Prepare the stimulus of each label, and clear the record; no label is shown."""
        self._check()
        self._put_away()
        self._prepare(labels)
        seeds = self._random.integers(2**31, size=len(labels)).tolist()
        found = zip(self._prepared.items(), seeds, strict=True)
        self._live = {name: LivePress(of.subject, seed) for (name, of), seed in found}
        self._sounds = TrialSounds(self._prepared.values())

    def show(self, label: str) -> None:
        """Put a label under the hand. Raises InputError on another label, DeviceError after a fault."""
        check_label(label, self._prepared)
        self._check()
        self._label = ""
        self.lift()
        self._switch.make(lambda: None, lambda: self._begin(label))
        self._label = label
        self._check()

    def close(self) -> None:
        """Stop the simulation; idempotent."""
        self._put_away()
        self.problem = self.problem or "the renderer is closed; open another"

    # -- what the hand does --------------------------------------------------------------------------------

    def lead(
        self, referent_mm: float, velocity_mm_s: float = 0.0, near_1_s: float = NEAR_1_s, sequence: int = 0
    ) -> None:
        """Lead the finger to a place, as LivePress.lead; nothing happens while labels change."""
        led = within_reach(self.travel_mm, referent_mm, velocity_mm_s, near_1_s)
        self._lead(lambda press: press.lead(*led), sequence)

    def push(self, force_cN: float, sequence: int = 0) -> None:
        self._lead(lambda press: press.push(min(force_cN, PUSH_cN)), sequence)

    def lift(self, sequence: int | None = None) -> None:
        if run := self._run:
            run.ask(LivePress.lift, sequence)

    def here(self) -> None:
        if run := self._run:
            run.here()

    def pause(self) -> None:
        if run := self._run:
            run.pause()

    def _lead(self, work: Callable[[LivePress], None], sequence: int) -> None:
        run = self._run  # another thread may take it away
        if run and self._label and not self.problem:
            run.ask(work, sequence)

    # -- what the rig does ---------------------------------------------------------------------------------

    def _begin(self, label: str) -> None:
        self._put_away()
        press = self._live[label]
        self._announce(press)
        self._evidence[label].cut()
        self._run = LiveRun(
            press,
            lambda seen: self._seen(label, press, seen),
            lambda _line: None,  # a lead that is none moves nothing
            lambda line: self._end(label, line),
            self._clock,
            self._silent_s,
            math.inf,  # when frames come must not say which button it is: some programs could never rest
        )

    def _seen(self, label: str, press: LivePress, seen: LiveFrame) -> None:
        """Record what was rendered and show what may be seen of it; in the run's thread."""
        line = self._keep(label, press, seen.columns, seen.events)
        if line:
            self._tell(line)
        elif self._label == label and seen.columns.t_s.size:
            self._show(self._frame(label, seen))

    def _frame(self, label: str, seen: LiveFrame) -> PersonFrame:
        """Return what a participant may see and hear of a live frame."""
        of, columns, later_s = self._prepared[label], seen.columns, seen.zero_s - self._opened_s
        rows = np.diff(np.floor(columns.t_s / ROW_s + 1e-6), prepend=-1.0) > 0
        rows[-1:] = True
        clicks = tuple(
            PersonClick(e.t_s + later_s, self._sounds.place(of.subject.signals[e.number]), e.velocity_mm_s)
            for e in seen.events
            if e.kind is LiveEventKind.VIBRATION and of.audible
        )
        return PersonFrame(
            label,
            columns.t_s[rows] + later_s,
            columns.displacement_mm[rows],
            int(columns.key[-1]) if columns.key.size else 0,
            clicks,
            sum(e.kind is LiveEventKind.PRESSED for e in seen.events),
            seen.sequence,
            seen.dropped_s,
        )

    def _end(self, label: str, line: str) -> None:
        with self._lock:
            self._evidence[label].failed("diverged")
        self._tell(f"the twin fell to zero force: {line}")

    def _tell(self, line: str) -> None:
        if not self.problem:
            self.problem = line
            self._failed(line)

    def _put_away(self) -> None:
        run, self._run, self._label = self._run, None, ""
        if run:
            run.close()

    def _check(self) -> None:
        if self.problem:
            self._put_away()
        super()._check()


def within_reach(
    travel_mm: float, referent_mm: float, velocity_mm_s: float, near_1_s: float
) -> tuple[float, float, float]:
    """Bound place, speed and rate of a lead to what a hand does."""
    return (
        float(np.clip(referent_mm, -LIFTED_mm, travel_mm + BEYOND_mm)),
        float(np.clip(velocity_mm_s, -FASTEST_mm_s, FASTEST_mm_s)),
        min(near_1_s, NEAREST_1_s),
    )

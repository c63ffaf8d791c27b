"""Labels under a person's hand in the browser, on the twin at real pace."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from pathlib import Path
from threading import Lock

import numpy as np

from fdvv.errors import DeviceError
from fdvv.program import Signal
from fdvv.study import Rendered, Stimulus
from fdvv.twin import NEAR_1_s
from fdvv.workflow._key_hand import KeyHand
from fdvv.workflow._live_event import LiveEventKind
from fdvv.workflow._live_press import LivePress
from fdvv.workflow._live_run import LiveFrame, LiveRun, SILENT_s
from fdvv.workflow._press_subject import PRESS_RIGS
from fdvv.workflow._study_person_frame import PersonFrame, TrialSounds, person_frame
from fdvv.workflow._study_stage import EvenSwitch, check_label
from fdvv.workflow._study_stage_evidence import StageEvidence
from fdvv.workflow._study_stage_subject import StagedStimulus, announce, keep, staged

BEYOND_mm, LIFTED_mm, PUSH_cN = 10.0, 3.0, 400.0
FASTEST_mm_s, NEAREST_1_s = 500.0, 200.0
"""What a hand may do with every label alike, whatever a page says. From twice the speed on the cap bounces
faster than the firmware believes of a cap, and it falls to zero force."""


class PersonStage:
    """What a participant presses in the browser: a simulated rig, led by the hand. Simulated.

    Parameters
    ----------
    folder : of the study, where its files are.
    show : called with every frame for the participant's screen, from a thread of the stage.
    failed : called once with one line when the rig has fallen to zero force.
    switch_s : every change of labels takes as long. rig_name : shipped rig for stimuli with an actuation;
        without one the ideal rig renders. seed : of everything random.
    clock, sleep : of time. silent_s : a page that says nothing for so long looks no more.

    While a change goes on the finger is lifted and no frame is shown. Any thread may lead the hand; the rest
    is for one thread at a time, and not for the one that frames come from.
    """

    simulated, person = True, True

    def __init__(
        self,
        folder: Path,
        show: Callable[[PersonFrame], None],
        failed: Callable[[str], None] = lambda _line: None,
        switch_s: float = 0.6,
        rig_name: str = PRESS_RIGS[0],
        seed: int = 0,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
        silent_s: float = SILENT_s,
    ) -> None:
        self._folder, self._rig_name, self._silent_s = folder, rig_name, silent_s
        self._show, self._failed, self._clock = show, failed, clock
        self._switch, self._random = EvenSwitch(switch_s, clock, sleep), np.random.default_rng(seed)
        self._staged: dict[str, StagedStimulus] = {}
        self._live: dict[str, LivePress] = {}
        self._evidence: dict[str, StageEvidence] = {}
        self._sounds, self._hand = TrialSounds(), KeyHand(0.0)
        self._run: LiveRun | None = None
        self._label, self._fault, self._pace_mm_s = "", "", 0.0
        self._lock, self._opened_s = Lock(), clock()

    @property
    def label(self) -> str:
        """Tell the label under the hand; "" while it changes, and before the first."""
        return self._label

    @property
    def problem(self) -> str:
        """Tell in one line why the stage has ended; "" while it has not."""
        return self._fault

    @property
    def travel_mm(self) -> float:
        """Give the scale of the trial's drawing: the longest travel of its labels, the same for all."""
        return max((one.model.travel_mm for one in self._staged.values()), default=0.0)

    @property
    def sounds(self) -> tuple[Signal, ...]:
        """Give what clicks of this trial name by place."""
        return self._sounds.signals

    def watch(self, show: Callable[[PersonFrame], None]) -> None:
        """Show frames to another screen from now on: the participant's page came back."""
        with self._lock:
            self._show = show

    # -- what a trial asks for -----------------------------------------------------------------------------

    def prepare(self, labels: Mapping[str, Stimulus]) -> None:
        """Make ready what each label hides, and forget what was rendered before; no label is shown."""
        self._check()
        self._put_away()
        found = {name: staged(labels[name], self._folder, self._rig_name) for name in sorted(labels)}
        seeds = self._random.integers(2**31, size=len(found)).tolist()
        self._live = {
            name: LivePress(of.subject, seed) for (name, of), seed in zip(found.items(), seeds, strict=True)
        }
        deepest = max((KeyHand.of(of.subject).bottom_mm for of in found.values()), default=0.0)
        with self._lock:
            self._staged, self._sounds = found, TrialSounds(found.values())
            self._hand = KeyHand(deepest)  # the same for every label
            self._evidence = {n: StageEvidence(n, of.name, of.model) for n, of in found.items()}

    def show(self, label: str) -> None:
        """Put a label under the hand. Raises InputError on another label, DeviceError after a fault."""
        check_label(label, self._staged)
        self._check()
        self._label = ""
        self.lift()
        self._switch.make(lambda: None, lambda: self._begin(label))
        self._label = label
        self._check()

    def rendered(self) -> tuple[Rendered, ...]:
        """Tell what was rendered since prepare(); never fails, so that a fault is kept as well."""
        with self._lock:
            return tuple(found.rendered() for found in self._evidence.values())

    def close(self) -> None:
        """Put the button away."""
        self._put_away()
        self._fault = self._fault or "the stage is closed; open another"

    # -- what the hand does --------------------------------------------------------------------------------

    def lead(
        self, referent_mm: float, velocity_mm_s: float = 0.0, near_1_s: float = NEAR_1_s, sequence: int = 0
    ) -> None:
        """Lead the finger to a place, as LivePress.lead; nothing happens while labels change."""
        led = within_reach(self.travel_mm, referent_mm, velocity_mm_s, near_1_s)
        self._lead(lambda press: press.lead(*led), sequence)

    def push(self, force_cN: float, sequence: int = 0) -> None:
        """Lead the force that the finger pushes with."""
        self._lead(lambda press: press.push(min(force_cN, PUSH_cN)), sequence)

    def down(self, sequence: int = 0) -> None:
        """Press to the bottom, as a key is told to: every time and every label alike."""
        self._lead(self._hand.down, sequence)

    def up(self, sequence: int = 0) -> None:
        """Let go of the key."""
        self._lead(self._hand.up, sequence)

    def lift(self, sequence: int | None = None) -> None:
        """Take the finger off."""
        if run := self._run:
            run.ask(LivePress.lift, sequence)

    def here(self) -> None:
        """Somebody looks."""
        if run := self._run:
            run.here()

    def pause(self) -> None:
        """Nobody looks."""
        if run := self._run:
            run.pause()

    def fail(self, work: Callable[[LivePress], None]) -> None:
        """Have something done to the rig under the hand, to see what becomes of it."""
        if run := self._run:
            run.ask(work)

    def _lead(self, work: Callable[[LivePress], None], sequence: int) -> None:
        run = self._run  # another thread may take it away
        if run and self._label and not self._fault:
            run.ask(work, sequence)

    # -- what the rig does ---------------------------------------------------------------------------------

    def _begin(self, label: str) -> None:
        """Take the label that is there away, and put another under the hand."""
        self._put_away()
        press = self._live[label]
        announce(press, self._pace_mm_s)
        self._evidence[label].cut()
        self._run = LiveRun(
            press,
            lambda seen: self._seen(label, press, seen),
            lambda _line: None,  # a lead that is none moves nothing
            lambda line: self._end(label, line),
            self._clock,
            self._silent_s,
        )

    def _seen(self, label: str, press: LivePress, seen: LiveFrame) -> None:
        """Keep what was rendered and show what may be seen of it; in the run's thread."""
        of = self._staged[label]
        with self._lock:
            line = keep(self._evidence[label], of, press, seen.columns, seen.events)
            show = self._show
        for event in seen.events:
            if event.kind is LiveEventKind.PRESSED:
                self._pace_mm_s = event.velocity_mm_s
        if line:
            self._tell(line)
        elif self._label == label and seen.columns.t_s.size:
            show(person_frame(label, seen, of, self._sounds, self._opened_s))

    def _end(self, label: str, line: str) -> None:
        """The simulation itself cannot go on."""
        with self._lock:
            self._evidence[label].failed("diverged")
        self._tell(f"the twin fell to zero force: {line}")

    def _tell(self, line: str) -> None:
        if not self._fault:
            self._fault = line
            self._failed(line)

    def _put_away(self) -> None:
        run, self._run, self._label = self._run, None, ""
        if run:
            run.close()

    def _check(self) -> None:
        if self._fault:
            self._put_away()
            raise DeviceError(self._fault)


def within_reach(
    travel_mm: float, referent_mm: float, velocity_mm_s: float, near_1_s: float
) -> tuple[float, float, float]:
    """Bound place, speed and rate of a lead to what a hand does."""
    return (
        float(np.clip(referent_mm, -LIFTED_mm, travel_mm + BEYOND_mm)),
        float(np.clip(velocity_mm_s, -FASTEST_mm_s, FASTEST_mm_s)),
        min(near_1_s, NEAREST_1_s),
    )

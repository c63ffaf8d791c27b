"""The guided capture: ask, record, keep, look, ask again; go on where it stopped."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from fdvv.device import CaptureDevice, Cue
from fdvv.errors import DeviceError
from fdvv.recording import Recording, RecordingLog, Stage, Take
from fdvv.workflow._capture_cue import cue_events, cue_length_s
from fdvv.workflow._capture_events import CaptureGuide, PaceStanding, TakeAsk, TakeDone
from fdvv.workflow._capture_look import Verdict, quick_look
from fdvv.workflow._capture_plan import CapturePlan, Outcome, Step, settle
from fdvv.workflow._held_back import held_back

TRAVEL_mm = 4.0
"""Of most switches: what cues show until the button has told its own."""


@dataclass(frozen=True, eq=False)
class CaptureResult:
    """What a capture gave.

    Attributes
    ----------
    path, recording : the file and all that is in it.
    device : name of the bench.
    paces : how it ended for every pace.
    """

    path: Path
    recording: Recording
    device: str
    paces: tuple[PaceStanding, ...]


@dataclass(frozen=True)
class Progress:
    """How far a capture is, from its takes alone: the same after it was stopped as if it never had been.

    Attributes
    ----------
    plan : of the capture.
    outcomes : of its steps, in order.
    judged : step and verdict of every take.
    """

    plan: CapturePlan
    outcomes: tuple[Outcome, ...]
    judged: tuple[tuple[Step, Verdict], ...] = ()

    def after(self, take: Take) -> Progress:
        """Look at a take and count it."""
        step = Step(take.stage, take.velocity_mm_s)
        verdict = quick_look(take, replace(self.plan, travel_mm=self.travel_mm))
        outcomes = settle(self.outcomes, step, verdict.ok, self.plan.repeats)
        return Progress(self.plan, outcomes, (*self.judged, (step, verdict)))

    @property
    def next(self) -> Outcome | None:
        """What to record next, and how often it was tried; None when all is done."""
        return next((outcome for outcome in self.outcomes if not outcome.settled), None)

    @property
    def settled(self) -> int:
        """Count the steps that are done."""
        return sum(outcome.settled for outcome in self.outcomes)

    @property
    def travel_mm(self) -> float | None:
        """Travel as the plan states it, else as the probe told, else the median of good presses."""
        if self.plan.travel_mm is not None:
            return self.plan.travel_mm
        good = [(step, verdict.travel_mm) for step, verdict in self.judged if verdict.ok]
        probed = [mm for step, mm in good if step.stage is Stage.PROBE]
        pressed = [mm for step, mm in good if step.stage is Stage.PRESS]
        return probed[-1] if probed else float(np.median(pressed)) if pressed else None

    def standing(self) -> tuple[PaceStanding, ...]:
        """Tell how far every pace is."""
        return tuple(self._pace(Step(Stage.PRESS, v)) for v in self.plan.paces_mm_s)

    def _pace(self, step: Step) -> PaceStanding:
        assert step.velocity_mm_s is not None
        found = [verdict for other, verdict in self.judged if other == step]
        good = [verdict.achieved_mm_s for verdict in found if verdict.ok]
        known = tuple(speed for speed in good if np.isfinite(speed))
        settled = sum(o.settled for o in self.outcomes if o.step == step)
        missed = max(settled - len(good), 0)
        return PaceStanding(step.velocity_mm_s, len(good), self.plan.presses, len(found), missed, known)


def capture_session(
    device: CaptureDevice,
    path: Path,
    name: str,
    plan: CapturePlan | None = None,
    guide: CaptureGuide | None = None,
) -> CaptureResult:
    """Record a button after the plan, into a new file or one that goes on.

    name : of the button. Every take is on the disk before anything else is done with it, so that a process
    that is killed loses none, and the same call goes on with what is missing.

    Raises InputError on a file of another button, bench or person, DeviceError if the bench fails and
    KeyboardInterrupt on Ctrl-C; the last two say how to go on. OSError if the file cannot be written.
    """
    plan, guide, info = plan or CapturePlan(), guide or CaptureGuide(), device.facts()
    about = Recording(name, bench=info.bench, person=info.person, simulated=info.simulated)
    with RecordingLog(path, about) as log:
        state = Progress(plan, tuple(Outcome(step) for step in plan.steps()))
        for take in log.recording.takes:
            state = state.after(take)
        for text in (*(f"warning: {warning}" for warning in log.warnings), _standing_of(state, log)):
            if text:
                guide.notice(text)
        try:
            state = _recorded(device, state, guide, log)
        except KeyboardInterrupt:
            raise KeyboardInterrupt(f"interrupted; {_how_to_go_on(log)}") from None
        except DeviceError as error:
            raise DeviceError(f"{error}; {_how_to_go_on(log)}") from error
        return CaptureResult(path, log.recording, info.name, state.standing())


def _recorded(device: CaptureDevice, state: Progress, guide: CaptureGuide, log: RecordingLog) -> Progress:
    """Record until nothing is missing."""
    while (wanted := state.next) is not None:
        step, total = wanted.step, len(state.outcomes)
        travel_mm = state.travel_mm or TRAVEL_mm
        again = state.judged[-1][1].reason if wanted.tries else ""
        show = guide.cue(TakeAsk(step, state.settled + 1, total, travel_mm, again))
        length_s = cue_length_s(step.stage, step.velocity_mm_s, travel_mm)
        cue = Cue(length_s, cue_events(step.velocity_mm_s, travel_mm), show)
        take = device.take(log.next_number, step.stage, step.velocity_mm_s, cue)
        with held_back():
            log.add(take)
            state = state.after(take)
        verdict, settled = state.judged[-1][1], state.settled
        missed = not verdict.ok and wanted.tries >= state.plan.repeats
        guide.done(TakeDone(take, verdict, settled, total, missed, state.standing()))
    return state


def _standing_of(state: Progress, log: RecordingLog) -> str:
    """Say that a recording goes on, or was finished already; nothing of a fresh one."""
    if not log.recording.takes:
        return ""
    rest = "goes on" if state.next else "is finished; name another file for a new one"
    return f"{log.path}, with {state.settled} of {len(state.outcomes)} steps, {rest}"


def _how_to_go_on(log: RecordingLog) -> str:
    count = len(log.recording.takes)
    kept = "1 take is" if count == 1 else f"{count} takes are"
    return f"{kept} kept in {log.path}; run the same command again to go on"

"""The guided capture: cue, record, save, check, repeat; it resumes where it stopped."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from fdvv.bench.plan import Outcome, Step, capture_steps, cue_events, cue_length_s, settle
from fdvv.bench.settings import CaptureSettings
from fdvv.bench.take_check import TakeCheck, quick_look
from fdvv.device.bench import CaptureDevice, Cue, show_nothing
from fdvv.errors import DeviceError
from fdvv.io.files import defer_interrupt
from fdvv.recording.log import RecordingLog
from fdvv.recording.types import Recording, Stage, Take


@dataclass(frozen=True)
class TakeRequest:
    """The next take.

    Attributes
    ----------
    step : what to record; number-th of total steps.
    travel_mm : of the button, as far as it is known.
    again : why it is repeated; empty the first time.
    """

    step: Step
    number: int
    total: int
    travel_mm: float
    again: str = ""


@dataclass(frozen=True)
class VelocityProgress:
    """How far the capture is at one velocity.

    Attributes
    ----------
    good, wanted : presses.
    made, missed : takes made at this velocity, and presses given up after all repeats.
    achieved_mm_s : of the good presses with a known speed.
    """

    velocity_mm_s: float
    good: int
    wanted: int
    made: int
    missed: int
    achieved_mm_s: tuple[float, ...] = field(default=(), repr=False)


@dataclass(frozen=True, eq=False)
class TakeDone:
    """A take that is on the disk.

    Attributes
    ----------
    take, check : the take, and whether it can be used.
    done, total : steps settled.
    missed : the take was bad after all repeats, and the session continues without it.
    progress : at every velocity.
    """

    take: Take
    check: TakeCheck
    done: int
    total: int
    missed: bool
    progress: tuple[VelocityProgress, ...]


@dataclass(frozen=True, eq=False)
class CaptureGuide:
    """Callbacks that guide a person through a capture.

    Attributes
    ----------
    cue : called before a take; returns what shows the cue, which is then called with the time.
    done : called after each take, once it is on the disk.
    notice : called with what a person should know.
    """

    cue: Callable[[TakeRequest], Callable[[float], None]] = lambda _ask: show_nothing
    done: Callable[[TakeDone], None] = lambda _done: None
    notice: Callable[[str], None] = lambda _text: None


TRAVEL_mm = 4.0
"""Of most switches: used by cues until the travel is known."""


@dataclass(frozen=True, eq=False)
class CaptureResult:
    """A finished capture.

    Attributes
    ----------
    path, recording : the file and all that is in it.
    device : name of the bench.
    velocities : the result at every velocity.
    """

    path: Path
    recording: Recording
    device: str
    velocities: tuple[VelocityProgress, ...]


@dataclass(frozen=True)
class Progress:
    """How far a capture is, from its takes alone, so that a resumed capture is as one never interrupted.

    Attributes
    ----------
    plan : of the capture.
    outcomes : of its steps, in order.
    judged : step and check of every take.
    """

    plan: CaptureSettings
    outcomes: tuple[Outcome, ...]
    judged: tuple[tuple[Step, TakeCheck], ...] = ()

    def after(self, take: Take) -> Progress:
        step = Step(take.stage, take.velocity_mm_s)
        check = quick_look(take, self.travel_mm, self.plan.pace_ratio)
        outcomes = settle(self.outcomes, step, check.ok, self.plan.repeats)
        return replace(self, outcomes=outcomes, judged=(*self.judged, (step, check)))

    @property
    def next(self) -> Outcome | None:
        """Return the first open step and how often it was tried; None when all is done."""
        return next((outcome for outcome in self.outcomes if not outcome.settled), None)

    @property
    def settled(self) -> int:
        return sum(outcome.settled for outcome in self.outcomes)

    @property
    def travel_mm(self) -> float | None:
        """Return the plan's travel, else the last good probe's, else the median of good presses."""
        if self.plan.travel_mm is not None:
            return self.plan.travel_mm
        good = [(step, check.travel_mm) for step, check in self.judged if check.ok]
        probed = [mm for step, mm in good if step.stage is Stage.PROBE]
        pressed = [mm for step, mm in good if step.stage is Stage.PRESS]
        return probed[-1] if probed else float(np.median(pressed)) if pressed else None

    def by_velocity(self) -> tuple[VelocityProgress, ...]:
        return tuple(self._at_velocity(velocity_mm_s) for velocity_mm_s in self.plan.paces_mm_s)

    def _at_velocity(self, velocity_mm_s: float) -> VelocityProgress:
        step = Step(Stage.PRESS, velocity_mm_s)
        checks = [check for other, check in self.judged if other == step]
        good = [check.achieved_mm_s for check in checks if check.ok]
        known = tuple(speed for speed in good if np.isfinite(speed))
        settled = sum(o.settled for o in self.outcomes if o.step == step)
        missed = max(settled - len(good), 0)
        return VelocityProgress(velocity_mm_s, len(good), self.plan.presses, len(checks), missed, known)


def capture_session(
    device: CaptureDevice,
    path: Path,
    name: str,
    plan: CaptureSettings | None = None,
    guide: CaptureGuide | None = None,
) -> CaptureResult:
    """Record a button by the plan, into a new file or one that is resumed.

    name : of the button. Every take is on the disk before anything else is done with it, so that a process
    that is killed loses none, and the same call resumes with what is missing.

    Raises InputError on a file of another button, bench or person, DeviceError if the bench fails and
    KeyboardInterrupt on Ctrl-C; the last two say how to resume. OSError if the file cannot be written.
    """
    plan, guide, info = plan or CaptureSettings(), guide or CaptureGuide(), device.facts()
    about = Recording(name, bench=info.bench, person=info.person, simulated=info.simulated)
    with RecordingLog(path, about) as log:
        state = Progress(plan, tuple(Outcome(step) for step in capture_steps(plan)))
        for take in log.recording.takes:
            state = state.after(take)
        for text in (*(f"warning: {warning}" for warning in log.warnings), *_resume_notice(state, log)):
            guide.notice(text)
        try:
            state = _record_takes(device, state, guide, log)
        except KeyboardInterrupt:
            raise KeyboardInterrupt(f"interrupted; {_how_to_resume(log)}") from None
        except DeviceError as error:
            raise DeviceError(f"{error}; {_how_to_resume(log)}") from error
        return CaptureResult(path, log.recording, info.name, state.by_velocity())


def _record_takes(device: CaptureDevice, state: Progress, guide: CaptureGuide, log: RecordingLog) -> Progress:
    while (wanted := state.next) is not None:
        step, total = wanted.step, len(state.outcomes)
        travel_mm = state.travel_mm or TRAVEL_mm
        again = state.judged[-1][1].reason if wanted.tries else ""
        show = guide.cue(TakeRequest(step, state.settled + 1, total, travel_mm, again))
        length_s = cue_length_s(step.velocity_mm_s, travel_mm)
        cue = Cue(length_s, cue_events(step.velocity_mm_s, travel_mm), show)
        take = device.take(log.next_number, step.stage, step.velocity_mm_s, cue)
        with defer_interrupt():
            log.add(take)
            state = state.after(take)
        check, settled = state.judged[-1][1], state.settled
        missed = not check.ok and wanted.tries >= state.plan.repeats
        guide.done(TakeDone(take, check, settled, total, missed, state.by_velocity()))
    return state


def _resume_notice(state: Progress, log: RecordingLog) -> list[str]:
    """Describe a recording that is resumed or already finished; nothing for a new one."""
    rest = "goes on" if state.next else "is finished; name another file for a new one"
    text = f"{log.path}, with {state.settled} of {len(state.outcomes)} steps, {rest}"
    return [text] if log.recording.takes else []


def _how_to_resume(log: RecordingLog) -> str:
    count = len(log.recording.takes)
    kept = "1 take is" if count == 1 else f"{count} takes are"
    return f"{kept} kept in {log.path}; run the same command again to go on"

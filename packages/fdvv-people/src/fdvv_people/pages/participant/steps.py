"""What a page of a timing study gets of each step: the page to fill in, the trial, the way it counts."""

from __future__ import annotations

from typing import Literal

from fdvv_people.pages.api.study_steps import StudyForm, step_parts
from fdvv_people.pages.played_trial import Count, PlayStrip, RoundOver, Time, strip_of
from fdvv_people.study.plan.sitting import Step
from fdvv_people.study.timing.events import Surface
from fdvv_people.study.timing.plan import TimingPlan
from fdvv_people.study.timing.schedule import Hand, Phase, TimingFace
from fdvv_studio.studio.api.press_frames import ShakeSignal
from fdvv_studio.studio.contract import Message, message_of

TimingStepKind = Literal["page", "place", "trial", "break", "wait", "done", "declined", "withdrawn"]


class TimingTrial(Message):
    """A trial, and nothing that tells what is under the finger but a switch or key, which anybody sees.

    number : of the person. code : of a trial of the validation, drawn anew for each; "" in training.
    hand : what is under the finger. switch : name of the switch or key on the table. key : the
        `KeyboardEvent.code` that counts, "" of a button that is rendered.
    rounds : of the trial. kept : those that are on the disk already: it goes on. at, of : which of its phase,
        from 1. strip : of temporal pointing, else None. tap_s : how long one taps, else 0.
    """

    number: int
    phase: Phase
    level: str
    code: str
    hand: Hand
    switch: str
    key: str
    rounds: int
    kept: int
    at: int
    of: int
    strip: PlayStrip | None
    tap_s: int


class TimingStepMessage(Message, tag="step"):
    """What comes next. progress_ratio : of the whole session. left_s : of a break, or None.

    trial : of the kinds trial and place. due_at : of the wait, when the person may go on (UTC), else "".
    """

    kind: TimingStepKind
    progress_ratio: float
    form: StudyForm | None = None
    trial: TimingTrial | None = None
    left_s: float | None = None
    due_at: str = ""


class TimingPlaced(Message, tag="placed"):
    """The switch or key of a trial is under the finger: it was pressed once."""

    number: Count


class TimingBegin(Message, tag="begin"):
    """Begin a trial, or go on with it."""

    number: Count


class TimingRound(RoundOver, tag="round"):
    """A round is over: keep it. target_ms : when the target was drawn; None of a second of tapping."""

    target_ms: Time | None


class TimingReady(Message, tag="ready"):
    """What is pressed is there: the rounds begin.

    on : what is pressed. attempt : how often this trial was begun. kept : of its rounds. signals : vibrations
    to be heard, unnamed.
    """

    number: int
    on: Surface
    attempt: int
    kept: int
    rounds: int
    signals: list[ShakeSignal]


class TimingKept(Message, tag="kept"):
    """A round is on the disk. transport_ms : from hand to simulation, taken out; None where there is none.

    finished : it was the trial's last; the next step follows by itself. How well it went is said nowhere.
    """

    number: int
    transport_ms: float | None
    finished: bool


def timing_step_message(plan: TimingPlan, language: str, step: Step[TimingFace]) -> TimingStepMessage:
    """Return a step in a person's language."""
    trial = _trial(plan, step) if step.kind in ("trial", "place") else None
    return message_of(TimingStepMessage, step, **step_parts(plan.pages, language, step), trial=trial)


def _trial(plan: TimingPlan, step: Step[TimingFace]) -> TimingTrial:
    face = step.trial
    strip = None if plan.tapping else strip_of(plan.pointing(face.level))
    tap_s = plan.tap_s if plan.tapping else 0
    of_step = {"rounds": step.rounds, "kept": step.kept, "at": step.at, "of": step.of}
    return message_of(TimingTrial, face, **of_step, strip=strip, tap_s=tap_s)

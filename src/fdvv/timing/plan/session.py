"""The state of a timing session after its events, and the step that is due."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from typing import Any, Literal

from msgspec import Struct, structs

from fdvv.errors import ModelError
from fdvv.study.plan.events import (
    BreakEnded,
    PageAnswered,
    ParticipantWithdrew,
    SessionClosed,
    SessionResumed,
)
from fdvv.study.plan.sitting import SittingState
from fdvv.task.score import Score
from fdvv.timing.plan import events
from fdvv.timing.plan.events import RoundKept, TimingEvent, TimingStarted
from fdvv.timing.plan.plan import DAY_s, TimingPlan
from fdvv.timing.plan.schedule import Hand, Phase, TimingFace

TimingStepKind = Literal["page", "place", "trial", "break", "wait", "done", "declined", "withdrawn"]
"""What a step of a timing session can be."""

ENDS: tuple[TimingStepKind, ...] = ("done", "declined", "withdrawn")
"""Steps after which nothing comes."""


@dataclass(frozen=True)
class TimingState(SittingState):
    """The state of a session that times presses.

    Attributes
    ----------
    designs : of training trials, by number. placed : the trial whose switch is under the hand, or None.
    rounds : all of a trial, by number, those that do not count among them. scores, failed : with skipped the
        trials that are over, by number. trained_s : when the training ended.
    """

    plan: TimingPlan
    started: TimingStarted
    designs: dict[int, events.ButtonDesigned] = field(default_factory=dict)
    placed: int | None = None
    rounds: dict[int, tuple[RoundKept, ...]] = field(default_factory=dict)
    scores: dict[int, dict[str, Score]] = field(default_factory=dict)
    failed: dict[int, str] = field(default_factory=dict)
    trained_s: float | None = None

    def is_over(self, number: int) -> bool:
        """Whether a trial was scored or given up."""
        return number in self.scores or number in self.failed or number in self.skipped

    @property
    def next_trial(self) -> TimingFace | None:
        """The first trial that is not over."""
        return next((trial for trial in self.started.trials if not self.is_over(trial.number)), None)

    @property
    def trials_over(self) -> int:
        return len(self.scores) + len(self.failed) + len(self.skipped)

    @property
    def training_left(self) -> bool:
        """Whether training is due, or over and not yet noted."""
        trial = self.next_trial
        return self.trained_s is None and self.plan.training is not None and trial is not None

    def counting(self, number: int) -> tuple[RoundKept, ...]:
        """Return the rounds of a trial that count.

        A trial of pointing that was broken off goes on, so that all count. Intervals between taps span no
        break: of tapping those since it was begun last.
        """
        found = self.rounds.get(number, ())
        if not self.plan.tapping:
            return found
        return tuple(one for one in found if one.attempt == self.attempts.get(number, 0))

    @property
    def not_before_s(self) -> float | None:
        """Wall time from when the validation may begin; None while training goes on, or where no gap is."""
        return None if self.trained_s is None else self.trained_s + DAY_s * self.plan.gap_days

    def waits(self, now_s: float) -> bool:
        """Whether the gap is not over at a wall time."""
        gap = self.plan.gap_days > 0 and self.not_before_s is not None and now_s < self.not_before_s
        return gap and not self.validated

    @property
    def validated(self) -> bool:
        """Whether a trial of the validation was begun."""
        # once a trial of the validation was begun, a clock that was set back stops nobody
        return any(one.phase == "validation" and one.number in self.attempts for one in self.started.trials)

    def after(self, event: TimingEvent) -> TimingState:
        """Return the state after an event. ModelError where it cannot follow."""
        if self.over:
            raise ModelError(f"the session of {self.started.person} is over")
        if isinstance(event, TimingStarted):
            raise ModelError(f"the session of {self.started.person} has begun already")
        return _AFTER[type(event)](self, event)


def timing_state(plan: TimingPlan, happened: Sequence[TimingEvent]) -> TimingState:
    """Return the state after events. ModelError where one cannot follow the ones before."""
    if not happened or not isinstance(happened[0], TimingStarted):
        raise ModelError("a session begins with its trials")
    state = TimingState(plan, happened[0])
    for event in happened[1:]:
        state = state.after(event)
    return state


def _due_face(state: TimingState, number: int, phase: Phase | None = None) -> TimingFace:
    """Return the trial that is due. ModelError where it is another one."""
    due = state.next_trial
    if due is None or due.number != number or phase not in (None, due.phase):
        raise ModelError(f"trial {number} is not the next one")
    return due


def _designed(state: TimingState, event: events.ButtonDesigned) -> TimingState:
    _due_face(state, event.number, "training")
    if event.number in state.designs:
        raise ModelError(f"trial {event.number} has its design")
    return replace(state, designs={**state.designs, event.number: event})


def _placed(state: TimingState, event: events.SwitchPlaced) -> TimingState:
    if _due_face(state, event.number, "validation").hand == "button":
        raise ModelError(f"trial {event.number} has no switch")
    return replace(state, placed=event.number)


def _begun(state: TimingState, event: events.TimedBegun) -> TimingState:
    due = _due_face(state, event.number)
    attempt = state.attempts.get(event.number, 0) + 1
    if state.break_since_s is not None or state.next_page("consent", "before") or event.attempt != attempt:
        raise ModelError(f"trial {event.number} cannot be begun now")
    unready = event.number not in state.designs if due.phase == "training" else state.waits(event.at_s)
    if unready or (due.hand != "button" and state.placed != event.number):
        raise ModelError(f"trial {event.number} is not ready to be begun")
    since = event.at_s if state.work_since_s is None else state.work_since_s
    return replace(
        state, open=event.number, attempts={**state.attempts, event.number: attempt}, work_since_s=since
    )


def _round(state: TimingState, event: RoundKept) -> TimingState:
    if state.open != event.number or state.attempts[event.number] != event.attempt:
        raise ModelError(f"trial {event.number} is not under way")
    if event.round != len(state.counting(event.number)) + 1 or event.round > state.plan.trial_rounds:
        raise ModelError(f"round {event.round} of trial {event.number} is not the next one")
    kept = (*state.rounds.get(event.number, ()), event)
    return replace(state, rounds={**state.rounds, event.number: kept})


def _ended(state: TimingState, at_s: float) -> TimingState:
    """Return the state between two trials: a break begins where one is due."""
    after = replace(state, open=None, placed=None)
    return replace(after, break_since_s=at_s) if after.break_is_due(at_s) else after


def _scored(state: TimingState, event: events.TimedScored) -> TimingState:
    _due_face(state, event.number)
    if len(state.counting(event.number)) < state.plan.trial_rounds:
        raise ModelError(f"trial {event.number} lacks rounds")
    return _ended(replace(state, scores={**state.scores, event.number: event.scores}), event.at_s)


def _failed(state: TimingState, event: events.DesignFailed) -> TimingState:
    _due_face(state, event.number, "training")
    return _ended(replace(state, failed={**state.failed, event.number: event.reason}), event.at_s)


def _interrupted(state: TimingState, event: events.TimedInterrupted) -> TimingState:
    _due_face(state, event.number)
    falls = {**state.falls, event.number: state.falls.get(event.number, 0) + 1}
    return replace(state, open=None, interruptions=state.interruptions + 1, falls=falls)


def _skipped(state: TimingState, event: events.TimedSkipped) -> TimingState:
    _due_face(state, event.number, "validation")
    return _ended(replace(state, skipped=state.skipped | {event.number}), event.at_s)


def _trained(state: TimingState, event: events.TrainingEnded) -> TimingState:
    due = state.next_trial
    if not state.training_left or due is None or due.phase == "training":
        raise ModelError("the training is not over")
    return replace(state, trained_s=event.at_s, break_since_s=None, work_since_s=None)


def _resumed(state: TimingState, event: SessionResumed) -> TimingState:
    return replace(state.after_return(event), placed=None)


_AFTER: dict[type, Callable[[TimingState, Any], TimingState]] = {
    PageAnswered: TimingState.after_page,
    events.ButtonDesigned: _designed,
    events.SwitchPlaced: _placed,
    events.TimedBegun: _begun,
    RoundKept: _round,
    events.TimedScored: _scored,
    events.DesignFailed: _failed,
    events.TimedInterrupted: _interrupted,
    events.TimedSkipped: _skipped,
    events.TrainingEnded: _trained,
    BreakEnded: TimingState.after_break,
    SessionClosed: lambda state, event: replace(state, left_s=event.at_s, open=None, placed=None),
    SessionResumed: _resumed,
    ParticipantWithdrew: lambda state, _event: replace(state, withdrawn=True, open=None),
}


class TimingStep(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """What is before a participant; nothing in it is secret.

    Attributes
    ----------
    kind : what it is. page : the name of the page.
    number, phase, level, code, hand, switch, key : of the trial, see TimingFace.
    rounds, kept : of the trial, and how many are kept already: more than 0 where it goes on.
    at, of : which it is of its phase, from 1.
    left_s : seconds of the break that are left; 0: the person may go on.
    due_at : when the gap is over (UTC); empty elsewhere. progress : from 0 to 1, of pages and trials.
    """

    kind: TimingStepKind
    page: str = ""
    number: int = -1
    phase: Phase | Literal[""] = ""
    level: str = ""
    code: str = ""
    hand: Hand = "button"
    switch: str = ""
    key: str = ""
    rounds: int = 0
    kept: int = 0
    at: int = 0
    of: int = 0
    left_s: float = 0.0
    due_at: str = ""
    progress: float = 0.0


def next_timing_step(state: TimingState, now_s: float) -> TimingStep:
    """Return the step that is due: pages before, training, gap, validation, breaks, pages after."""
    done, whole = state.trials_over + len(state.pages), len(state.started.trials) + len(state.plan.pages)
    return structs.replace(_due(state, now_s), progress=done / whole if whole else 1.0)


def utc_text(at_s: float) -> str:
    """Return a wall time as people and files write it, to the second."""
    return datetime.fromtimestamp(at_s, UTC).isoformat(timespec="seconds")


def _due(state: TimingState, now_s: float) -> TimingStep:
    if state.over:
        return TimingStep(kind="withdrawn" if state.withdrawn else "declined")
    if page := state.next_page("consent", "before"):
        return TimingStep(kind="page", page=page)
    if state.next_trial is None:
        page = state.next_page("after")
        return TimingStep(kind="page", page=page) if page else TimingStep(kind="done")
    if state.waits(now_s) and state.not_before_s is not None:
        return TimingStep(kind="wait", due_at=utc_text(state.not_before_s))
    left_s = state.break_left_s(now_s)
    if left_s is not None:
        return TimingStep(kind="break", left_s=left_s)
    return _trial_step(state, state.next_trial)


def _trial_step(state: TimingState, trial: TimingFace) -> TimingStep:
    alike = [one for one in state.started.trials if one.phase == trial.phase]
    unplaced = trial.hand != "button" and state.placed != trial.number
    return TimingStep(
        kind="place" if unplaced else "trial",
        number=trial.number,
        phase=trial.phase,
        level=trial.level,
        code=trial.code,
        hand=trial.hand,
        switch=trial.switch,
        key=trial.key,
        rounds=state.plan.trial_rounds,
        kept=0 if state.plan.tapping else len(state.counting(trial.number)),
        at=1 + sum(state.is_over(one.number) for one in alike),
        of=len(alike),
    )

"""The state of a session after its events, and the step that is due."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal

from msgspec import Struct, structs

from fdvv.errors import ModelError
from fdvv.study.plan import events
from fdvv.study.plan.events import Event, SessionStarted, TrialFace
from fdvv.study.plan.plan import StudyPlan
from fdvv.study.plan.sitting import SittingState

MOST_FALLS = 3
"""Losses of the device while a trial was felt, after which the trial is given up."""

StepKind = Literal["page", "practice", "trial", "break", "done", "declined", "withdrawn"]
"""What a step of a session can be."""

ENDS: tuple[StepKind, ...] = ("done", "declined", "withdrawn")
"""Steps after which nothing comes."""


@dataclass(frozen=True)
class SessionState(SittingState):
    """The state of a session that shows trials to be answered.

    Attributes
    ----------
    answers : by the trial's number. converged : item and round of staircases that have ended.
    falls : counted only while a label was felt.
    """

    plan: StudyPlan
    started: SessionStarted
    answers: dict[int, events.TrialAnswered] = field(default_factory=dict)
    converged: frozenset[tuple[str, int]] = frozenset()

    @property
    def next_trial(self) -> TrialFace | None:
        """The first trial that is neither answered nor passed over."""
        return next((trial for trial in self.started.trials if self._is_left(trial)), None)

    @property
    def trials_left(self) -> int:
        return sum(self._is_left(trial) for trial in self.started.trials)

    def _is_left(self, trial: TrialFace) -> bool:
        converged = not trial.practice and (trial.item, trial.round) in self.converged
        return trial.number not in self.answers and trial.number not in self.skipped and not converged

    def after(self, event: Event) -> SessionState:
        """Return the state after an event. ModelError where it cannot follow."""
        if self.over:
            raise ModelError(f"the session of {self.started.person} is over")
        if isinstance(event, SessionStarted):
            raise ModelError(f"the session of {self.started.person} has begun already")
        return _AFTER[type(event)](self, event)


def state_of(plan: StudyPlan, happened: Sequence[Event]) -> SessionState:
    """Return the state after events. ModelError where one cannot follow the ones before."""
    if not happened or not isinstance(happened[0], SessionStarted):
        raise ModelError("a session begins with its trials")
    state = SessionState(plan, happened[0])
    for event in happened[1:]:
        state = state.after(event)
    return state


def _shown(state: SessionState, event: events.TrialShown) -> SessionState:
    due = state.next_trial
    attempt = state.attempts.get(event.number, 0) + 1
    if state.break_since_s is not None or state.next_page("consent", "before"):
        raise ModelError(f"trial {event.number} cannot be shown now")
    if due is None or due.number != event.number or event.attempt != attempt:
        raise ModelError(f"trial {event.number}, attempt {event.attempt}, is not the next one")
    since = event.at_s if state.work_since_s is None else state.work_since_s
    attempts = {**state.attempts, event.number: attempt}
    return replace(state, open=event.number, attempts=attempts, work_since_s=since)


def _answered(state: SessionState, event: events.TrialAnswered) -> SessionState:
    if state.open != event.number or state.attempts[event.number] != event.attempt:
        raise ModelError(f"trial {event.number} is not the one that is shown")
    after = replace(state, open=None, answers={**state.answers, event.number: event})
    return replace(after, break_since_s=event.at_s) if after.break_is_due(event.at_s) else after


def _interrupted(state: SessionState, event: events.TrialInterrupted) -> SessionState:
    due = state.next_trial
    if due is None or due.number != event.number:
        raise ModelError(f"trial {event.number} is not the next one")
    # only where a label had been felt can its rendering be why the device went away
    falls = {**state.falls, event.number: state.falls.get(event.number, 0) + event.felt}
    return replace(state, open=None, interruptions=state.interruptions + 1, falls=falls)


def _skipped(state: SessionState, event: events.TrialSkipped) -> SessionState:
    due = state.next_trial
    if due is None or due.number != event.number or state.falls.get(event.number, 0) < MOST_FALLS:
        raise ModelError(f"trial {event.number} is not to be given up")
    return replace(state, open=None, skipped=state.skipped | {event.number})


def _converged(state: SessionState, event: events.StaircaseConverged) -> SessionState:
    after = replace(state, converged=state.converged | {(event.item, event.round)})
    return after if after.trials_left else replace(after, break_since_s=None)


_AFTER: dict[type, Callable[[SessionState, Any], SessionState]] = {
    events.PageAnswered: SessionState.after_page,
    events.TrialShown: _shown,
    events.TrialAnswered: _answered,
    events.TrialInterrupted: _interrupted,
    events.TrialSkipped: _skipped,
    events.StaircaseConverged: _converged,
    events.BreakEnded: SessionState.after_break,
    events.SessionClosed: lambda state, event: replace(state, left_s=event.at_s, open=None),
    events.SessionResumed: SessionState.after_return,
    events.ParticipantWithdrew: lambda state, _event: replace(state, withdrawn=True, open=None),
}


class Step(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """What is before a participant; nothing in it is secret.

    Attributes
    ----------
    kind : what it is. page : the name of the page.
    number, item, labels : of the trial; between labels a person switches, "X" first. again : it was shown
        before and not answered.
    at, of : which it is, from 1, among the trials that count or among those of practice; of is 0 where a
        staircase may end before.
    left_s : seconds of the break that are left; 0: the person may go on.
    progress : from 0 to 1, of pages and trials.
    """

    kind: StepKind
    page: str = ""
    number: int = -1
    item: str = ""
    labels: tuple[str, ...] = ()
    again: bool = False
    at: int = 0
    of: int = 0
    left_s: float = 0.0
    progress: float = 0.0


def next_step(state: SessionState, now_s: float) -> Step:
    """Return the step that is due: consent, pages before, practice, trials and breaks, pages after."""
    trials = len(state.started.trials)
    done, whole = trials - state.trials_left + len(state.pages), trials + len(state.plan.pages)
    return structs.replace(_due(state, now_s), progress=done / whole if whole else 1.0)


def _due(state: SessionState, now_s: float) -> Step:
    if state.over:
        return Step(kind="withdrawn" if state.withdrawn else "declined")
    if page := state.next_page("consent", "before"):
        return Step(kind="page", page=page)
    left_s = state.break_left_s(now_s)
    if state.next_trial and left_s is not None:
        return Step(kind="break", left_s=left_s)
    if state.next_trial:
        return _trial_step(state, state.next_trial)
    page = state.next_page("after")
    return Step(kind="page", page=page) if page else Step(kind="done")


def _trial_step(state: SessionState, trial: TrialFace) -> Step:
    alike = [one for one in state.started.trials if one.practice == trial.practice]
    sure = trial.practice or state.plan.kind != "staircase"
    return Step(
        kind="practice" if trial.practice else "trial",
        number=trial.number,
        item=trial.item,
        labels=trial.labels,
        again=trial.number in state.attempts and state.open != trial.number,
        at=1 + sum(one.number in state.answers for one in alike),
        of=len(alike) if sure else 0,
    )

"""Where the events of a session leave it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from fdvv.errors import ModelError
from fdvv.study._events import (
    Answered,
    Began,
    BreakEnded,
    Event,
    Interrupted,
    Left,
    PageAnswered,
    Resumed,
    Settled,
    Shown,
    Skipped,
    TrialFace,
    Withdrawn,
)
from fdvv.study._plan import StudyPlan

MOST_FALLS = 3
"""Of the device while a trial was felt: then the trial is given up, for what it renders cannot be held."""


@dataclass(frozen=True)
class SessionState:
    """Where a session stands.

    Attributes
    ----------
    plan, began : what it is about.
    pages : that were answered, by name. answers : by the trial's number. attempts : how often each was
        shown. open : the trial that is before the person, or None.
    settled : item and round of staircases that have ended.
    work_since_s : since when the person works without a break. break_since_s : when a break began that has
        not ended. left_s : when the session was closed. last_s : when anything happened last.
    declined, withdrawn : it is over. interruptions, resumptions : how often.
    falls : how often the device went away while a trial was felt, by number. skipped : trials given up for
        that.
    """

    plan: StudyPlan
    began: Began
    pages: dict[str, PageAnswered] = field(default_factory=dict)
    answers: dict[int, Answered] = field(default_factory=dict)
    attempts: dict[int, int] = field(default_factory=dict)
    open: int | None = None
    settled: frozenset[tuple[str, int]] = frozenset()
    work_since_s: float | None = None
    break_since_s: float | None = None
    left_s: float | None = None
    last_s: float = 0.0
    declined: bool = False
    withdrawn: bool = False
    interruptions: int = 0
    resumptions: int = 0
    falls: dict[int, int] = field(default_factory=dict)
    skipped: frozenset[int] = frozenset()

    @property
    def over(self) -> bool:
        """Tell whether the person declined or withdrew."""
        return self.declined or self.withdrawn

    @property
    def next_trial(self) -> TrialFace | None:
        """Get the first trial that is neither answered nor settled."""
        return next((trial for trial in self.began.trials if self._is_left(trial)), None)

    @property
    def trials_left(self) -> int:
        """Count the trials that may still be met."""
        return sum(self._is_left(trial) for trial in self.began.trials)

    def _is_left(self, trial: TrialFace) -> bool:
        settled = not trial.practice and (trial.item, trial.round) in self.settled
        return trial.number not in self.answers and trial.number not in self.skipped and not settled

    def next_page(self, *whens: str) -> str | None:
        """Give the name of the first page of these times that was not answered."""
        pages = (page.name for when in whens for page in self.plan.pages if page.when == when)
        return next((name for name in pages if name not in self.pages), None)

    def after(self, event: Event) -> SessionState:
        """Give the state after an event. ModelError where it cannot follow."""
        if self.over:
            raise ModelError(f"the session of {self.began.person} is over")
        return replace(_AFTER[type(event)](self, event), last_s=event.at_s)


def state_of(plan: StudyPlan, events: Sequence[Event]) -> SessionState:
    """Give the state that events lead to. ModelError where one cannot follow the ones before."""
    if not events or not isinstance(events[0], Began):
        raise ModelError("a session begins with its trials")
    state = SessionState(plan, events[0], last_s=events[0].at_s)
    for event in events[1:]:
        state = state.after(event)
    return state


def _again(state: SessionState, event: Began) -> SessionState:
    raise ModelError(f"the session of {state.began.person} has begun already")


def _page(state: SessionState, event: PageAnswered) -> SessionState:
    before = ("consent", "before") if state.next_trial else ("consent", "before", "after")
    if event.name != state.next_page(*before):
        raise ModelError(f"page {event.name} is not the one that was asked")
    (page,) = (one for one in state.plan.pages if one.name == event.name)
    declined = page.when == "consent" and not event.agreed
    return replace(state, pages={**state.pages, event.name: event}, declined=declined)


def _shown(state: SessionState, event: Shown) -> SessionState:
    due = state.next_trial
    attempt = state.attempts.get(event.number, 0) + 1
    if state.break_since_s is not None or state.next_page("consent", "before"):
        raise ModelError(f"trial {event.number} cannot be shown now")
    if due is None or due.number != event.number or event.attempt != attempt:
        raise ModelError(f"trial {event.number}, attempt {event.attempt}, is not the next one")
    since = event.at_s if state.work_since_s is None else state.work_since_s
    attempts = {**state.attempts, event.number: attempt}
    return replace(state, open=event.number, attempts=attempts, work_since_s=since)


def _answered(state: SessionState, event: Answered) -> SessionState:
    if state.open != event.number or state.attempts[event.number] != event.attempt:
        raise ModelError(f"trial {event.number} is not the one that is shown")
    after = replace(state, open=None, answers={**state.answers, event.number: event})
    return replace(after, break_since_s=event.at_s) if _break_is_due(after, event.at_s) else after


def _break_is_due(state: SessionState, at_s: float) -> bool:
    """Tell whether this boundary between two trials is one where a break begins."""
    plan, since_s = state.plan, state.work_since_s
    if not plan.break_every_min or not plan.break_min or since_s is None or not state.trials_left:
        return False
    return at_s - since_s >= 60.0 * plan.break_every_min


def _interrupted(state: SessionState, event: Interrupted) -> SessionState:
    due = state.next_trial
    if due is None or due.number != event.number:
        raise ModelError(f"trial {event.number} is not the next one")
    falls = {**state.falls, event.number: state.falls.get(event.number, 0) + event.felt}
    return replace(state, open=None, interruptions=state.interruptions + 1, falls=falls)


def _skipped(state: SessionState, event: Skipped) -> SessionState:
    due = state.next_trial
    if due is None or due.number != event.number or state.falls.get(event.number, 0) < MOST_FALLS:
        raise ModelError(f"trial {event.number} is not to be given up")
    return replace(state, open=None, skipped=state.skipped | {event.number})


def _settled(state: SessionState, event: Settled) -> SessionState:
    after = replace(state, settled=state.settled | {(event.item, event.round)})
    return after if after.trials_left else replace(after, break_since_s=None)


def _break_ended(state: SessionState, event: BreakEnded) -> SessionState:
    if state.break_since_s is None:
        raise ModelError("there is no break to end")
    if event.at_s < state.break_since_s + 60.0 * state.plan.break_min:
        raise ModelError("the break is not over yet")
    return replace(state, break_since_s=None, work_since_s=None)


def _left(state: SessionState, event: Left) -> SessionState:
    return replace(state, left_s=event.at_s, open=None)


def _resumed(state: SessionState, event: Resumed) -> SessionState:
    """Go on. Time away is no work where the session was closed in order, and a break if it was long enough.

    Of a session that was killed nobody knows when work ended: all that time counts as work.
    """
    after = replace(state, open=None, left_s=None, resumptions=state.resumptions + 1)
    if state.left_s is None or state.work_since_s is None:
        return after
    away_s = max(0.0, event.at_s - state.left_s)
    rested = away_s >= 60.0 * state.plan.break_min
    return replace(after, work_since_s=None if rested else state.work_since_s + away_s)


def _withdrawn(state: SessionState, event: Withdrawn) -> SessionState:
    return replace(state, withdrawn=True, open=None)


_AFTER: dict[type, Callable[[SessionState, Any], SessionState]] = {
    Began: _again,
    PageAnswered: _page,
    Shown: _shown,
    Answered: _answered,
    Interrupted: _interrupted,
    Skipped: _skipped,
    Settled: _settled,
    BreakEnded: _break_ended,
    Left: _left,
    Resumed: _resumed,
    Withdrawn: _withdrawn,
}

"""What a participant meets next: a pure function of the plan, what happened so far, and the time."""

from __future__ import annotations

from typing import Literal

from msgspec import Struct

from fdvv.study._events import TrialFace
from fdvv.study._session import SessionState

StepKind = Literal["page", "practice", "trial", "break", "done", "declined", "withdrawn"]
"""What a step of a session can be."""
ENDS: tuple[StepKind, ...] = ("done", "declined", "withdrawn")
"""Steps after which nothing comes."""


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
    answered, trials : how many trials are done with, and how many there are at most, practice included.
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
    answered: int = 0
    trials: int = 0
    progress: float = 0.0


def next_step(state: SessionState, now_s: float) -> Step:
    """Tell what a participant meets now: consent, pages before, practice, trials and breaks, pages after."""
    if state.over:
        return _step(state, "withdrawn" if state.withdrawn else "declined")
    page = state.next_page("consent", "before")
    if page:
        return _step(state, "page", page=page)
    if state.next_trial and state.break_since_s is not None:
        return _step(state, "break", left_s=_break_left_s(state, now_s))
    if state.next_trial:
        return _trial_step(state, state.next_trial)
    page = state.next_page("after")
    return _step(state, "page", page=page) if page else _step(state, "done")


def _trial_step(state: SessionState, trial: TrialFace) -> Step:
    kind: StepKind = "practice" if trial.practice else "trial"
    again = trial.number in state.attempts and state.open != trial.number
    alike = [one for one in state.began.trials if one.practice == trial.practice]
    sure = trial.practice or state.plan.kind != "staircase"
    return _step(
        state,
        kind,
        number=trial.number,
        item=trial.item,
        labels=trial.labels,
        again=again,
        at=1 + sum(one.number in state.answers for one in alike),
        of=len(alike) if sure else 0,
    )


def _break_left_s(state: SessionState, now_s: float) -> float:
    assert state.break_since_s is not None
    whole_s = 60.0 * state.plan.break_min
    # a clock that was set back does not make a break longer than it is
    return min(whole_s, max(0.0, state.break_since_s + whole_s - now_s))


def _step(state: SessionState, kind: StepKind, **about: object) -> Step:
    trials = len(state.began.trials)
    answered = trials - state.trials_left
    done, whole = answered + len(state.pages), trials + len(state.plan.pages)
    counts = {"answered": answered, "trials": trials, "progress": done / whole if whole else 1.0}
    return Step(kind=kind, **counts, **about)  # type: ignore[arg-type]

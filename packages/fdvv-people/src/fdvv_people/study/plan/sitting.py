"""The state of a session of any kind after its events, and the step that is due.

A kind of session adds its own state, its own events and what a step of it shows. Pages, breaks, gaps, devices
that go away and people who go and come back are the same for all.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from typing import Any, ClassVar, Generic, Literal, Protocol, Self, TypeVar

import msgspec

from fdvv.errors import ModelError
from fdvv_people.study.plan.events import (
    BreakEnded,
    PageAnswered,
    ParticipantWithdrew,
    SessionClosed,
    SessionEvent,
    SessionResumed,
)

MOST_FALLS = 3
"""Losses of the device in one trial, after which the trial is given up."""

StepKind = Literal["page", "practice", "place", "trial", "break", "wait", "done", "declined", "withdrawn"]
"""What a step of a session can be. place: something is to be put under the hand. wait: a gap is not over."""

ENDS: tuple[StepKind, ...] = ("done", "declined", "withdrawn")
"""Steps after which nothing comes."""


class Face(Protocol):
    """All of a trial that may be seen. number : 0, 1, ... of the person."""

    @property
    def number(self) -> int: ...


F = TypeVar("F", bound=Face)
Handlers = Mapping[type[SessionEvent], Callable[[Any, Any], Any]]
"""The state after an event, by the event's kind: of the state before and the event."""


@dataclass(frozen=True, kw_only=True)
class Step(Generic[F]):
    """What is before a participant; nothing in it is secret.

    Attributes
    ----------
    kind : what it is. page : the name of the page. face : of the trial.
    again : the trial was shown before and not answered. rounds, kept : of the trial, and how many are kept
        already: more than 0 where it goes on.
    at, of : which trial it is of its sort, from 1; of is 0 where a staircase may end before.
    left_s : seconds of the break that are left; 0: the person may go on. due_at : when the gap is over (UTC);
        empty elsewhere. progress : from 0 to 1, of pages and trials.
    """

    kind: StepKind
    page: str = ""
    face: F | None = None
    again: bool = False
    rounds: int = 0
    kept: int = 0
    at: int = 0
    of: int = 0
    left_s: float = 0.0
    due_at: str = ""
    progress: float = 0.0

    @property
    def number(self) -> int:
        """The number of the trial; -1 of a step without one."""
        return -1 if self.face is None else self.face.number

    @property
    def trial(self) -> F:
        """What may be seen of the trial. ModelError of a step without one."""
        if self.face is None:
            raise ModelError(f"a step of the kind {self.kind} has no trial")
        return self.face


@dataclass(frozen=True)
class SittingState(ABC, Generic[F]):
    """The state of a session, whatever its trials are.

    Attributes
    ----------
    beginning : kind of the event that a session begins with. handlers : of all others. endings : of those
        after which a trial is over. product : what a person gives in trials, in words.
    plan, started : of the session.
    pages : that were answered, by name. attempts : how often each trial was begun. open : the trial that is
        under way, or None.
    work_since_s : since when the person works without a break. break_since_s : when a break began that has
        not ended. left_s : when the session was closed.
    declined, withdrawn : it is over. interruptions, resumptions : how often.
    falls : how often the device went away, by number of the trial. skipped : trials given up for that.
    """

    beginning: ClassVar[type[SessionEvent]]
    handlers: ClassVar[Handlers]
    endings: ClassVar[tuple[type[SessionEvent], ...]]
    product: ClassVar[str]

    plan: Any
    started: Any
    pages: dict[str, PageAnswered] = field(default_factory=dict)
    attempts: dict[int, int] = field(default_factory=dict)
    open: int | None = None
    work_since_s: float | None = None
    break_since_s: float | None = None
    left_s: float | None = None
    declined: bool = False
    withdrawn: bool = False
    interruptions: int = 0
    resumptions: int = 0
    falls: dict[int, int] = field(default_factory=dict)
    skipped: frozenset[int] = frozenset()

    @classmethod
    def kinds(cls) -> tuple[type[SessionEvent], ...]:
        """Return the kinds of events that a log of such a session may hold."""
        return cls.beginning, *cls.handlers

    @classmethod
    def event_of(cls, record: dict[str, Any]) -> SessionEvent:
        """Read a record of a session's log. ModelError where it is none."""
        ((word, body),) = record.items()
        kinds = {kind.word: kind for kind in cls.kinds()}
        try:
            return msgspec.convert(body, kinds[word])
        except (KeyError, msgspec.ValidationError) as error:
            raise ModelError(f"no event of a session: {error}") from error

    @classmethod
    def of(cls, plan: Any, happened: Iterable[SessionEvent]) -> Self:
        """Return the state after events. ModelError where one cannot follow the ones before."""
        first, *others = happened or (None,)
        if not isinstance(first, cls.beginning):
            raise ModelError("a session begins with its trials")
        state = cls(plan, first)
        for event in others:
            state = state.after(event)
        return state

    @classmethod
    def read(cls, plan: Any, records: Sequence[dict[str, Any]]) -> Self | None:
        """Return the state after the records of a log; None of a session that did not start. ModelError."""
        return cls.of(plan, [cls.event_of(record) for record in records]) if records else None

    @classmethod
    @abstractmethod
    def kept_in(cls, records: Sequence[dict[str, Any]]) -> int:
        """Return how many answers, or rounds, the records of a log hold, whatever else they are."""

    @classmethod
    def lacks(cls, records: Sequence[dict[str, Any]]) -> Iterator[str]:
        """Return what the log of a session that is done lacks, as a line. Of a log that may be spoilt."""
        try:
            happened = [cls.event_of(record) for record in records]
        except ModelError as error:
            yield str(error)
            return
        trials = [
            trial
            for one in happened
            if isinstance(one, cls.beginning)
            for trial in getattr(one, "trials", ())
        ]
        over = {getattr(one, "number", -1) for one in happened if isinstance(one, cls.endings)}
        if left := [one for one in trials if one.number not in over | cls.find_ended(happened, trials)]:
            yield f"lacks the {cls.product} of {len(left)} trials, and the person was done"

    @classmethod
    def find_ended(cls, happened: Sequence[SessionEvent], trials: Sequence[F]) -> set[int]:
        """Return the numbers of trials that are over though nothing was given in them."""
        del happened, trials
        return set()

    def after(self, event: SessionEvent) -> Self:
        """Return the state after an event. ModelError where it cannot follow."""
        if self.over:
            raise ModelError(f"the session of {self.started.person} is over")
        if isinstance(event, self.beginning):
            raise ModelError(f"the session of {self.started.person} has begun already")
        after: Self = self.handlers[type(event)](self, event)
        return after

    @abstractmethod
    def is_over(self, face: F) -> bool:
        """Whether nothing is left to be done in a trial."""

    @property
    @abstractmethod
    def count(self) -> int:
        """How many answers, or rounds, are on record: what a person gave and must not lose."""

    @abstractmethod
    def trial_step(self, face: F) -> Step[F]:
        """Return the step of the trial that is due."""

    def gap_until_s(self, now_s: float) -> float | None:
        """Return until when a person waits, in wall time; None where there is no gap at that time."""
        del now_s
        return None

    @property
    def over(self) -> bool:
        """Whether the person declined or withdrew."""
        return self.declined or self.withdrawn

    @property
    def next_trial(self) -> F | None:
        """The first trial that is not over."""
        return next((face for face in self.started.trials if not self.is_over(face)), None)

    @property
    def trials_left(self) -> int:
        return sum(not self.is_over(face) for face in self.started.trials)

    @property
    def trials_over(self) -> int:
        return len(self.started.trials) - self.trials_left

    def step(self, now_s: float) -> Step[F]:
        """Return the step that is due at a wall time: pages before, trials, gaps and breaks, pages after."""
        done, whole = self.trials_over + len(self.pages), len(self.started.trials) + len(self.plan.pages)
        return replace(self._due(now_s), progress=done / whole if whole else 1.0)

    def _due(self, now_s: float) -> Step[F]:
        if self.over:
            return Step(kind="withdrawn" if self.withdrawn else "declined")
        face = self.next_trial
        if page := self.next_page("consent", "before") or (self.next_page("after") if face is None else None):
            return Step(kind="page", page=page)
        if face is None:
            return Step(kind="done")
        until_s, left_s = self.gap_until_s(now_s), self.break_left_s(now_s)
        if until_s is not None:
            return Step(kind="wait", due_at=utc_text(until_s))
        return self.trial_step(face) if left_s is None else Step(kind="break", left_s=left_s)

    def next_page(self, *whens: str) -> str | None:
        """Return the name of the first page of these times that was not answered."""
        pages = (page.name for when in whens for page in self.plan.pages if page.when == when)
        return next((name for name in pages if name not in self.pages), None)

    def require_due(self, number: int) -> F:
        """Return the trial that is due. ModelError where it is another one."""
        due = self.next_trial
        if due is None or due.number != number:
            raise ModelError(f"trial {number} is not the next one")
        return due

    def break_is_due(self, at_s: float) -> bool:
        plan, since_s = self.plan, self.work_since_s
        if not plan.break_every_min or not plan.break_min or since_s is None or self.next_trial is None:
            return False
        return bool(at_s - since_s >= 60.0 * plan.break_every_min)

    def break_left_s(self, now_s: float) -> float | None:
        """Return how long the break still lasts at a wall time; None where there is none."""
        if self.break_since_s is None:
            return None
        whole_s: float = 60.0 * self.plan.break_min
        # a clock that was set back does not make a break longer than it is
        return min(whole_s, max(0.0, self.break_since_s + whole_s - now_s))

    def after_attempt(self, number: int, attempt: int, at_s: float) -> Self:
        """Return the state in which a trial is under way. ModelError where it cannot be begun now."""
        self.require_due(number)
        if self.break_since_s is not None or self.next_page("consent", "before"):
            raise ModelError(f"trial {number} cannot be begun now")
        if attempt != self.attempts.get(number, 0) + 1:
            raise ModelError(f"trial {number}, attempt {attempt}, is not the next one")
        since = at_s if self.work_since_s is None else self.work_since_s
        return replace(self, open=number, attempts={**self.attempts, number: attempt}, work_since_s=since)

    def after_trial(self, at_s: float) -> Self:
        """Return the state between two trials: a break begins where one is due."""
        after = replace(self, open=None)
        return replace(after, break_since_s=at_s) if after.break_is_due(at_s) else after

    def after_loss(self, number: int, fell: bool) -> Self:
        """Return the state after the device went away. fell : the trial may be why. ModelError."""
        self.require_due(number)
        falls = {**self.falls, number: self.falls.get(number, 0) + fell}
        return replace(self, open=None, interruptions=self.interruptions + 1, falls=falls)

    def after_page(self, event: PageAnswered) -> Self:
        """Return the state after a page. ModelError where another one was asked."""
        before = ("consent", "before") if self.next_trial else ("consent", "before", "after")
        if event.name != self.next_page(*before):
            raise ModelError(f"page {event.name} is not the one that was asked")
        (page,) = (one for one in self.plan.pages if one.name == event.name)
        declined = page.when == "consent" and not event.agreed
        return replace(self, pages={**self.pages, event.name: event}, declined=declined)

    def after_break(self, event: BreakEnded) -> Self:
        """Return the state after a break. ModelError while it lasts, or where there is none."""
        if self.break_since_s is None:
            raise ModelError("there is no break to end")
        if event.at_s < self.break_since_s + 60.0 * self.plan.break_min:
            raise ModelError("the break is not over yet")
        return replace(self, break_since_s=None, work_since_s=None)

    def after_close(self, event: SessionClosed) -> Self:
        return replace(self, left_s=event.at_s, open=None)

    def after_return(self, event: SessionResumed) -> Self:
        """Return the state after a return: time away is no work where the session was closed in order.

        It is a break if it was long enough. Of a session that was killed nobody knows when work ended: all
        that time counts as work.
        """
        after = replace(self, open=None, left_s=None, resumptions=self.resumptions + 1)
        if self.left_s is None or self.work_since_s is None:
            return after
        away_s = max(0.0, event.at_s - self.left_s)
        rested = away_s >= 60.0 * self.plan.break_min
        return replace(after, work_since_s=None if rested else self.work_since_s + away_s)

    def after_withdrawal(self, _event: ParticipantWithdrew) -> Self:
        return replace(self, withdrawn=True, open=None)


HANDLERS: Handlers = {
    PageAnswered: SittingState.after_page,
    BreakEnded: SittingState.after_break,
    SessionClosed: SittingState.after_close,
    SessionResumed: SittingState.after_return,
    ParticipantWithdrew: SittingState.after_withdrawal,
}
"""Of the events that every kind of session has."""


def utc_text(at_s: float) -> str:
    """Return a wall time as people and files write it, to the second."""
    return datetime.fromtimestamp(at_s, UTC).isoformat(timespec="seconds")

"""What sessions of every kind have in common: pages, breaks, and people who go and come back."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field, replace
from typing import Any, Self

from fdvv.errors import ModelError
from fdvv.study.plan.events import BreakEnded, PageAnswered, SessionResumed


@dataclass(frozen=True)
class SittingState(ABC):
    """The state of a session, whatever its trials are.

    Attributes
    ----------
    plan, started : of the session.
    pages : that were answered, by name. attempts : how often each trial was begun. open : the trial that is
        under way, or None.
    work_since_s : since when the person works without a break. break_since_s : when a break began that has
        not ended. left_s : when the session was closed.
    declined, withdrawn : it is over. interruptions, resumptions : how often.
    falls : how often the device went away, by number of the trial. skipped : trials given up for that.
    """

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

    @property
    @abstractmethod
    def next_trial(self) -> Any | None:
        """The first trial that is not over."""

    @property
    def over(self) -> bool:
        """Whether the person declined or withdrew."""
        return self.declined or self.withdrawn

    def next_page(self, *whens: str) -> str | None:
        """Return the name of the first page of these times that was not answered."""
        pages = (page.name for when in whens for page in self.plan.pages if page.when == when)
        return next((name for name in pages if name not in self.pages), None)

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

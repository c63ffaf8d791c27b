"""A person who sits in a study of any kind: every answer is on the disk before the next step exists."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from typing import Any, Generic, Self, TypeVar, cast

from fdvv.errors import ModelError
from fdvv_people.study.admin.study import Study
from fdvv_people.study.files.seal import KeyHolder
from fdvv_people.study.plan.events import (
    BreakEnded,
    PageAnswered,
    ParticipantWithdrew,
    SessionClosed,
    SessionEvent,
    Value,
    checked_page,
)
from fdvv_people.study.plan.sitting import ENDS, SittingState, Step
from fdvv_people.study.session.log import OpenedSession

S = TypeVar("S", bound=SittingState[Any])


class Sitting(ABC, Generic[S]):
    """What is the same for everybody in a study, a person or a simulated one, for one process at a time.

    What is hidden is in memory only. A context manager; not to be used from two threads at once.

    Attributes
    ----------
    study, person, language : who takes part in what. state : of the session; nothing in it is secret.
    """

    def __init__(self, study: Study, session: OpenedSession, clock: Callable[[], float], *stage: Any) -> None:
        del stage
        self.study, self._plan, self._session, self._clock = study, study.plan, session, clock
        self.state = cast(S, session.state)
        self.person: str = self.state.started.person
        self.language: str = self.state.started.language
        self._closed = False

    @classmethod
    def enrol(
        cls,
        study: Study,
        language: str = "",
        *stage: Any,
        simulated: bool = False,
        clock: Callable[[], float] = time.time,
    ) -> tuple[Self, str]:
        """Enrol a person and start the session; return the code too, for that person's eyes only.

        language : "": the study's first. stage : what the kind of study needs besides. simulated : no person
        sits here. clock : wall time in seconds. InputError, OSError.
        """
        person, code = study.enrol(language, simulated=simulated)
        return cls.resume(study, person, code, *stage, clock=clock), code

    @classmethod
    def resume(
        cls,
        study: Study,
        person: str,
        code: str | KeyHolder,
        *stage: Any,
        clock: Callable[[], float] = time.time,
    ) -> Self:
        """Resume a session where its log ends. code : the person's, or the key holder in its place.

        InputError on a wrong code, on a person who withdrew, where the session runs elsewhere or where the
        study was changed. OSError.
        """
        return cls(study, OpenedSession(study, person, code, round(clock(), 1)), clock, *stage)

    def step(self, now_s: float | None = None) -> Step[Any]:
        """Return the step that is due. now_s : wall time; the session's clock if None."""
        return self.state.step(self._clock() if now_s is None else now_s)

    def answer_page(self, name: str, values: Mapping[str, Value], agreed: bool = True) -> Step[Any]:
        """Log a page's answers; return the step after it.

        A person who does not agree on a consent page is out: only the enrolment stays on record.
        InputError, ModelError, OSError.
        """
        if name in self.state.pages:
            return self.step()
        page = next((page for page in self._plan.pages if page.name == name), None)
        if page is None:
            raise ModelError(f"the study has no page {name}")
        if page.when == "consent" and not agreed:
            return self._leave(PageAnswered(self._now(), name, agreed=False))
        self._add(PageAnswered(self._now(), name, checked_page(self._plan.languages, page, values)))
        return self._advance()

    def end_break(self) -> Step[Any]:
        """End a break, which began by itself; ModelError while it lasts."""
        self._add(BreakEnded(self._now()))
        return self.step()

    def withdraw(self, delete: bool = True) -> Step[Any]:
        """Leave the study for good. delete : all data of the person; only the enrolment stays on record."""
        return self._leave(ParticipantWithdrew(self._now()), delete)

    def close(self) -> None:
        """Close the session in order: until it is resumed, time does not count as work. Idempotent."""
        if self._closed:
            return
        if self.step().kind not in ENDS:
            self._add(SessionClosed(self._now()))
        self._release()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @abstractmethod
    def _pass_over(self) -> None:
        """Log what follows from the events so far without anybody's doing."""

    def _put_away(self) -> None:
        """Let go of what is under the hand, when the session ends."""

    def _now(self) -> float:
        # a finer time could reveal what was rendered
        return round(self._clock(), 1)

    def _add(self, event: SessionEvent) -> None:
        self.state = cast(S, self._session.add(event))

    def _advance(self) -> Step[Any]:
        """Pass over what is done with, and log where all is done."""
        self._pass_over()
        step = self.step()
        if step.kind == "done" and self.study.person(self.person).state == "enrolled":
            self.study.finished(self.person)
        return step

    def _leave(self, event: PageAnswered | ParticipantWithdrew, delete: bool = True) -> Step[Any]:
        self.state = self.state.after(event)
        self._release()
        self.study.withdraw(self.person, delete=delete)
        return self.step()

    def _release(self) -> None:
        self._closed = True
        self._session.close()
        self._put_away()

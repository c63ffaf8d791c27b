"""A participant's session as it stands: what may be seen of it, how it goes on and how it ends."""

from __future__ import annotations

from collections.abc import Callable
from types import TracebackType
from typing import Self

from fdvv.study import (
    ENDS,
    Event,
    Left,
    PageAnswered,
    SessionState,
    Settled,
    Step,
    StudyTrial,
    Withdrawn,
    next_step,
)
from fdvv.workflow._held_stage import HeldStage
from fdvv.workflow._participant_log import OpenedSession
from fdvv.workflow._study import Study
from fdvv.workflow._study_stage import StudyStage
from fdvv.workflow._trial_stimuli import has_settled
from fdvv.workflow._trial_watch import TrialWatch


class ParticipantSession:
    """A session that is open, its schedule in memory only; a context manager.

    Attributes
    ----------
    study, person, language : who takes part in what.
    """

    def __init__(
        self, study: Study, opened: OpenedSession, stage: StudyStage, clock: Callable[[], float]
    ) -> None:
        self.study, self._plan, self._schedule = study, study.plan, opened.schedule.trials
        self._log, self._sealed, self._state = opened.log, opened.sealed, opened.state
        self._stage = HeldStage(self._plan, stage)
        self._clock = clock
        self._trial: StudyTrial | None = None
        self._watch = TrialWatch(clock)
        self._closed = False
        self._go_on()

    @property
    def state(self) -> SessionState:
        """Get where the session stands; nothing in it is secret."""
        return self._state

    @property
    def person(self) -> str:
        """Get who it is: "P01"."""
        return self._state.began.person

    @property
    def language(self) -> str:
        """Get the language that the person chose."""
        return self._state.began.language

    def step(self, now_s: float | None = None) -> Step:
        """Tell what the person meets now. now_s : wall time, as the session's clock tells it."""
        return next_step(self._state, self._clock() if now_s is None else now_s)

    def close(self) -> None:
        """Close the session in order: until it is resumed, time does not count as work. Twice is once."""
        if self._closed:
            return
        if self.step().kind not in ENDS:
            self._add(Left(self._now()))
        self._let_go()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _now(self) -> float:
        """Tell wall time as it is written down: coarsely, for a finer one could tell what was worked on."""
        return round(self._clock(), 1)

    def _add(self, event: Event) -> None:
        self._state = self._log.add(event)

    def _go_on(self) -> Step:
        """Pass over trials of staircases that have ended; note where all is done; give the next step."""
        while trial := self._state.next_trial:
            if not has_settled(self._plan, self._schedule, self._state, trial.number):
                break
            self._add(Settled(self._now(), trial.item, trial.round))
        step = self.step()
        if step.kind == "done" and self.study.person(self.person).state == "enrolled":
            self.study.finished(self.person)
        return step

    def _leave_for_good(self, event: PageAnswered | Withdrawn, delete: bool = True) -> Step:
        self._state = self._state.after(event)
        self._let_go()
        self.study.withdraw(self.person, delete=delete)
        return self.step()

    def _let_go(self) -> None:
        self._closed = True
        self._log.close()
        self._sealed.close()
        self._stage.drop()

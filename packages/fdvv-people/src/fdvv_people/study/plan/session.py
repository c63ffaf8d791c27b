"""The state of a session whose trials show labels, to be answered."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

from fdvv.errors import ModelError
from fdvv_people.study.plan import events
from fdvv_people.study.plan.events import SessionEvent, SessionStarted, TrialFace
from fdvv_people.study.plan.plan import StudyPlan
from fdvv_people.study.plan.sitting import HANDLERS, MOST_FALLS, Handlers, SittingState, Step


@dataclass(frozen=True)
class SessionState(SittingState[TrialFace]):
    """The state of a session that shows trials to be answered.

    Attributes
    ----------
    answers : by the trial's number. converged : item and round of staircases that have ended.
    falls : counted only while a label was felt.
    """

    beginning: ClassVar[type[SessionEvent]] = SessionStarted
    endings: ClassVar[tuple[type[SessionEvent], ...]] = (events.TrialAnswered, events.TrialSkipped)
    product: ClassVar[str] = "answers"

    plan: StudyPlan
    started: SessionStarted
    answers: dict[int, events.TrialAnswered] = field(default_factory=dict)
    converged: frozenset[tuple[str, int]] = frozenset()

    @classmethod
    def kept_in(cls, records: Sequence[dict[str, Any]]) -> int:
        return len({record["answered"]["number"] for record in records if "answered" in record})

    @classmethod
    def find_ended(cls, happened: Sequence[SessionEvent], trials: Sequence[TrialFace]) -> set[int]:
        ended = {(one.item, one.round) for one in happened if isinstance(one, events.StaircaseConverged)}
        return {one.number for one in trials if not one.practice and (one.item, one.round) in ended}

    def is_over(self, face: TrialFace) -> bool:
        """Whether a trial was answered, given up, or passed over."""
        converged = not face.practice and (face.item, face.round) in self.converged
        return face.number in self.answers or face.number in self.skipped or converged

    @property
    def count(self) -> int:
        return len(self.answers)

    def trial_step(self, face: TrialFace) -> Step[TrialFace]:
        alike = [one for one in self.started.trials if one.practice == face.practice]
        sure = face.practice or self.plan.staircase is None
        return Step(
            kind="practice" if face.practice else "trial",
            face=face,
            again=face.number in self.attempts and self.open != face.number,
            at=1 + sum(one.number in self.answers for one in alike),
            of=len(alike) if sure else 0,
        )

    def after_shown(self, event: events.TrialShown) -> SessionState:
        return self.after_attempt(event.number, event.attempt, event.at_s)

    def after_answer(self, event: events.TrialAnswered) -> SessionState:
        if self.open != event.number or self.attempts[event.number] != event.attempt:
            raise ModelError(f"trial {event.number} is not the one that is shown")
        return replace(self, answers={**self.answers, event.number: event}).after_trial(event.at_s)

    def after_interruption(self, event: events.TrialInterrupted) -> SessionState:
        # only where a label had been felt can its rendering be why the device went away
        return self.after_loss(event.number, event.felt)

    def after_skip(self, event: events.TrialSkipped) -> SessionState:
        self.require_due(event.number)
        if self.falls.get(event.number, 0) < MOST_FALLS:
            raise ModelError(f"trial {event.number} is not to be given up")
        return replace(self, open=None, skipped=self.skipped | {event.number})

    def after_convergence(self, event: events.StaircaseConverged) -> SessionState:
        after = replace(self, converged=self.converged | {(event.item, event.round)})
        return after if after.trials_left else replace(after, break_since_s=None)

    handlers: ClassVar[Handlers] = {
        **HANDLERS,
        events.TrialShown: after_shown,
        events.TrialAnswered: after_answer,
        events.TrialInterrupted: after_interruption,
        events.TrialSkipped: after_skip,
        events.StaircaseConverged: after_convergence,
    }

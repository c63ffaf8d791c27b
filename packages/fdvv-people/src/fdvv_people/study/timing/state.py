"""The state of a session that times presses: training, a gap, a validation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

from fdvv.errors import ModelError
from fdvv_people.study.plan.events import (
    SessionClosed,
    SessionEvent,
    SessionResumed,
    TrialInterrupted,
    TrialSkipped,
)
from fdvv_people.study.plan.sitting import HANDLERS, Handlers, SittingState, Step
from fdvv_people.study.timing import events
from fdvv_people.study.timing.events import RoundKept, TimingStarted
from fdvv_people.study.timing.plan import DAY_s, TimingPlan
from fdvv_people.study.timing.schedule import Phase, TimingFace
from fdvv_people.task.score import Score


@dataclass(frozen=True)
class TimingState(SittingState[TimingFace]):
    """The state of a session that times presses.

    Attributes
    ----------
    designs : of training trials, by number. placed : the trial whose switch is under the hand, or None.
    rounds : all of a trial, by number, those that do not count among them. scores, failed : with skipped the
        trials that are over, by number. trained_s : when the training ended.
    """

    beginning: ClassVar[type[SessionEvent]] = TimingStarted
    endings: ClassVar[tuple[type[SessionEvent], ...]] = (
        events.TimedScored,
        events.DesignFailed,
        TrialSkipped,
    )
    product: ClassVar[str] = "scores"

    plan: TimingPlan
    started: TimingStarted
    designs: dict[int, events.ButtonDesigned] = field(default_factory=dict)
    placed: int | None = None
    rounds: dict[int, tuple[RoundKept, ...]] = field(default_factory=dict)
    scores: dict[int, dict[str, Score]] = field(default_factory=dict)
    failed: dict[int, str] = field(default_factory=dict)
    trained_s: float | None = None

    @classmethod
    def kept_in(cls, records: Sequence[dict[str, Any]]) -> int:
        return sum(RoundKept.word in record for record in records)

    def is_over(self, face: TimingFace) -> bool:
        """Whether a trial was scored or given up."""
        return face.number in self.scores or face.number in self.failed or face.number in self.skipped

    @property
    def count(self) -> int:
        return sum(map(len, self.rounds.values()))

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

    def gap_until_s(self, now_s: float) -> float | None:
        """Return until when a person waits, in wall time; None where the gap is over at that time."""
        until_s = self.not_before_s
        waits = self.plan.gap_days > 0 and until_s is not None and now_s < until_s
        return until_s if waits and not self.validated else None

    @property
    def validated(self) -> bool:
        """Whether a trial of the validation was begun."""
        # once a trial of the validation was begun, a clock that was set back stops nobody
        return any(one.phase == "validation" and one.number in self.attempts for one in self.started.trials)

    def trial_step(self, face: TimingFace) -> Step[TimingFace]:
        alike = [one for one in self.started.trials if one.phase == face.phase]
        unplaced = face.hand != "button" and self.placed != face.number
        return Step(
            kind="place" if unplaced else "trial",
            face=face,
            rounds=self.plan.trial_rounds,
            kept=0 if self.plan.tapping else len(self.counting(face.number)),
            at=1 + sum(self.is_over(one) for one in alike),
            of=len(alike),
        )

    def require_phase(self, number: int, phase: Phase) -> TimingFace:
        """Return the trial that is due. ModelError where it is another one, or of another phase."""
        due = self.require_due(number)
        if due.phase != phase:
            raise ModelError(f"trial {number} is not the next one of the {phase}")
        return due

    def after_design(self, event: events.ButtonDesigned) -> TimingState:
        self.require_phase(event.number, "training")
        if event.number in self.designs:
            raise ModelError(f"trial {event.number} has its design")
        return replace(self, designs={**self.designs, event.number: event})

    def after_placing(self, event: events.SwitchPlaced) -> TimingState:
        if self.require_phase(event.number, "validation").hand == "button":
            raise ModelError(f"trial {event.number} has no switch")
        return replace(self, placed=event.number)

    def after_begun(self, event: events.TimedBegun) -> TimingState:
        due, after = (
            self.require_due(event.number),
            self.after_attempt(event.number, event.attempt, event.at_s),
        )
        waits = self.gap_until_s(event.at_s) is not None
        unready = event.number not in self.designs if due.phase == "training" else waits
        if unready or (due.hand != "button" and self.placed != event.number):
            raise ModelError(f"trial {event.number} is not ready to be begun")
        return after

    def after_round(self, event: RoundKept) -> TimingState:
        if self.open != event.number or self.attempts[event.number] != event.attempt:
            raise ModelError(f"trial {event.number} is not under way")
        if event.round != len(self.counting(event.number)) + 1 or event.round > self.plan.trial_rounds:
            raise ModelError(f"round {event.round} of trial {event.number} is not the next one")
        kept = (*self.rounds.get(event.number, ()), event)
        return replace(self, rounds={**self.rounds, event.number: kept})

    def after_trial(self, at_s: float) -> TimingState:
        return replace(super().after_trial(at_s), placed=None)

    def after_scores(self, event: events.TimedScored) -> TimingState:
        self.require_due(event.number)
        if len(self.counting(event.number)) < self.plan.trial_rounds:
            raise ModelError(f"trial {event.number} lacks rounds")
        return replace(self, scores={**self.scores, event.number: event.scores}).after_trial(event.at_s)

    def after_failure(self, event: events.DesignFailed) -> TimingState:
        self.require_phase(event.number, "training")
        return replace(self, failed={**self.failed, event.number: event.reason}).after_trial(event.at_s)

    def after_interruption(self, event: TrialInterrupted) -> TimingState:
        return self.after_loss(event.number, fell=True)

    def after_skip(self, event: TrialSkipped) -> TimingState:
        self.require_phase(event.number, "validation")
        return replace(self, skipped=self.skipped | {event.number}).after_trial(event.at_s)

    def after_training(self, event: events.TrainingEnded) -> TimingState:
        due = self.next_trial
        if not self.training_left or due is None or due.phase == "training":
            raise ModelError("the training is not over")
        return replace(self, trained_s=event.at_s, break_since_s=None, work_since_s=None)

    def after_close(self, event: SessionClosed) -> TimingState:
        return replace(super().after_close(event), placed=None)

    def after_return(self, event: SessionResumed) -> TimingState:
        return replace(super().after_return(event), placed=None)

    handlers: ClassVar[Handlers] = {
        **HANDLERS,
        SessionClosed: after_close,
        SessionResumed: after_return,
        TrialInterrupted: after_interruption,
        TrialSkipped: after_skip,
        events.ButtonDesigned: after_design,
        events.SwitchPlaced: after_placing,
        events.TimedBegun: after_begun,
        RoundKept: after_round,
        events.TimedScored: after_scores,
        events.DesignFailed: after_failure,
        events.TrainingEnded: after_training,
    }

"""A participant's timing session: every press is on the disk before the next step exists."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

from fdvv.errors import ModelError
from fdvv_people.optimize.paper_space import paper_model
from fdvv_people.study.files.people import SealedTrial
from fdvv_people.study.files.seal import KeyHolder
from fdvv_people.study.plan.events import TrialInterrupted, TrialSkipped
from fdvv_people.study.plan.sitting import MOST_FALLS, Step
from fdvv_people.study.plan.trial import Rendered
from fdvv_people.study.session.log import OpenedSession
from fdvv_people.study.session.sitting import Sitting
from fdvv_people.task.pointing import TemporalPointing
from fdvv_people.task.rounds import RoundTiming
from fdvv_people.task.tapping import RapidTapping
from fdvv_people.timing.files.buttons import Button, opened_button
from fdvv_people.timing.files.study import TimingStudy
from fdvv_people.timing.plan import events
from fdvv_people.timing.plan.events import Surface
from fdvv_people.timing.plan.schedule import RANDOM, TimingFace, drawn_seed
from fdvv_people.timing.plan.session import TimingState
from fdvv_people.timing.session.training import own_button, random_button, suggested


@dataclass(frozen=True)
class BegunTrial:
    """A trial that was begun, or goes on.

    Attributes
    ----------
    face : what may be seen of it. attempt : how often it was begun. task : what is played.
    kept, rounds : that count already, and in all.
    button : to be rendered, None of a switch or key. **Secret.**
    """

    face: TimingFace
    attempt: int
    task: TemporalPointing | RapidTapping
    kept: int
    rounds: int
    button: Button | None


@dataclass(frozen=True)
class KeptRound:
    """A round is on the disk.

    Attributes
    ----------
    round : which, from 1. late_ms : of the key against the target; None without one of the two.
    finished : it was the last of its trial.
    """

    round: int
    late_ms: float | None
    finished: bool


class TimingParticipant(Sitting[TimingStudy, TimingState]):
    """Who presses in time, made by `enrol` or `resume`; see `Sitting`."""

    def __init__(
        self, study: TimingStudy, session: OpenedSession[TimingState], clock: Callable[[], float]
    ) -> None:
        super().__init__(study, session, clock)
        self._conditions = {one.number: next(iter(one.labels.values())) for one in session.schedule.trials}
        self._random_seed = drawn_seed(session.schedule.key, RANDOM)
        self._own: dict[str, Button] = {}
        self._advance()

    @classmethod
    def enrol(
        cls,
        study: TimingStudy,
        language: str = "",
        *,
        simulated: bool = False,
        clock: Callable[[], float] = time.time,
    ) -> tuple[TimingParticipant, str]:
        """Enrol a person and start the session; return the code too, for that person's eyes only.

        language : "": the study's first. clock : wall time in seconds. InputError, OSError.
        """
        person, code = study.enrol(language, simulated=simulated)
        return cls.resume(study, person, code, clock=clock), code

    @classmethod
    def resume(
        cls,
        study: TimingStudy,
        person: str,
        code: str | KeyHolder,
        *,
        clock: Callable[[], float] = time.time,
    ) -> TimingParticipant:
        """Resume a session where its log ends. code : the person's, or the key holder in its place.

        InputError on a wrong code, on a person who withdrew, where the session runs elsewhere or where the
        study was changed. OSError.
        """
        return cls(study, OpenedSession(study, person, code, round(clock(), 1), TimingState), clock)

    def place(self, number: int) -> Step[TimingFace]:
        """Log that the switch or key of a trial is under the hand. ModelError where it is not its turn."""
        self._add(events.SwitchPlaced(self._now(), number))
        return self.step()

    def begin(self, number: int, on: Surface) -> BegunTrial:
        """Begin a trial, or go on with one that was broken off; its button is to be put under the hand.

        The design of a training trial is on the disk before it is returned. on : what is pressed.
        ModelError where it is not the next one, InputError, BuildError, OSError.
        """
        face = self.state.require_due(number)
        if face.phase == "training" and number not in self.state.designs:
            design = suggested(self.state, face.level)
            name = self._plan.training.engine if self._plan.training else ""
            self._add(events.ButtonDesigned(self._now(), number, design, name))
        button = self._button(face)
        attempt = self.state.attempts.get(number, 0) + 1
        self._add(events.TimedBegun(self._now(), number, attempt, on))
        kept, rounds = len(self.state.counting(number)), self._plan.trial_rounds
        return BegunTrial(face, attempt, self._plan.task_of(face.level), kept, rounds, button)

    def keep(
        self, number: int, target_s: float | None, activations_s: tuple[float, ...], timing: RoundTiming
    ) -> KeptRound:
        """Log the next round of a trial; score the trial after the last one.

        target_s : when the target was seen; None of tapping. activations_s : when the key went down, rising,
        on the clock of timing.source. ModelError where the trial is not under way, OSError where the round
        cannot be written: then it was not kept.
        """
        counting = self.state.counting(number)
        round_, attempt = len(counting) + 1, self.state.attempts.get(number, 0)
        keys = tuple(sorted(activations_s))
        self._add(events.RoundKept(self._now(), number, attempt, round_, target_s, keys, timing))
        late_ms = 1e3 * (keys[0] - target_s) if keys and target_s is not None else None
        finished = round_ >= self._plan.trial_rounds
        if finished:
            self._score(number)
            self._advance()
        return KeptRound(round_, late_ms, finished)

    def fail(self, number: int, reason: str) -> Step[TimingFace]:
        """Log that the button of a trial cannot be rendered at all; return the step after it.

        In training the engine avoids what is near; a trial of the validation is missing in the analysis.
        """
        self._give_up(self.state.require_due(number), reason)
        return self._advance()

    def interrupt(self, reason: str) -> Step[TimingFace]:
        """Log that the device went away in the trial under way, which goes on later.

        A trial that brings the device down every time is given up.
        """
        if self.state.open is not None:
            face = self.state.require_due(self.state.open)
            self._seal(face, reason)
            self._add(TrialInterrupted(self._now(), face.number, felt=True))
            if self.state.falls[face.number] >= MOST_FALLS:
                self._give_up(face, reason)
        return self._advance()

    def _button(self, face: TimingFace) -> Button | None:
        """Return what a trial renders; None of what lies on the table. **Secret.**"""
        if face.phase == "training":
            return paper_model(self.state.designs[face.number].design, f"trial {face.number + 1}")
        condition = self._plan.condition(self._conditions[face.number])
        if condition.kind == "optimised":
            # what the engine believes no longer changes
            own = self._own.get(face.level) or own_button(self.state, face.level)
            return self._own.setdefault(face.level, own)
        if condition.kind == "random":
            return random_button(self._random_seed)
        return None if condition.on_the_table else opened_button(self.study.folder, condition)

    def _score(self, number: int) -> None:
        """Score a trial whose rounds are all there."""
        face, counting = self.state.require_due(number), self.state.counting(number)
        try:
            scores = self._plan.task_of(face.level).scores([one.press for one in counting])
        except ModelError as error:
            self._give_up(face, str(error))
            return
        self._seal(face)
        self._add(events.TimedScored(self._now(), number, scores))

    def _give_up(self, face: TimingFace, reason: str) -> None:
        if face.phase == "training":
            self._add(events.DesignFailed(self._now(), face.number, reason))
        else:
            self._seal(face, reason)
            self._add(TrialSkipped(self._now(), face.number))

    def _seal(self, face: TimingFace, fault: str = "") -> None:
        """Log, for the key holder, what was behind the code of a trial. Training has none."""
        if face.phase == "validation":
            presses = sum(len(one.activations_s) for one in self.state.counting(face.number))
            condition, faults = self._conditions[face.number], (fault,) if fault else ()
            rendered = Rendered(face.code, condition, presses, faults=faults)
            self._session.seal(SealedTrial(face.number, 0.0, (rendered,)))

    def _pass_over(self) -> None:
        """Score what a killed process left unscored, and log where training is done."""
        while (due := self.state.next_trial) and self._whole(due):
            self._score(due.number)
        if self.state.training_left and due and due.phase == "validation":
            self._add(events.TrainingEnded(self._now()))

    def _whole(self, face: TimingFace) -> bool:
        return len(self.state.counting(face.number)) >= self.state.plan.trial_rounds

"""A participant's timing session: every press is on the disk before the next step exists.

Below it, their own buttons: what the engine suggests next, and what it recommends, from what is on record.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from fdvv.errors import ModelError
from fdvv.model.model import FDVVModel
from fdvv_people.optimize.engines.registry import engine_of
from fdvv_people.optimize.paper_space import paper_model, paper_space
from fdvv_people.optimize.people.week import random_design
from fdvv_people.optimize.problem import Problem, Trial, TrialState
from fdvv_people.optimize.run.player import play_seed
from fdvv_people.study.admin.study import Study
from fdvv_people.study.files.people import SealedTrial
from fdvv_people.study.plan.events import TrialInterrupted, TrialSkipped
from fdvv_people.study.plan.sitting import MOST_FALLS, Step
from fdvv_people.study.plan.trial import Rendered
from fdvv_people.study.session.log import OpenedSession
from fdvv_people.study.session.sitting import Sitting
from fdvv_people.study.timing import events
from fdvv_people.study.timing.buttons import Button, opened_button
from fdvv_people.study.timing.events import Surface
from fdvv_people.study.timing.schedule import RANDOM, TimingFace, drawn_seed
from fdvv_people.study.timing.state import TimingState
from fdvv_people.task.pointing import ASYNCHRONY, TemporalPointing
from fdvv_people.task.rounds import RoundTiming
from fdvv_people.task.tapping import RapidTapping


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


class TimingParticipant(Sitting[TimingState]):
    """Who presses in time, made by `enrol` or `resume`; see `Sitting`."""

    def __init__(self, study: Study, session: OpenedSession, clock: Callable[[], float]) -> None:
        super().__init__(study, session, clock)
        self._conditions = {one.number: next(iter(one.labels.values())) for one in session.schedule.trials}
        self._random_seed = drawn_seed(session.schedule.key, RANDOM)
        self._own: dict[str, Button] = {}
        self._advance()

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


def trials_of(state: TimingState, level: str) -> tuple[Trial, ...]:
    """Return the training of a level so far, as engines read it."""
    faces = [one for one in state.started.trials if one.phase == "training" and one.level == level]
    return tuple(_trial(state, one.number, i) for i, one in enumerate(faces) if one.number in state.designs)


def _trial(state: TimingState, number: int, place: int) -> Trial:
    found = state.designs[number]
    done, failed = state.scores.get(number), state.failed.get(number)
    now = TrialState.DONE if done else TrialState.FAILED if failed is not None else TrialState.SUGGESTED
    return Trial(place, found.design, now, dict(done or {}), reason=failed or "", origin=found.origin)


def suggested(state: TimingState, level: str) -> dict[str, float]:
    """Return the next design of a level. InputError, BuildError where the engine is not installed."""
    training = state.plan.training
    if training is None:
        raise ModelError("the study has no training")
    engine = engine_of(training.engine, training.options)
    (design,) = engine.suggest(_problem(state, level), trials_of(state, level))
    return design


def recommended(state: TimingState, level: str) -> dict[str, float]:
    """Return the design that the engine believes to be best. ModelError where none was scored."""
    training = state.plan.training
    if training is None:
        raise ModelError("the study has no training")
    engine = engine_of(training.engine, training.options)
    return engine.best(_problem(state, level), trials_of(state, level))


def own_button(state: TimingState, level: str) -> FDVVModel:
    return paper_model(recommended(state, level), "optimised")


def random_button(seed: int) -> FDVVModel:
    return paper_model(random_design(paper_space(), seed, 0), "random")


def _problem(state: TimingState, level: str) -> Problem:
    seed = play_seed(state.started.seed, state.plan.all_levels.index(level))
    return Problem(paper_space(), (ASYNCHRONY,), seed)

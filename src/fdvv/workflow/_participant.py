"""A participant's session: every answer is on the disk before the next step exists."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping

from fdvv.errors import DeviceError, ModelError
from fdvv.study import (
    MOST_FALLS,
    Answered,
    BreakEnded,
    Interrupted,
    PageAnswered,
    Shown,
    Skipped,
    Step,
    StudyTrial,
    TrialAnswer,
    TrialFace,
    Value,
    Withdrawn,
    check_answer,
    checked_page,
)
from fdvv.workflow._held_stage import GONE, StageGoneError
from fdvv.workflow._participant_log import open_session
from fdvv.workflow._participant_session import ParticipantSession
from fdvv.workflow._study import Study
from fdvv.workflow._study_seal import Keeper
from fdvv.workflow._study_stage import StudyStage
from fdvv.workflow._trial_stimuli import with_ratio


class Participant(ParticipantSession):
    """A person, or a simulated one, in a study; made by `enrol` or `resume`, for one process at a time.

    The schedule is in memory only. A context manager; not to be used from two threads at once.

    Attributes
    ----------
    study, person, language : who takes part in what.
    """

    @classmethod
    def enrol(
        cls,
        study: Study,
        language: str,
        stage: StudyStage,
        *,
        simulated: bool = False,
        clock: Callable[[], float] = time.time,
    ) -> tuple[Participant, str]:
        """Take somebody in and begin; give the code too, for that person's eyes only.

        language : "": the study's first. stage : what makes labels felt; closed with the participant.
        simulated : nobody sits here. clock : wall time in seconds. InputError, OSError.
        """
        person, code = study.enrol(language, simulated=simulated)
        return cls.resume(study, person, code, stage, clock=clock), code

    @classmethod
    def resume(
        cls,
        study: Study,
        person: str,
        code: str | Keeper,
        stage: StudyStage,
        *,
        clock: Callable[[], float] = time.time,
    ) -> Participant:
        """Go on with a session where its journal ends. code : the person's, or the keeper's key in its place.

        InputError on a wrong code, on somebody who withdrew, where the session runs elsewhere or where the
        study was changed. OSError.
        """
        return cls(study, open_session(study, person, code, round(clock(), 1)), stage, clock)

    @property
    def trial(self) -> TrialFace | None:
        """Get what may be seen of the trial that is shown, or None."""
        return None if self._state.open is None else self._state.began.trials[self._state.open]

    def shown(self, number: int) -> None:
        """Note that a trial is shown, and have it made ready; no label is felt yet.

        A second time, after a page was loaded again, does nothing. ModelError where it is not the next one,
        DeviceError.
        """
        if self._state.open == number and self._trial is not None:
            return
        simulated = self._stage.require().simulated
        attempt = self._state.attempts.get(number, 0) + 1
        self._watch.begin()
        # before it is made ready: how long that takes could tell what is rendered
        self._add(Shown(self._now(), number, attempt, simulated))
        trial = with_ratio(self._plan, self._schedule, self._state, number)
        self._use(trial, lambda: self._stage.prepare(trial))
        self._trial = trial
        self._watch.begin()

    def go_to(self, label: str) -> None:
        """Make a label felt; takes plan.switch_s, whichever it is. InputError, DeviceError, ModelError."""
        trial = self._open()
        self._watch.gone_to(label)
        self._use(trial, lambda: self._stage.show(label))

    def answer(self, number: int, answer: TrialAnswer) -> Step:
        """Keep an answer and what was rendered; give the step after it.

        Switches, presses and time that the answer does not tell are those seen here. Of a trial that was
        answered the first answer stands. InputError where the trial does not ask for such an answer,
        ModelError where it is not shown, OSError where it cannot be kept: then it was not answered.
        """
        if number in self._state.answers:
            return self.step()
        trial = self._open(number)
        check_answer(self._plan, self._state.began.trials[number], answer)
        evidence = self._stage.evidence(trial)
        self._sealed.add(evidence)
        attempt = self._state.attempts[number]
        self._add(Answered(self._now(), number, attempt, self._watch.whole(answer, evidence)))
        self._trial = None
        return self._go_on()

    def answer_page(self, name: str, values: Mapping[str, Value], agreed: bool = True) -> Step:
        """Keep a page's answers; give the step after it.

        Who does not agree on a consent page is out: nothing of them is kept but that they were there.
        InputError, ModelError, OSError.
        """
        if name in self._state.pages:
            return self.step()
        page = next((page for page in self._plan.pages if page.name == name), None)
        if page is None:
            raise ModelError(f"the study has no page {name}")
        if page.when == "consent" and not agreed:
            return self._leave_for_good(PageAnswered(self._now(), name, agreed=False))
        self._add(PageAnswered(self._now(), name, checked_page(self._plan, page, values)))
        return self._go_on()

    def end_break(self) -> Step:
        """Go on after a break, which began by itself; ModelError while it lasts."""
        self._add(BreakEnded(self._now()))
        return self.step()

    def take_stage(self, stage: StudyStage) -> None:
        """Go on with another stage; the trial that was shown is shown again."""
        if self._state.open is not None:
            self._interrupt(self._schedule[self._state.open], "another stage was taken")
        self._stage.take(stage)

    def withdraw(self, delete: bool = True) -> Step:
        """Leave the study for good. delete : all that is kept of the person, but that they were there."""
        return self._leave_for_good(Withdrawn(self._now()), delete)

    def _open(self, number: int | None = None) -> StudyTrial:
        """Give the trial that is shown. ModelError where it is another, or none."""
        if self._trial is None or self._state.open is None or number not in (None, self._state.open):
            raise ModelError("no trial is shown" if number is None else f"trial {number} is not shown")
        return self._trial

    def _use(self, trial: StudyTrial, work: Callable[[], None]) -> None:
        """Have the stage do something for a trial; where it goes away the trial is to be shown again."""
        try:
            work()
        except StageGoneError as error:
            self._interrupt(trial, str(error))
        else:
            return
        raise DeviceError(GONE)

    def _interrupt(self, trial: StudyTrial, reason: str) -> None:
        """Note that a trial is to be shown again, or given up where it brings the device down every time."""
        felt, self._trial = self._watch.felt, None
        self._sealed.add(self._stage.lost(trial, reason))
        self._add(Interrupted(self._now(), trial.number, felt))
        if self._state.falls[trial.number] >= MOST_FALLS:
            self._add(Skipped(self._now(), trial.number))
            self._go_on()

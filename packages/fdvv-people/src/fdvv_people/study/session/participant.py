"""A participant's session: every answer is on the disk before the next step exists."""

from __future__ import annotations

from collections.abc import Callable

from fdvv.errors import DeviceError, ModelError
from fdvv_people.study.admin.study import Study
from fdvv_people.study.plan import events
from fdvv_people.study.plan.events import TrialFace, check_answer
from fdvv_people.study.plan.session import SessionState
from fdvv_people.study.plan.sitting import MOST_FALLS, Step
from fdvv_people.study.plan.trial import StudyTrial, TrialAnswer
from fdvv_people.study.session.log import OpenedSession
from fdvv_people.study.session.sitting import Sitting
from fdvv_people.study.session.trial import (
    GONE,
    ReconnectableRenderer,
    RendererLostError,
    TrialWatch,
    has_ended,
    trial_due,
)
from fdvv_people.study.stimulus.renderer import StimulusRenderer


class Participant(Sitting[SessionState]):
    """Who feels labels and answers, made by `enrol` or `resume`, with a renderer that is closed with it."""

    def __init__(
        self,
        study: Study,
        session: OpenedSession,
        clock: Callable[[], float],
        renderer: StimulusRenderer,
    ) -> None:
        super().__init__(study, session, clock)
        self._trials = session.schedule.trials
        self._renderer = ReconnectableRenderer(self._plan, renderer)
        self._trial: StudyTrial | None = None
        self._watch = TrialWatch(clock)
        self._advance()

    @property
    def trial(self) -> TrialFace | None:
        """What may be seen of the trial that is shown, or None."""
        return None if self.state.open is None else self.state.started.trials[self.state.open]

    def show_trial(self, number: int) -> None:
        """Log that a trial is shown, and prepare its renderings; no label is rendered yet.

        A second time, after a page was loaded again, does nothing. ModelError where it is not the next one,
        DeviceError.
        """
        if self.state.open == number and self._trial is not None:
            return
        simulated = self._renderer.require().simulated
        attempt = self.state.attempts.get(number, 0) + 1
        self._watch.begin()
        # before it is prepared: how long that takes could reveal what is rendered
        self._add(events.TrialShown(self._now(), number, attempt, simulated))
        trial = trial_due(self._plan, self._trials, self.state, number)
        if trial is None:
            raise ModelError(f"the staircase of trial {number} has ended")
        self._use(trial, lambda: self._renderer.prepare(trial))
        self._trial = trial
        self._watch.begin()

    def go_to(self, label: str) -> None:
        """Render a label; takes plan.switch_s, whichever it is. InputError, DeviceError, ModelError."""
        trial = self._open()
        self._watch.gone_to(label)
        self._use(trial, lambda: self._renderer.show(label))

    def answer(self, number: int, answer: TrialAnswer) -> Step[TrialFace]:
        """Log an answer and what was rendered; return the step after it.

        Switches, presses and time that the answer lacks are those observed here. The first answer to a trial
        counts. InputError where the trial does not ask for such an answer, ModelError where it is not shown,
        OSError where it cannot be written: then it was not answered.
        """
        if number in self.state.answers:
            return self.step()
        trial = self._open(number)
        check_answer(self._plan, self.state.started.trials[number], answer)
        evidence = self._renderer.evidence(trial)
        self._session.seal(evidence)
        attempt = self.state.attempts[number]
        self._add(events.TrialAnswered(self._now(), number, attempt, self._watch.whole(answer, evidence)))
        self._trial = None
        return self._advance()

    def reconnect(self, renderer: StimulusRenderer) -> None:
        """Continue with another renderer; the trial that was shown is shown again."""
        if self.state.open is not None:
            self._interrupt(self._trials[self.state.open], "another stage was taken")
        self._renderer.replace(renderer)

    def _pass_over(self) -> None:
        """Pass over the trials of staircases that have converged."""
        while trial := self.state.next_trial:
            if not has_ended(self._plan, self._trials, self.state, trial.number):
                return
            self._add(events.StaircaseConverged(self._now(), trial.item, trial.round))

    def _put_away(self) -> None:
        self._renderer.drop()

    def _open(self, number: int | None = None) -> StudyTrial:
        """Return the trial that is shown. ModelError where it is another, or none."""
        if self._trial is None or self.state.open is None or number not in (None, self.state.open):
            raise ModelError("no trial is shown" if number is None else f"trial {number} is not shown")
        return self._trial

    def _use(self, trial: StudyTrial, work: Callable[[], None]) -> None:
        try:
            work()
        except RendererLostError as error:
            self._interrupt(trial, str(error))
        else:
            return
        # outside of the except block: the cause must not be chained to the public error
        raise DeviceError(GONE)

    def _interrupt(self, trial: StudyTrial, reason: str) -> None:
        """Log that a trial is to be shown again, or given up where it brings the device down every time."""
        felt, self._trial = self._watch.felt, None
        self._session.seal(self._renderer.lost(trial, reason))
        self._add(events.TrialInterrupted(self._now(), trial.number, felt))
        if self.state.falls[trial.number] >= MOST_FALLS:
            self._add(events.TrialSkipped(self._now(), trial.number))
            self._advance()

"""The stage that a participant holds: it may go away in the middle of a trial."""

from __future__ import annotations

import contextlib

from fdvv.errors import DeviceError
from fdvv.study import StudyPlan, StudyTrial
from fdvv.workflow._sealed_trial import lost_trial
from fdvv.workflow._study_people import SealedTrial
from fdvv.workflow._study_stage import StudyStage
from fdvv.workflow._trial_stimuli import trial_stimuli

GONE = "the device went away; connect it again: the trial goes on"
"""All that is told of it: why could tell what was rendered, and is kept under the seal."""


class StageGoneError(Exception):
    """The stage cannot be used any more; its text is **secret**."""


class HeldStage:
    """A stage, until it goes away; then what it is asked for raises StageGoneError."""

    def __init__(self, plan: StudyPlan, stage: StudyStage) -> None:
        self._plan = plan
        self._stage: StudyStage | None = stage

    def require(self) -> StudyStage:
        """Give the stage. DeviceError where there is none."""
        if self._stage is None:
            raise DeviceError(GONE)
        return self._stage

    def prepare(self, trial: StudyTrial) -> None:
        """Make ready what a trial's labels hide."""
        stimuli = trial_stimuli(self._plan, trial)
        try:
            self._there().prepare(stimuli)
        except DeviceError as error:
            raise self._gone(error) from None

    def show(self, label: str) -> None:
        """Make a label felt."""
        try:
            self._there().show(label)
        except DeviceError as error:
            raise self._gone(error) from None

    def evidence(self, trial: StudyTrial) -> SealedTrial:
        """Give what was rendered in a trial; that it was lost, where the stage goes away now."""
        try:
            return SealedTrial(trial.number, trial.ratio, self._there().rendered())
        except (DeviceError, StageGoneError) as error:
            self.drop()
            return self.lost(trial, str(error))

    def lost(self, trial: StudyTrial, reason: str) -> SealedTrial:
        """Give a trial of which nothing can be told, and why."""
        names = {label: one.name for label, one in trial_stimuli(self._plan, trial).items()}
        return lost_trial(SealedTrial(trial.number, trial.ratio, ()), names, reason)

    def take(self, stage: StudyStage) -> None:
        """Hold another stage."""
        self.drop()
        self._stage = stage

    def drop(self) -> None:
        """Let go of the stage; a second time does nothing."""
        if self._stage is not None:
            # what is gone cannot be closed in order
            with contextlib.suppress(DeviceError, OSError):
                self._stage.close()
        self._stage = None

    def _there(self) -> StudyStage:
        if self._stage is None:
            raise StageGoneError("it went away before")
        return self._stage

    def _gone(self, error: DeviceError) -> StageGoneError:
        self.drop()
        return StageGoneError(str(error))

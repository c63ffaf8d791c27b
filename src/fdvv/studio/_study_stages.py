"""What makes labels felt at one screen: what the operator chose, lent to that screen alone."""

from __future__ import annotations

from fdvv.errors import DeviceError, InputError
from fdvv.studio import _messages_study as m
from fdvv.studio._contract import Tell
from fdvv.studio._jobs import SharedLeases
from fdvv.studio._studies import TWIN, Studies
from fdvv.studio._studio import Studio
from fdvv.studio._study_told import frame_told
from fdvv.workflow import PersonFrame, ScreenStage, Study, open_screen_stage


class StudyStages:
    """Opens stages for one screen, and holds the lease of the device they use. tell : to that screen."""

    def __init__(self, studio: Studio, tell: Tell) -> None:
        self._studies, self._tell = studio.part(Studies), tell
        self._leases, self._leased = studio.part(SharedLeases), ""

    def open(self, study: Study) -> ScreenStage:
        """Open what the operator chose. InputError where it is used elsewhere, DeviceError."""
        device = self._studies.device(study.folder.name)
        if device not in (TWIN, self._leased):
            self.release()
            self._leases.take(device, f"the study {study.folder.name}")
            self._leased = device
        return open_screen_stage(device, study.folder, self._show, self._broke, study.plan.switch_s)

    def first(self, study: Study) -> ScreenStage:
        """Open a stage for somebody who sits down. InputError where it cannot be had."""
        try:
            return self.open(study)
        except DeviceError as error:
            self.release()
            raise InputError("study", "device", str(error), "ask who leads the study") from error

    def release(self) -> None:
        """Let others use the device."""
        if self._leased:
            self._leases.give_back(self._leased)
            self._leased = ""

    def _show(self, frame: PersonFrame) -> None:
        if frame.t_s.size:  # else this machine was busy, and no time has passed
            self._tell(frame_told(frame))

    def _broke(self, _line: str) -> None:
        """Tell that the button is set up anew; why could tell what was rendered."""
        self._tell(m.StudyBroke())

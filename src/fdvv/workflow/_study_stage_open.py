"""The stage that a participant's screen is given: the twin under their hand, or a device on the table."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from fdvv.errors import InputError
from fdvv.program import Signal
from fdvv.twin import NEAR_1_s
from fdvv.workflow._devices import open_device
from fdvv.workflow._study_person_frame import PersonFrame
from fdvv.workflow._study_stage import StudyStage
from fdvv.workflow._study_stage_device import DeviceStage
from fdvv.workflow._study_stage_person import PersonStage

TWIN = "twin"


class ScreenStage(StudyStage, Protocol):
    """A stage that a screen can lead the hand of, where there is a hand on the screen."""

    @property
    def problem(self) -> str:
        """Tell in one line why the stage has ended; "" while it has not."""

    @property
    def travel_mm(self) -> float:
        """Give the scale of the trial's drawing; 0: there is nothing to draw, the button is on the table."""

    @property
    def sounds(self) -> tuple[Signal, ...]:
        """Give what clicks of this trial name by place; none of a device, which shakes the cap itself."""

    def lead(
        self, referent_mm: float, velocity_mm_s: float = 0.0, near_1_s: float = NEAR_1_s, sequence: int = 0
    ) -> None:
        """Lead the finger to a place."""
        ...

    def push(self, force_cN: float, sequence: int = 0) -> None:
        """Lead the force that the finger pushes with."""
        ...

    def lift(self, sequence: int | None = None) -> None:
        """Take the finger off."""
        ...

    def here(self) -> None:
        """Somebody looks."""
        ...

    def pause(self) -> None:
        """Nobody looks."""
        ...


class TableStage(DeviceStage):
    """A device on the table beside the screen: the screen leads no finger and draws no button."""

    travel_mm = 0.0
    sounds: tuple[Signal, ...] = ()

    def lead(
        self, referent_mm: float, velocity_mm_s: float = 0.0, near_1_s: float = NEAR_1_s, sequence: int = 0
    ) -> None:
        """Do nothing: the finger is the participant's own."""

    def push(self, force_cN: float, sequence: int = 0) -> None:
        """Do nothing."""

    def lift(self, sequence: int | None = None) -> None:
        """Do nothing."""

    def here(self) -> None:
        """Do nothing: a device renders whether or not a page is looked at."""

    def pause(self) -> None:
        """Do nothing."""


def open_screen_stage(
    spec: str,
    folder: Path,
    show: Callable[[PersonFrame], None],
    failed: Callable[[str], None],
    switch_s: float,
) -> ScreenStage:
    """Open the stage for a participant's screen.

    spec : "twin", or a device that keeps labels ready side by side ("serial:PORT", "host").
    folder, show, failed, switch_s : as of PersonStage. Raises InputError, DeviceError.
    """
    if spec == TWIN:
        return PersonStage(folder, show, failed, switch_s)
    device = open_device(spec)
    try:
        return TableStage(device, folder, switch_s, failed=failed)
    except InputError:
        if hasattr(device, "close"):
            device.close()
        raise

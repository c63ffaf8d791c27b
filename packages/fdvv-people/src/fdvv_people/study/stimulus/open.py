"""The renderer behind a participant's screen: the twin under their hand, or a device on the table."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from fdvv.errors import InputError
from fdvv.program.program import Signal
from fdvv.rendering.tuning import open_device
from fdvv.twin.plant import NEAR_1_s
from fdvv_people.study.stimulus.device import DeviceRenderer
from fdvv_people.study.stimulus.renderer import StimulusRenderer
from fdvv_people.study.stimulus.twin import PersonFrame, TwinRenderer

TWIN = "twin"


class ScreenRenderer(StimulusRenderer, Protocol):
    """A renderer whose simulated finger, if it has one, is led from the screen."""

    @property
    def travel_mm(self) -> float:
        """Scale of the trial's drawing; 0: there is nothing to draw, the button is on the table."""

    @property
    def sounds(self) -> tuple[Signal, ...]:
        """The sounds that the clicks of this trial refer to by index; none of a device."""

    def lead(
        self, referent_mm: float, velocity_mm_s: float = 0.0, near_1_s: float = NEAR_1_s, sequence: int = 0
    ) -> None:
        """Lead the finger to a place."""

    def push(self, force_cN: float, sequence: int = 0) -> None:
        """Set the force that the finger pushes with."""

    def lift(self, sequence: int | None = None) -> None:
        """Lift the finger off."""

    def here(self) -> None:
        """Note that the page is looked at."""

    def pause(self) -> None:
        """Note that the page is not looked at."""


class TableDeviceRenderer(DeviceRenderer):
    """A device on the table beside the screen: the screen leads no finger and draws no button."""

    travel_mm = 0.0
    sounds: tuple[Signal, ...] = ()

    def _ignore(self, *_positional: object, **_named: object) -> None:
        """Do nothing: the finger is the participant's own."""

    lead = push = lift = here = pause = _ignore


def open_screen_renderer(
    spec: str,
    folder: Path,
    show: Callable[[PersonFrame], None],
    failed: Callable[[str], None],
    switch_s: float,
) -> ScreenRenderer:
    """Open the renderer of a participant's screen.

    spec : "twin", or a device that keeps labels ready side by side ("serial:PORT", "host").
    folder, show, failed, switch_s : as of TwinRenderer. Raises InputError, DeviceError.
    """
    if spec == TWIN:
        return TwinRenderer(folder, show, failed, switch_s)
    device = open_device(spec)
    try:
        return TableDeviceRenderer(device, folder, switch_s, failed=failed)
    except InputError:
        if hasattr(device, "close"):
            device.close()
        raise

"""What every supplier of presses promises: twin, emulated board, real rig."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from fdvv.model import ForceSurface, Press


@dataclass(frozen=True)
class DeviceInfo:
    """Who is at the other end.

    Attributes
    ----------
    name : kind of device.
    simulated : its presses come from the twin.
    force_limit_cN : the largest command it will follow.
    travel_limit_mm : the deepest stop it can set.
    tick_s : period of its control loop.
    """

    name: str
    simulated: bool
    force_limit_cN: float
    travel_limit_mm: float
    tick_s: float


class Device(Protocol):
    """Accepts tables of force and yields presses. Errors are DeviceError."""

    def info(self) -> DeviceInfo:
        """Tell who this is."""
        ...

    def upload(self, surface: ForceSurface, travel_mm: float) -> None:
        """Make surface the active command table and set the stop, whole or not at all.

        The surface holds actuation as force (cN) in the device's own coordinates: what the motor is
        told to push with. Raises DeviceError on a table beyond the limits.
        """
        ...

    def press(self, velocity_mm_s: float) -> Press:
        """Have the participant press once at a mean speed; every call is a fresh, varied press."""
        ...

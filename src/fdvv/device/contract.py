"""What every supplier of presses promises: twin, emulated board, real rig."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from fdvv.model import ForceSurface, Press
from fdvv.protocol import Fault, Settings


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

    def settings(self) -> Settings:
        """Give calibration and limits as the device holds them."""
        ...

    def configure(self, settings: Settings) -> None:
        """Replace calibration and limits, whole or not at all; upload again afterwards.

        Raises DeviceError with the device's reason.
        """
        ...

    def upload(self, surface: ForceSurface, travel_mm: float, paced: bool = False) -> None:
        """Make surface the active command table and set the stop, whole or not at all.

        The surface holds actuation as force (cN) in the device's own coordinates: what the motor is
        told to push with. Its row is that of the velocity decided in the press; of the announced one,
        which is the one asked for, if paced. Raises DeviceError on a table beyond the limits.
        """
        ...

    def press(self, velocity_mm_s: float) -> Press:
        """Have the participant press once at a mean speed; every call is a fresh, varied press."""
        ...


@dataclass(frozen=True)
class FaultReport:
    """Why a device fell to zero force.

    Attributes
    ----------
    fault : what was found wrong; Fault.NONE if nothing is.
    value, bound : what was found and what was allowed, in the device's units.
    time_s : device clock.
    displacement_mm, commanded_cN : at that tick, before the force fell to zero.
    faults : latched since the device booted.
    """

    fault: Fault
    value: int
    bound: int
    time_s: float
    displacement_mm: float
    commanded_cN: float
    faults: int

    def __str__(self) -> str:
        if self.fault is Fault.NONE:
            return "no fault"
        return (
            f"{self.fault.name.lower()}: {self.value}, allowed {self.bound}, "
            f"at {self.displacement_mm:.3f} mm and {self.commanded_cN:.1f} cN, "
            f"{self.time_s:.3f} s on the device's clock"
        )


class ProgramDevice(Device, Protocol):
    """A device that runs programs: everything with the firmware in it."""

    def upload_program(self, image: bytes) -> None:
        """Make a program (fdvv.program, protocol/fdvv.toml) the active one, whole or not at all.

        Raises DeviceError with the device's reason.
        """
        ...

    def stop(self) -> None:
        """Fall to zero force at once; allowed at any time."""
        ...

    def fault(self) -> FaultReport:
        """Tell the latched fault."""
        ...

    def clear_fault(self) -> None:
        """Clear the latched fault; DeviceError while its cause lasts."""
        ...

    def close(self) -> None:
        """Stop, and let the device go; a second time does nothing."""
        ...

"""The protocol of devices (twin, emulated board, real rig), and the limits they share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from fdvv.errors import DeviceError, PartFault
from fdvv.force_text import force_text
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.protocol.tables import CellSpec, Fault, ForceLoopGains, Settings

SPEED_LIMITS_mm_s = (0.5, 500.0)
"""From a machine that probes statically, as the paper's did, to more than a finger does."""

FREE_CELL_cN = 3.0
"""A sound load cell reads no more than this under a cap that nothing touches."""


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
        """Return who this is."""

    def settings(self) -> Settings:
        """Return calibration and limits as the device holds them."""

    def configure(self, settings: Settings) -> None:
        """Replace calibration and limits, whole or not at all; upload again afterwards. DeviceError."""

    def upload(self, surface: ForceSurface, travel_mm: float, paced: bool = False) -> None:
        """Make surface the active command table and set the stop, whole or not at all.

        The surface holds actuation as force (cN) in the device's own coordinates: what the motor is
        commanded to push with. Its row is that of the velocity decided in the press; of the announced one,
        which is the one asked for, if paced. Raises DeviceError on a table beyond the limits.
        """

    def press(self, velocity_mm_s: float) -> Press:
        """Have the participant press once at a mean speed; every call is a fresh, varied press."""


WHAT_TO_LOOK_AT = {
    Fault.THERMISTOR_OPEN: "the coil's thermistor RT1 or its wire is open; it measures 10 kohm at 25 C",
    Fault.THERMISTOR_SHORT: "the coil's thermistor RT1 or its wire is shorted; it measures 10 kohm at 25 C",
    Fault.THERMISTOR_JUMP: "the reading of the coil's thermistor RT1 jumped; look for a loose wire",
    Fault.THERMISTOR_COLD: (
        "the coil's thermistor RT1 stays cold while the coil should warm; glue it to the winding again, "
        "or look why the coil gets no current"
    ),
}
"""The part behind a fault whose name does not say enough."""

POSITION, SUPPLY, DRIVER = "position sensor", "supply", "coil driver"
FAULTY_PARTS = {
    Fault.POSITION_LOW: (POSITION, "look for a wire that is off or shorted"),
    Fault.POSITION_HIGH: (POSITION, "look for a wire that is off or shorted"),
    Fault.POSITION_STUCK: (POSITION, "look at its cable, its supply and its conditioner"),
    Fault.POSITION_JUMP: (POSITION, "look for a loose wire; part its wires from the coil's"),
    Fault.SUPPLY_LOW: (SUPPLY, "measure it under load; look at joints, fuse and stop button"),
    Fault.SUPPLY_HIGH: (SUPPLY, "measure it, and the divider that the board reads it by"),
    Fault.BROWN_OUT: (SUPPLY, "measure it under load; look at joints and fuse"),
    Fault.OUTPUT: (
        DRIVER,
        "look for a short of the coil's wires; feel whether it is hot; an M4 needs 3.3 V at AREF",
    ),
    Fault.VIBRATION_BOARD: ("vibration board", "look at its cable and its power"),
    **{fault: ("thermistor", text) for fault, text in WHAT_TO_LOOK_AT.items()},
}
"""Part behind a fault of the firmware, and what to do; other faults are no part's."""


class PressError(DeviceError):
    """A press that failed, with what was recorded of it until then; None if nothing was."""

    def __init__(self, text: str, press: Press | None) -> None:
        self.press = press
        super().__init__(text)


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
            f"at {self.displacement_mm:.3f} mm and {force_text(self.commanded_cN, '.1f')}, "
            f"{self.time_s:.3f} s on the device's clock{self._part}"
        )

    @property
    def part_fault(self) -> PartFault | None:
        """The part behind it; None if it is no part's."""
        if self.fault not in FAULTY_PARTS:
            return None
        part, remedy = FAULTY_PARTS[self.fault]
        name = self.fault.name.lower()
        return PartFault(part, f"the {part} failed ({name}: {self.value}, allowed {self.bound})", remedy)

    @property
    def _part(self) -> str:
        return f" ({WHAT_TO_LOOK_AT[self.fault]})" if self.fault in WHAT_TO_LOOK_AT else ""


@runtime_checkable
class ForceLoopDevice(Device, Protocol):
    """A device that can hold the force at the finger by a load cell in its cap."""

    @property
    def load_cell(self) -> CellSpec | None:
        """The cell, from its data sheet; None if this rig has none, and therefore no loop."""

    @property
    def loop(self) -> ForceLoopGains | None:
        """The gains with which the loop is closed; None while it is open."""

    def close_loop(self, gains: ForceLoopGains | None) -> None:
        """Close the loop, or open it; upload again afterwards. DeviceError without a cell."""


class ProgramDevice(Device, Protocol):
    """A device that runs programs: everything with the firmware in it."""

    def upload_program(self, image: bytes) -> None:
        """Make a program (protocol/fdvv.toml) the active one, whole or not at all. DeviceError."""

    def stop(self) -> None:
        """Fall to zero force at once; allowed at any time."""

    def fault(self) -> FaultReport:
        """Return the latched fault."""

    def clear_fault(self) -> None:
        """Clear the latched fault; DeviceError while its cause lasts."""

    def close(self) -> None:
        """Stop, and let the device go; a second time does nothing."""


def check_table(info: DeviceInfo, surface: ForceSurface, travel_mm: float) -> None:
    """Refuse a table or travel beyond the limits. DeviceError."""
    largest = max(float(np.abs(table).max()) for table in (surface.press_cN, surface.release_cN))
    if largest > info.force_limit_cN:
        raise DeviceError(
            f"{info.name}: the table reaches {force_text(largest, '.4g')}, the limit is "
            f"{force_text(info.force_limit_cN)}; "
            "clip the table before uploading it"
        )
    check_travel(info, travel_mm)


def check_travel(info: DeviceInfo, travel_mm: float) -> None:
    """Refuse a travel that the stop cannot set. DeviceError."""
    if not 0 < travel_mm <= info.travel_limit_mm:
        raise DeviceError(
            f"{info.name}: travel {travel_mm:g} mm is not within 0 to {info.travel_limit_mm:g} mm; "
            "choose a travel that the stop can set"
        )


def check_speed(name: str, velocity_mm_s: float) -> None:
    """Refuse an absurd speed of a press on the device of that name. DeviceError."""
    low, high = SPEED_LIMITS_mm_s
    if not low <= velocity_mm_s <= high:
        raise DeviceError(f"{name}: speed {velocity_mm_s:g} mm/s is not within {low:g} to {high:g} mm/s")

"""What comes of asking for a press: a record, what was recorded of a failed one, a fault of the board."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import cast

from fdvv.device.contract import Device, FaultReport, PressError, ProgramDevice
from fdvv.errors import DeviceError, PartFault, PartFaultError
from fdvv.model.press import Press
from fdvv.protocol.tables import Fault


@dataclass(frozen=True, eq=False)
class PressMade:
    """What came of asking for a press.

    press : as far as it was recorded. error : why it failed. faulted : the board fell to zero force, part :
    for that one.
    """

    press: Press | None
    error: DeviceError | None = None
    faulted: bool = False
    part: PartFault | None = None

    @property
    def reason(self) -> str:
        return str(self.part or self.error or "")


def attempt_press(device: Device, velocity_mm_s: float) -> PressMade:
    """Ask for a press. Raises DeviceError where nothing is known of it and the board has no fault."""
    try:
        return PressMade(device.press(velocity_mm_s))
    except DeviceError as error:
        if _has_fault(device):
            return PressMade(None, error, True, cast(ProgramDevice, device).fault().part_fault)
        if isinstance(error, PressError) and error.press:
            return PressMade(error.press, error)
        raise


def clear_latched(device: Device, notice: Callable[[str], None]) -> None:
    """Clear a latched fault, with a notice. Raises DeviceError while its cause lasts."""
    if _has_fault(device):
        part = cast(ProgramDevice, device).fault().part_fault
        try:
            report = _clear_fault(device)
        except DeviceError as error:
            raise (PartFaultError(part) if part else error) from error
        notice(f"warning: {device.info().name} had fallen to zero force, {report}; cleared")


def lasting_part(device: Device, part: PartFault | None, last: PartFault | None) -> PartFault | None:
    """Clear the board's fault; return its part if the fault lasts, or is that of the press before too.

    Raises DeviceError if the fault of no part lasts.
    """
    try:
        _clear_fault(device)
    except DeviceError:
        if part is None:
            raise
        return part
    return part if part and last and last.part == part.part else None


def _has_fault(device: Device) -> bool:
    """Return whether the device is connected and has a latched fault."""
    try:
        return hasattr(device, "fault") and device.fault().fault is not Fault.NONE
    except DeviceError:
        return False


def _clear_fault(device: Device) -> FaultReport:
    """Clear and return the fault of a device. Raises DeviceError while its cause lasts."""
    board = cast(ProgramDevice, device)
    report = board.fault()
    board.clear_fault()
    return report

"""What is put on a device that is held open, and how it and its presses are told."""

from __future__ import annotations

import msgspec

from fdvv.device import FaultReport, Remote
from fdvv.errors import InputError
from fdvv.model import FDVVModel, ForceSurface, Press
from fdvv.program import button_program, compile_program
from fdvv.protocol import Fault
from fdvv.studio._drawn import partly, rounded
from fdvv.studio._held_device import HeldDevice, mode_of
from fdvv.studio._messages_device import DeviceStanding, PressSeen
from fdvv.workflow import CompensationResult, felt_press, intended_press, settings_with

STEP_mm = 0.05


def with_faults(known: DeviceStanding, remote: Remote) -> DeviceStanding:
    """Add the mode, the latched fault and what is missing."""
    telemetry, report = remote.client.telemetry, remote.fault()
    return msgspec.structs.replace(
        known,
        mode="fault" if report.fault is not Fault.NONE else mode_of(remote),
        fault=_fault_line(report),
        missing_ticks=telemetry.missing_ticks,
        late_ticks=telemetry.late_ticks,
        missing_frames=telemetry.missing_frames,
        lost_records=telemetry.lost_records,
    )


def _fault_line(report: FaultReport) -> str:
    return "" if report.fault is Fault.NONE else str(report)


def put_button(
    held: HeldDevice, model: FDVVModel, learned: CompensationResult | None, speeds_mm_s: list[float]
) -> None:
    """Put a button on a device: what was learned under its tuning, or the button's own program."""
    device = held.device
    if learned:
        wanted = settings_with(device.settings(), learned.outcome.tuning)
        if wanted != device.settings():
            device.configure(wanted)
        device.upload(learned.surface, learned.travel_mm, learned.outcome.tuning.paced)
        return
    if not model.of("press"):
        raise InputError(model.name, "curves", "it has no press, there is nothing to render", "give it one")
    program = button_program(model, ForceSurface.of_model(model, speeds_mm_s, STEP_mm))
    device.upload_program(compile_program(program).image)  # type: ignore[attr-defined]  # all that are listed do


def press_seen(press: Press, model: FDVVModel, velocity_mm_s: float) -> PressSeen:
    """Give what is shown of a press."""
    felt, wanted = felt_press(press, model.travel_mm), intended_press(model, velocity_mm_s)
    return PressSeen(
        velocity_mm_s,
        press.simulated,
        rounded(felt.displacement_mm),
        partly(felt.press_cN),
        partly(felt.release_cN),
        rounded(wanted.press_cN),
        rounded(wanted.release_cN),
    )

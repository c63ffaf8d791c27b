"""A drive without bytes, on a clock of its own, so that a loop does the same on any machine; simulated."""

from __future__ import annotations

from typing import Literal

from fdvv_drives.device import DriveDevice
from fdvv_drives.drive import LostAnswerError, Reading
from fdvv_drives.stage import Coil, Limits, Loop, Mechanics, Stage
from fdvv_drives.testing.plant import LivePlant

EXCHANGE_s = 3e-4


class VirtualClock:
    def __init__(self) -> None:
        self.time_s = 1.0

    def now_s(self) -> float:
        return self.time_s

    def sleep(self, duration_s: float) -> None:
        self.time_s += duration_s


class DirectDrive:
    """Moves a simulated cap directly, and notes what it was commanded.

    Attributes
    ----------
    torque : that acts now, Nm. commanded : all of them. lose : so many of the next answers are lost.
    moved_mm : by how much the position is wrong; drift_mm : more of it with every answer.
    held_s : the next answer is held up for so long. calls : what was asked of it, in order.
    """

    name: str = "direct"
    watchdog_s: float | None = 0.05
    senses_force = False

    def __init__(self, clock: VirtualClock, stage: Stage) -> None:
        self._clock, self._stage = clock, stage
        self.plant = LivePlant(stage.mechanics.travel_mm)
        self.torque, self.heard_s, self.enabled = 0.0, clock.time_s, False
        self.commanded: list[float] = []
        self.calls: list[Literal["enable", "stop", "close"]] = []
        self.held_s = 0.0
        self.lose, self.moved_mm, self.drift_mm, self.has_watchdog = 0, 0.0, 0.0, True

    def enable(self) -> None:
        self.calls.append("enable")
        self.enabled, self.torque, self.heard_s = True, 0.0, self._clock.time_s

    def exchange(self, torque: float) -> Reading:
        assert self.enabled
        self._clock.sleep(EXCHANGE_s)
        self.plant.advance(self._clock.time_s, self._stage.force_N(self.torque))
        self.torque, self.heard_s = torque, self._clock.time_s
        self.commanded.append(torque)
        self.moved_mm += self.drift_mm
        moved_mm = self.plant.x_mm + self.moved_mm
        position = self._stage.mechanics.direction * moved_mm / self._stage.mm_unit
        self._clock.sleep(self.held_s)
        self.held_s = 0.0
        if self.lose:
            self.lose -= 1
            raise LostAnswerError(f"{self.name}: no answer")
        return Reading(position, torque)

    def has_fallen(self) -> bool:
        return self.has_watchdog and self._clock.time_s - self.heard_s > (self.watchdog_s or 1e9)

    def stop(self) -> None:
        self.calls.append("stop")
        self.torque, self.enabled = 0.0, False

    def close(self) -> None:
        self.calls.append("close")


def direct_stage(coil: Coil | None = None, **limits: float) -> Stage:
    mechanics = Mechanics(travel_mm=6.0, lead_mm_rev=10.0, force_N_Nm=500.0, zero_rev=0.0, simulated=True)
    found = Limits(**{"force_N": 3.0, **limits})  # type: ignore[arg-type]
    return Stage(mechanics, found, coil, Loop(rate_Hz=1000.0, patience_s=3.0))


def direct_device(
    stage: Stage | None = None, has_cell: bool = False
) -> tuple[DriveDevice, DirectDrive, VirtualClock]:
    """Make a device whose simulated hand presses when the cap is up; with a load cell, or without."""
    stage, clock = stage or direct_stage(), VirtualClock()
    drive = DirectDrive(clock, stage)
    force_cN = (lambda: 100 * drive.plant.finger_N) if has_cell else None
    device = DriveDevice(stage, drive, force_cN, drive.plant.press, clock)
    return device, drive, clock

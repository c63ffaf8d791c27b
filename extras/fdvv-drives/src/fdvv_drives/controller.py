"""The firmware's core in this process: estimator, table, and the guards that a drive has readings for."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from fdvv.device.contract import FaultReport
from fdvv.errors import DeviceError, ModelError
from fdvv.firmware.core import INPUTS, Core, CoreRequest
from fdvv.protocol.messages import CN64_PER_cN, MM_S16_PER_mm_s, UM16_PER_mm
from fdvv.protocol.tables import Fault, Mode, Settings, TickFlag
from fdvv_drives.stage import COUNTS_READING, Stage

FORCE_ZERO_counts = 32768
FORCE_GAIN_q14 = 2**14
"""Of a force sensor: one count is 1/64 cN."""
LONGEST_GAP_ticks = 65535
GUARDS = {"reading_low": -1, "reading_high": 1, "late_ticks": 1}
"""Settings that the stage file bounds: from below (-1) or above."""


class Step(NamedTuple):
    """What the core made of one answer of the drive.

    Attributes
    ----------
    displacement_mm : as its settings calibrate it. commanded_cN : the new command, 0 in a fault. limited :
        it was cut.
    """

    displacement_mm: float
    commanded_cN: float
    limited: bool


class Controller:
    """The core that a board runs, on a stage.

    There is no supply, thermistor, watchdog or host link to guard; what guards them on a board is not here.
    """

    def __init__(self, stage: Stage, has_force_sensor: bool) -> None:
        self._stage = stage
        settings = stage.own_settings()
        if has_force_sensor:
            settings = with_force_sensor(settings)
        self._core = Core(settings, limits=stage.board_limits())
        self._core.ask(CoreRequest.BOOTED)
        self._inputs = np.zeros(1, INPUTS)
        self._inputs["supply_mV"] = settings.nominal_supply_mV
        self._inputs["force_counts"] = FORCE_ZERO_counts

    @property
    def settings(self) -> Settings:
        return self._core.settings

    def configure(self, settings: Settings) -> None:
        """Use other settings and forget the table. DeviceError if the core refuses them."""
        if settings.tick_us != self._stage.tick_us:
            raise DeviceError(
                f"{self._stage.source}: a tick of {settings.tick_us} us; its loop has "
                f"{self._stage.tick_us} us, from rate_Hz of the stage file"
            )
        self._refuse_looser(settings)
        if bool(settings.force_gain_q14) != bool(self.settings.force_gain_q14):
            raise DeviceError(f"{self._stage.source}: settings cannot add or take away a force sensor")
        try:
            self._core.set(settings)
        except ModelError as error:
            raise DeviceError(str(error)) from error
        self._core.activate(None)

    def _refuse_looser(self, settings: Settings) -> None:
        """Refuse settings beyond the stage file, in what no limits of a board bound. DeviceError."""
        own = self._stage.own_settings()
        for name, sign in GUARDS.items():
            asked, allowed = getattr(settings, name), getattr(own, name)
            if sign * asked > sign * allowed:
                raise DeviceError(
                    f"{self._stage.source}: {name} is {asked}, the stage file allows {allowed}; "
                    "settings can only be tighter"
                )

    def activate(self, image: bytes) -> None:
        try:
            self._core.activate(image)
        except ModelError as error:
            raise DeviceError(str(error)) from error

    def announce(self, velocity_mm_s: float) -> None:
        self._core.announce(round(MM_S16_PER_mm_s * velocity_mm_s))

    def arm(self) -> None:
        """Let the next step command force. DeviceError with the latched fault."""
        if self._core.mode is Mode.FAULT or self._core.fault is not Fault.NONE:
            raise DeviceError(f"{self.report()}; clear the fault, or open the device again")
        self._core.arm()

    def disarm(self) -> None:
        self._core.disarm()

    def check_speed(self, moved_mm: float, took_s: float) -> None:
        """Latch position_jump where the cap moved further than the stage file allows in this time."""
        allowed_mm = self._stage.limits.velocity_mm_s * took_s
        if abs(moved_mm) > allowed_mm:
            values = round(UM16_PER_mm * abs(moved_mm)), round(UM16_PER_mm * allowed_mm)
            self._core.fail(Fault.POSITION_JUMP, *values)

    @property
    def has_failed(self) -> bool:
        """Return whether a fault is latched: then there is no force."""
        return self._core.mode is Mode.FAULT

    def clear(self) -> None:
        """Clear the latched fault; DeviceError while its cause lasts."""
        refusal = self._core.ask(CoreRequest.CLEAR, int(self._core.fault))
        if refusal:
            raise DeviceError(f"{self._stage.source}: the fault is not cleared: {refusal.name.lower()}")

    def step(self, displacement_mm: float, force_cN: float, ticks: int, time_us: int) -> Step:
        """Run one tick of the core, so many after the last."""
        inputs, counts = self._inputs, self._stage.counts(displacement_mm)
        inputs["time_us"] = time_us % 2**32
        inputs["sum"] = counts
        inputs["lowest"] = inputs["highest"] = counts // COUNTS_READING
        inputs["elapsed_ticks"] = min(LONGEST_GAP_ticks, max(1, ticks))
        inputs["force_counts"] = min(65535, max(0, round(CN64_PER_cN * force_cN) + FORCE_ZERO_counts))
        output = self._core.run(inputs)[0]
        return Step(
            float(output["displacement_um16"]) / UM16_PER_mm,
            float(output["commanded_cN64"]) / CN64_PER_cN,
            bool(output["flags"] & TickFlag.LIMITED),
        )

    def report(self) -> FaultReport:
        """Return the latched fault with its evidence."""
        fault, found = self._core.fault, self._core.evidence
        return FaultReport(
            fault,
            found.value,
            found.bound,
            found.time_us * 1e-6,
            found.displacement_um16 / UM16_PER_mm,
            found.commanded_cN64 / CN64_PER_cN,
            int(fault is not Fault.NONE),
        )


def with_force_sensor(settings: Settings) -> Settings:
    return replace(settings, force_gain_q14=FORCE_GAIN_q14, force_offset_counts=FORCE_ZERO_counts)

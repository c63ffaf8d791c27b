"""A board in lockstep with a simulated rig and person, as a device."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fdvv.device._client import Client
from fdvv.device._contract import DeviceInfo
from fdvv.device._lockstep import Board, LockstepPort
from fdvv.device._plant import Person, Truth
from fdvv.device._remote import Remote
from fdvv.device._telemetry import IntArray, TickColumns
from fdvv.errors import DeviceError
from fdvv.model import Press
from fdvv.protocol import Settings, TickFlag


class LinkedDevice(Remote):
    """A board in lockstep; someone on the plant presses when asked.

    Parameters
    ----------
    board : with the firmware.
    person : plants to press on; the board is told the settings that suit them.
    """

    def __init__(self, board: Board, person: Person) -> None:
        self._person = person
        self.port = LockstepPort(board, person.rest(person.settings), person.settings.tick_us)
        try:
            super().__init__(Client(self.port))
            if self.settings() != person.settings:
                self.configure(person.settings)
        except BaseException:
            self.port.close()
            raise

    def info(self) -> DeviceInfo:
        """Tell who this is; an emulated board does not know that nothing about it is real."""
        return replace(super().info(), name=self.board_name, simulated=True)

    def upload_program(self, image: bytes) -> None:
        """Make a program the active one, whole or not at all; DeviceError with the device's reason."""
        super().upload_program(image)
        self._person.load(image)

    @property
    def board_name(self) -> str:
        """Name the board, and how it runs where its firmware names a real one."""
        name, kind = super().info().name, self.port.board.name
        return name if name == kind else f"{kind} {name}"

    def configure(self, settings: Settings) -> None:
        """Replace calibration and limits, whole or not at all; the device forgets its program."""
        super().configure(settings)
        self.port.tick_us = settings.tick_us
        self.port.connect(self._person.rest(settings))

    def press(self, velocity_mm_s: float) -> Press:
        """Have the simulated person press once; DeviceError if the device faults meanwhile."""
        self._check_press(velocity_mm_s)
        self.client.announce(velocity_mm_s)
        self.client.telemetry.clear()
        self.client.stream(1)
        try:
            self.client.arm()
            truth, ticks = self._pressed(velocity_mm_s)
        finally:
            self.stop()
            self.port.connect(self._person.rest(self._settings))
        self._fail_on_fault()
        return self._joined(truth, ticks, velocity_mm_s)

    def press_armed(self, velocity_mm_s: float) -> Press:
        """Have the simulated person press once while the device renders, which it goes on with.

        It must be armed and stream its records. DeviceError if it faults meanwhile.
        """
        self._check_press(velocity_mm_s)
        self.client.announce(velocity_mm_s)
        self.client.telemetry.clear()
        try:
            truth, ticks = self._pressed(velocity_mm_s)
        finally:
            self.port.connect(self._person.rest(self._settings))
        self._fail_on_fault()
        return self._joined(truth, ticks, velocity_mm_s)

    def _pressed(self, velocity_mm_s: float) -> tuple[Truth, IntArray]:
        """Let the cap come up and the person press; give what happened and the board's ticks of it."""
        self._listen(self._person.settle_s)
        plant = self._person.press(self.image, velocity_mm_s, self._settings)
        self.port.connect(plant)
        self._listen(plant.ticks * self._settings.tick_us * 1e-6)
        return plant.record(), np.array(self.port.ticks)

    def _listen(self, duration_s: float) -> None:
        self.client.listen(self.port.now_s() + duration_s)

    def _joined(self, truth: Truth, ticks: IntArray, velocity_mm_s: float) -> Press:
        """Put what the board told of its ticks beside what happened at them."""
        told = self.client.telemetry.columns()
        assert truth.tick is not None
        rows = np.flatnonzero(truth.tick)[: ticks.size]
        places = np.searchsorted(ticks, told.tick)
        inside = (places < rows.size) & (told.tick >= ticks[0])
        if not inside.any():
            raise DeviceError(f"{self.client.port.name}: no telemetry arrived during the press")
        return join(truth, rows[places[inside]], told.part(inside), velocity_mm_s)


def join(truth: Truth, rows: IntArray, told: TickColumns, velocity_mm_s: float) -> Press:
    """Make a press of what happened and of what was told of some of its rows.

    Between them what was told holds; rows of ticks that nothing was told of are not marked as ticks.
    """
    held = np.maximum(np.searchsorted(rows, np.arange(truth.t_s.size), side="right") - 1, 0)
    marked = np.zeros(truth.t_s.size, dtype=np.bool_)
    marked[rows] = True
    return Press(
        truth.t_s,
        truth.displacement_mm,
        truth.force_cN,
        velocity_mm_s,
        told.displacement_mm[held],
        told.force_cN[held],
        told.commanded_cN[held],
        (told.flags[held] & TickFlag.LIMITED) > 0,
        marked,
        simulated=True,
    )

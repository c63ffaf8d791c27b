"""A board in lockstep with a simulated rig and person: its link, and the device."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from typing import Protocol, runtime_checkable

import numpy as np

from fdvv.device.boards import PAPER_TRAVEL_mm
from fdvv.device.client import Client
from fdvv.device.contract import DeviceInfo
from fdvv.device.plant import (
    CellPerson,
    DeepPerson,
    FittedPerson,
    Inputs,
    Outputs,
    Person,
    Plant,
    RigPerson,
    Truth,
)
from fdvv.device.remote import Remote
from fdvv.device.telemetry import IntArray, TickColumns
from fdvv.errors import DeviceError
from fdvv.firmware.limits import limits_like
from fdvv.model.press import Press
from fdvv.protocol.tables import BoardFlag, BoardLimits, CellSpec, Fault, Settings, TickFlag


@runtime_checkable
class Board(Protocol):
    """The firmware, run a tick at a time."""

    @property
    def name(self) -> str:
        """Kind of board."""

    @property
    def ticks(self) -> int:
        """How many it had counted before its first plant was connected."""

    def tick(self, inputs: Inputs) -> Outputs:
        """Run one tick; DeviceError if the board is gone."""

    def write(self, data: bytes) -> None:
        """Put bytes on its link."""

    def read(self) -> bytes:
        """Return what it has put on the link since the last call."""

    def unplug(self) -> None:
        """Pull the link's cable; what is on it is lost."""

    def plug(self) -> None:
        """Plug it in again."""

    def close(self) -> None:
        """Switch the board off."""


@runtime_checkable
class BuiltBoard(Board, Protocol):
    """A board that is a build for the rig it is connected to, as one without hardware can be."""

    def build(self, limits: BoardLimits, travel_mm: float) -> None:
        """Be built for this rig, whose deepest stop is at travel_mm, before the first tick."""


class LockstepPort:
    """The link of a board in lockstep; its clock is the board's, so waiting costs no real time.

    Attributes
    ----------
    tick_us : period of the board's loop.
    outputs : of the last tick.
    ticks : the board's number of each tick since the plant was connected.
    """

    def __init__(self, board: Board, plant: Plant, tick_us: int) -> None:
        self.board, self.tick_us = board, tick_us
        self.outputs = Outputs()
        self.ticks: list[int] = []
        self._tick = board.ticks
        self._plant = plant
        self._time_us = 0
        self._plugged = True

    @property
    def name(self) -> str:
        return self.board.name

    def now_s(self) -> float:
        return self._time_us * 1e-6

    def set_clock(self, now_s: float) -> None:
        """Set the board's clock, which otherwise counts ticks, for a board that runs in real time."""
        self._time_us = round(1e6 * now_s)

    def connect(self, plant: Plant) -> None:
        """Connect the board to another plant from the next tick on."""
        self._plant, self.ticks = plant, []

    def step(self) -> Outputs:
        last = self.outputs
        inputs = self._plant.step(last.duty_q15, last.enable, last.stop_us, last.slot)
        self._tick += inputs.elapsed_ticks
        self.ticks.append(self._tick)
        self._time_us += inputs.elapsed_ticks * self.tick_us
        self.outputs = self.board.tick(inputs._replace(time_us=self._time_us % 2**32))
        return self.outputs

    def write(self, data: bytes) -> None:
        """Send bytes; the board sees them in its next tick."""
        self._check()
        self.board.write(data)

    def read(self, until_s: float) -> bytes:
        self._check()
        while True:
            data = self.board.read()
            if data or self.now_s() >= until_s:
                return data
            self.step()

    def unplug(self) -> None:
        self._plugged = False
        self.board.unplug()

    def reopen(self) -> None:
        if not self._plugged:
            self.board.plug()
        self._plugged = True

    def close(self) -> None:
        self._plugged = False
        self.board.close()

    def _check(self) -> None:
        if not self._plugged:
            raise DeviceError(f"{self.name}: the line is closed; open the device again")


def build_for(board: BuiltBoard, person: Person, settings: Settings) -> None:
    """Make a board a build for the rig that a person presses, under these settings of it."""
    limits = person.limits if isinstance(person, RigPerson) else limits_like(settings)
    deepest_mm = person.travel_limit_mm if isinstance(person, DeepPerson) else PAPER_TRAVEL_mm
    board.build(limits, deepest_mm)


class LinkedDevice(Remote):
    """A board in lockstep; the person presses when asked, on plants whose settings the board gets."""

    def __init__(self, board: Board, person: Person) -> None:
        self._person = person
        if isinstance(board, BuiltBoard):
            build_for(board, person, person.settings)
        self.port = LockstepPort(board, person.rest(person.settings), person.settings.tick_us)
        try:
            super().__init__(Client(self.port))
            # to configure a board makes it forget its program
            if self.settings() != person.settings:
                self.configure(person.settings)
                self._clear_first_fault()
            if self.force_loop.exists and _cell_of(person) is not None:
                self.fit_cell(_cell_of(person))
        except BaseException:
            self.port.close()
            raise

    def _clear_first_fault(self) -> None:
        """Clear what only the settings that a board starts with found wrong, such as the rig's supply."""
        self.port.step()
        if self.fault().fault is not Fault.NONE:
            with suppress(DeviceError):  # it is wrong with the rig's settings too
                self.clear_fault()

    def info(self) -> DeviceInfo:
        """Return who this is; an emulated board does not know that nothing about it is real."""
        return replace(super().info(), name=self.board_name, simulated=True)

    @property
    def parts(self) -> BoardFlag:
        """What the board has, of vibration board and stop only what the rig has too."""
        parts, both = super().parts, BoardFlag.VIBRATION | BoardFlag.SERVO
        return parts & (self._person.fitted | ~both) if isinstance(self._person, FittedPerson) else parts

    def upload_program(self, image: bytes) -> None:
        super().upload_program(image)
        self._person.load(image)

    def free_cell_cN(self) -> float:
        if isinstance(self._person, CellPerson):
            self._person.lift()
        return super().free_cell_cN()

    @property
    def board_name(self) -> str:
        """Name the board, and how it runs where its firmware names a real one."""
        name, kind = super().info().name, self.port.board.name
        return name if name == kind else f"{kind} {name}"

    def configure(self, settings: Settings) -> None:
        super().configure(settings)
        self.port.tick_us = settings.tick_us
        self.port.connect(self._person.rest(settings))

    def press(self, velocity_mm_s: float) -> Press:
        return self._press(velocity_mm_s, armed=False)

    def press_armed(self, velocity_mm_s: float) -> Press:
        """Have the simulated person press once while the device renders, which it goes on with.

        It must be armed and stream its records. DeviceError if it faults meanwhile.
        """
        return self._press(velocity_mm_s, armed=True)

    def _press(self, velocity_mm_s: float, armed: bool) -> Press:
        self._check_press(velocity_mm_s)
        self.client.announce(velocity_mm_s)
        self.client.telemetry.clear()
        if not armed:
            self.client.stream(1)
        try:
            if not armed:
                self.client.arm()
            # the cap comes up before anyone presses
            self.client.listen(self.port.now_s() + self._person.settle_s)
            if isinstance(self._person, CellPerson):
                self._person.loop = self.loop
            plant = self._person.press(self.image, velocity_mm_s, self._settings)
            self.port.connect(plant)
            self.client.listen(self.port.now_s() + plant.ticks * self._settings.tick_us * 1e-6)
            truth, ticks = plant.record(), np.array(self.port.ticks)
        finally:
            if not armed:
                self.stop()
            self.port.connect(self._person.rest(self._settings))
        self._fail_on_fault()
        press = self._join(truth, ticks, velocity_mm_s)
        self.force_loop.check(press)
        return press

    def _join(self, truth: Truth, ticks: IntArray, velocity_mm_s: float) -> Press:
        """Join the telemetry of the board with the truth at the same ticks."""
        telemetry = self.client.telemetry.columns()
        assert truth.tick is not None
        rows = np.flatnonzero(truth.tick)[: ticks.size]
        places = np.searchsorted(ticks, telemetry.tick)
        inside = (places < rows.size) & (telemetry.tick >= ticks[0])
        if not inside.any():
            raise DeviceError(f"{self.client.port.name}: no telemetry arrived during the press")
        return join(truth, rows[places[inside]], telemetry.part(inside), velocity_mm_s)


def _cell_of(person: Person) -> CellSpec | None:
    return person.load_cell if isinstance(person, CellPerson) else None


def join(truth: Truth, rows: IntArray, telemetry: TickColumns, velocity_mm_s: float) -> Press:
    """Return a press from the truth and the telemetry of some of its rows.

    Telemetry is held between its ticks; rows without telemetry are not marked as ticks.
    """
    held = np.maximum(np.searchsorted(rows, np.arange(truth.t_s.size), side="right") - 1, 0)
    marked = np.zeros(truth.t_s.size, dtype=np.bool_)
    marked[rows] = True
    sensed = telemetry.displacement_mm[held], telemetry.force_cN[held], telemetry.commanded_cN[held]
    limited = (telemetry.flags[held] & TickFlag.LIMITED) > 0
    what = truth.t_s, truth.displacement_mm, truth.force_cN, velocity_mm_s
    return Press(*what, *sensed, limited, marked, simulated=True)

"""A board and its plant, both moved on by whoever waits for the board."""

from __future__ import annotations

from typing import Protocol

from fdvv.device._plant import Inputs, Outputs, Plant
from fdvv.errors import DeviceError


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
        ...

    def write(self, data: bytes) -> None:
        """Put bytes on its link."""
        ...

    def read(self) -> bytes:
        """Give what it has put on the link since the last call."""
        ...

    def unplug(self) -> None:
        """Pull the link's cable; what is on it is lost."""
        ...

    def plug(self) -> None:
        """Plug it in again."""
        ...

    def close(self) -> None:
        """Switch the board off."""
        ...


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
        """Name the line."""
        return self.board.name

    def now_s(self) -> float:
        """Give the time of the last tick."""
        return self._time_us * 1e-6

    def connect(self, plant: Plant) -> None:
        """Connect the board to another plant from the next tick on."""
        self._plant, self.ticks = plant, []

    def step(self) -> Outputs:
        """Run one tick."""
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
        """Run ticks until there are bytes or the time is there."""
        self._check()
        while True:
            data = self.board.read()
            if data or self.now_s() >= until_s:
                return data
            self.step()

    def unplug(self) -> None:
        """Pull the cable."""
        self._plugged = False
        self.board.unplug()

    def reopen(self) -> None:
        """Plug the cable in."""
        if not self._plugged:
            self.board.plug()
        self._plugged = True

    def close(self) -> None:
        """Switch the board off."""
        self._plugged = False
        self.board.close()

    def _check(self) -> None:
        if not self._plugged:
            raise DeviceError(f"{self.name}: the line is closed; open the device again")

"""What a board in lockstep is connected to, tick by tick."""

from __future__ import annotations

import struct
from typing import NamedTuple, Protocol, runtime_checkable

from fdvv.model.press import Press
from fdvv.protocol.tables import NONE, BoardFlag, BoardLimits, CellSpec, ForceLoopGains, Settings
from fdvv.twin.trace import Trace

_INPUTS = struct.Struct("<IIHHHHHHBxxx")
_OUTPUTS = struct.Struct("<hBBHBB6xh4x")
INPUTS_BYTES, OUTPUTS_BYTES = _INPUTS.size, _OUTPUTS.size


class Inputs(NamedTuple):
    """What a board reads in a tick, as in firmware/core/inputs.h."""

    time_us: int
    sum: int
    lowest: int
    highest: int
    elapsed_ticks: int = 1
    supply_mV: int = 12000
    force_counts: int = 0
    thermistor_counts: int = 2200  # a cold coil
    board: int = 0

    def pack(self) -> bytes:
        return _INPUTS.pack(*self)


class Outputs(NamedTuple):
    """What a board does in a tick."""

    duty_q15: int = 0
    enable: int = 0
    slot: int = NONE
    stop_us: int = 0
    key: int = 0
    mode: int = 0
    commanded_cN64: int = 0

    @classmethod
    def unpack(cls, data: bytes) -> Outputs:
        """Read the C structure's bytes; the rest of the tick's record goes over the link."""
        return cls(*_OUTPUTS.unpack(data))


class Plant(Protocol):
    """A rig in reality's place. `time_us` of what it gives is set by the clock of the line."""

    def step(self, duty_q15: int, enable: int, stop_us: int, slot: int) -> Inputs:
        """Move on to the next tick with these outputs, and read the sensors there."""


Truth = Press | Trace
"""What really happened, all on one clock; `tick` marks the rows at which the board read its sensors."""


class PressedPlant(Plant, Protocol):
    """A plant on which someone presses once."""

    @property
    def ticks(self) -> int:
        """How many steps the press and its release take."""

    def record(self) -> Truth:
        """Return what happened in all steps so far."""


class Person(Protocol):
    """Someone who presses when asked, and the rig that is pressed."""

    @property
    def settings(self) -> Settings:
        """Calibration and limits that suit the rig."""

    @property
    def settle_s(self) -> float:
        """Time that the cap takes to come up, and the stop to move, once there is force."""

    def press(self, image: bytes, velocity_mm_s: float, settings: Settings) -> PressedPlant:
        """Come to the button at rest and press it once, at about this speed, on this program."""

    def load(self, image: bytes) -> None:
        """Load the waveforms of the active program into the rig's vibration board."""

    def rest(self, settings: Settings) -> Plant:
        """Leave the button alone."""


@runtime_checkable
class RigPerson(Person, Protocol):
    """A person at a rig that says which board is built for it."""

    @property
    def limits(self) -> BoardLimits:
        """The limits of that board, which take the settings."""


@runtime_checkable
class DeepPerson(Person, Protocol):
    """A person at a rig that says how deep its stop can be set."""

    @property
    def travel_limit_mm(self) -> float:
        """The deepest stop."""


@runtime_checkable
class FittedPerson(Person, Protocol):
    """A person at a rig that says which of a board's parts it has."""

    @property
    def fitted(self) -> BoardFlag:
        """VIBRATION and SERVO, each if there is one."""


@runtime_checkable
class CellPerson(Person, Protocol):
    """A person at a rig that may have a load cell.

    Attributes
    ----------
    loop : the gains with which the board's force loop is closed: who presses has got used to it.
    """

    loop: ForceLoopGains | None

    def lift(self) -> None:
        """Take the finger off the cap until the next press."""

    @property
    def load_cell(self) -> CellSpec | None:
        """The cell, from its data sheet; None if this rig has none."""

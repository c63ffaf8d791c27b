"""Devices by name."""

from __future__ import annotations

import sys
from pathlib import Path

from fdvv import extras
from fdvv.device.boards import HostBoard, LibraryBoard
from fdvv.device.contract import Device
from fdvv.device.linked import Board, LinkedDevice
from fdvv.device.own_rig import OwnRigPerson, find_rig
from fdvv.device.plant import Person
from fdvv.device.recording import ReplayDevice
from fdvv.device.remote import PressedDevice
from fdvv.device.serial import SerialPort
from fdvv.device.twin import SimulatedPerson, TwinDevice
from fdvv.errors import InputError
from fdvv.twin.finger import Finger
from fdvv.twin.rig import Rig

BUILT_ELF = Path("build") / "firmware" / "itsybitsy_m0.elf"
"""Where `make firmware` leaves the controller's program, from the folder of the repository."""
KINDS = {
    "twin": "the simulated rig, whole presses at once",
    "host": "the firmware as a program of this machine, in lockstep with the simulated rig",
    "emulated": "the program of the ItsyBitsy M0 in an emulator, in lockstep with the simulated rig; slow",
    "emulated:FILE": "the same, from that ELF file of the ItsyBitsy M0 or M4",
    "serial:PORT": "a rig on a serial port, pressed by a person",
    "replay:FILE": "a recorded session",
    "moteus:FILE.toml": "a moteus and the stage of that file, pressed by a person; loop on this computer",
    "odrive:FILE.toml": "the same with an ODrive on CAN",
    "simplefoc:FILE.toml": "the same with a SimpleFOC board on a serial port",
    "rig:FILE.py:NAME": "a rig of your own, simulated by that class; fdvv device new writes one",
}
"""Devices that a word opens, and what each is."""


PRESSED = ("serial", "moteus", "odrive", "simplefoc")
"""Kinds of which nothing is simulated: whoever sits there presses."""


def is_manual(spec: str) -> bool:
    """Return whether a person presses the device, or bench, that spec names; no other is pressed by one."""
    kind, colon, _ = spec.partition(":")
    return bool(colon) and kind in PRESSED


def open_device(spec: str, rig: Rig | None = None, finger: Finger | None = None, seed: int = 0) -> Device:
    """Open the device that spec names (KINDS, or a board or device of an extra).

    rig, finger, seed : of simulated devices. Raises InputError on an unknown name, DeviceError if the device
    cannot be opened, BuildError if its extra is not installed.
    """
    kind, _, where = spec.partition(":")
    if kind == "replay" and where:
        return ReplayDevice(Path(where))
    if kind == "serial" and where:
        return PressedDevice(SerialPort(where))
    if spec == "host":
        # where a program can have no pseudo-terminal, the same firmware runs in this process
        board = LibraryBoard() if sys.platform == "win32" else HostBoard()
        return LinkedDevice(board, SimulatedPerson(rig, finger, seed))
    if spec == "twin":
        return TwinDevice(rig, finger, seed)
    if kind == "rig" and where:
        return _own_rig(where, seed)
    if kind in extras.names("rigs"):
        return _own_rig(kind, seed)
    if kind in extras.names("devices"):
        made = _of_extra(spec)
        return LinkedDevice(made, SimulatedPerson(rig, finger, seed)) if isinstance(made, Board) else made
    raise InputError("--device", spec, "names no device", f"use one of {', '.join(KINDS)}")


def _own_rig(name: str, seed: int) -> LinkedDevice:
    person, board = OwnRigPerson(find_rig(name), seed), LibraryBoard()
    board.name = person.rig.numbers.name
    return LinkedDevice(board, person)


def person_of(spec: str, seed: int = 0) -> Person:
    """Return the simulated rig that spec names, and who presses it: ``twin``, ``rig:FILE.py:NAME`` or a rig
    that a package registers. Raises InputError on another one.
    """
    if spec == "twin":
        return SimulatedPerson(seed=seed)
    return OwnRigPerson(find_rig(spec.removeprefix("rig:")), seed)


def open_board(spec: str) -> Board:
    """Open a board of an extra as ``kind:where``. Raises BuildError if the extra is not installed."""
    made = _of_extra(spec)
    if not isinstance(made, Board):
        raise InputError(
            "--device", spec, "has no board with the firmware", "use host, emulated or serial:PORT"
        )
    return made


def _of_extra(spec: str) -> Board | Device:
    kind, _, where = spec.partition(":")
    made: Board | Device = extras.load("devices", kind)(where)
    return made

"""Devices by name."""

from __future__ import annotations

import sys
from pathlib import Path

from fdvv.device._boards import HostBoard, LibraryBoard
from fdvv.device._contract import Device
from fdvv.device._emulated import EmulatedBoard
from fdvv.device._linked import LinkedDevice
from fdvv.device._pressed import PressedDevice
from fdvv.device._replay import ReplayDevice
from fdvv.device._serial import SerialPort
from fdvv.device._simulated import SimulatedPerson
from fdvv.device._twin import TwinDevice
from fdvv.errors import InputError
from fdvv.twin import Finger, Rig

BUILT_ELF = Path("build") / "firmware" / "itsybitsy_m0.elf"
"""Where `make firmware` leaves the controller's program, from the folder of the repository."""

KINDS = {
    "twin": "the simulated rig, whole presses at once",
    "host": "the firmware as a program of this machine, in lockstep with the simulated rig",
    "emulated": "the program of the ItsyBitsy M0 in an emulator, in lockstep with the simulated rig; slow",
    "emulated:FILE": "the same, from that ELF file",
    "serial:PORT": "a rig on a serial port, pressed by a person",
    "replay:FILE": "a recorded session",
}
"""Devices that a word opens, and what each is."""


def pressed_by_person(spec: str) -> bool:
    """Tell whether a person presses the device, or bench, that spec names; no other is pressed by one."""
    return spec.startswith("serial:")


def open_device(spec: str, rig: Rig | None = None, finger: Finger | None = None, seed: int = 0) -> Device:
    """Open the device that spec names (KINDS).

    rig, finger, seed : of simulated devices. Raises InputError on an unknown name, DeviceError if the device
    cannot be opened.
    """
    kind, _, where = spec.partition(":")
    if kind == "replay" and where:
        return ReplayDevice(Path(where))
    if kind == "serial" and where:
        return PressedDevice(SerialPort(where))
    if kind == "emulated":
        return LinkedDevice(EmulatedBoard(_elf(where)), SimulatedPerson(rig, finger, seed))
    if spec == "host":
        # where a program can have no pseudo-terminal, the same firmware runs in this process
        board = LibraryBoard() if sys.platform == "win32" else HostBoard()
        return LinkedDevice(board, SimulatedPerson(rig, finger, seed))
    if spec == "twin":
        return TwinDevice(rig, finger, seed)
    raise InputError("--device", spec, "names no device", f"use one of {', '.join(KINDS)}")


def _elf(where: str) -> Path:
    path = Path(where) if where else BUILT_ELF
    if not path.is_file():
        remedy = "run make firmware in the repository, or name the file as emulated:FILE"
        raise InputError("--device", f"emulated:{path}", "no such file", remedy)
    return path

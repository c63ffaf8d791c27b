"""Open a rig that is to be tested: a simulated one with its own hands, or a real one and a person."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from fdvv.device.boards import HostBoard, LibraryBoard
from fdvv.device.linked import Board, LinkedDevice
from fdvv.device.open import open_board, open_device
from fdvv.device.remote import Remote
from fdvv.errors import InputError
from fdvv.twin.files import load_rig
from fdvv.twin.rig import Rig
from fdvv_rig.selftest.faults import RIG_FAULTS, RigFault
from fdvv_rig.selftest.operator import SOUND, Operator, PromptedOperator, SimulatedOperator

KINDS = "twin, host, emulated or serial:PORT"


def open_rig(
    spec: str,
    ask: Callable[[str], None],
    rig: Path | None = None,
    seed: int = 0,
    fault: str | None = None,
) -> tuple[Remote, Operator]:
    """Open the device that spec names, and who stands at it; a simulated rig gets a force sensor in its cap.

    ask : says what a person at a real rig is to do, and waits. rig, seed, fault : of a simulated one.
    Raises InputError on an unknown name, DeviceError if the device cannot be opened.
    """
    if spec.startswith("serial:"):
        if fault or rig:
            option = "--fault" if fault else "--rig"
            raise InputError(option, str(fault or rig), "a real rig is as it is", "leave it out")
        device = open_device(spec)
        if not isinstance(device, Remote):
            raise InputError("--device", spec, "there is no firmware in it", f"use {KINDS}")
        return device, PromptedOperator(ask)
    hands = SimulatedOperator(with_sensor(load_rig(rig) if rig else Rig()), seed, _fault(fault))
    return LinkedDevice(_board(spec), hands), hands


def with_sensor(rig: Rig) -> Rig:
    """Return a rig the force sensor that the circuit has."""
    return replace(rig, keycap_sensor=replace(rig.keycap_sensor, kind="force"))


def _fault(name: str | None) -> RigFault:
    if name is None:
        return SOUND
    if name not in RIG_FAULTS:
        raise InputError("--fault", name, "is unknown", f"use one of {', '.join(RIG_FAULTS)}")
    return RIG_FAULTS[name]


def _board(spec: str) -> Board:
    if spec == "twin":
        return LibraryBoard()
    if spec == "host":
        return HostBoard()
    if spec.partition(":")[0] == "emulated":
        return open_board(spec)
    raise InputError("--device", spec, "names no device with the firmware in it", f"use {KINDS}")

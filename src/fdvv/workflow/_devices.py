"""Open the device that a command line names."""

from __future__ import annotations

from pathlib import Path

from fdvv.device import Device, TwinDevice
from fdvv.errors import InputError
from fdvv.twin import load_finger, load_rig


def open_device(name: str, rig: Path | None = None, finger: Path | None = None, seed: int = 0) -> Device:
    """Open a device by name; rig and finger are TOML files that change the twin, seed repeats it.

    Raises InputError.
    """
    if name != "twin":
        raise InputError("--device", name, "only the twin is there in this version", "use --device twin")
    return TwinDevice(load_rig(rig) if rig else None, load_finger(finger) if finger else None, seed)

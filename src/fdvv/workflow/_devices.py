"""Open the device that a command line names."""

from __future__ import annotations

from pathlib import Path

from fdvv import device
from fdvv.device import Device
from fdvv.twin import load_finger, load_rig


def open_device(name: str, rig: Path | None = None, finger: Path | None = None, seed: int = 0) -> Device:
    """Open a device by name (fdvv.device.KINDS); rig and finger are TOML files of simulated ones.

    seed repeats what is random. Raises InputError or DeviceError.
    """
    made = load_rig(rig) if rig else None, load_finger(finger) if finger else None
    return device.open_device(name, *made, seed)

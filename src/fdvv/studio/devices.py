"""The devices of this machine: which are available, and which are in use."""

from __future__ import annotations

import threading

from fdvv.device.open import BUILT_ELF, KINDS
from fdvv.device.serial import serial_ports
from fdvv.errors import BuildError, InputError
from fdvv.extras import installed


class DeviceLocks:
    """Devices in use, by what `fdvv.device` calls them. Any thread may ask."""

    def __init__(self, _studio: object = None) -> None:
        self._lock = threading.Lock()
        self._holders: dict[str, str] = {}

    def acquire(self, device: str, holder: str) -> None:
        """Note who uses a device; InputError that names who does so already."""
        with self._lock:
            if device in self._holders:
                reason = f"{device} is used by {self._holders[device]}"
                raise InputError(device, "device", reason, "wait until that is over, or end it")
            self._holders[device] = holder

    def release(self, device: str) -> None:
        """Release a device; a second time does nothing."""
        with self._lock:
            self._holders.pop(device, None)

    def holder(self, device: str) -> str:
        """Return who uses a device; empty if it is free."""
        with self._lock:
            return self._holders.get(device, "")


def available_devices() -> tuple[tuple[tuple[str, str], ...], str]:
    """Return every available device with its description, and why serial ports cannot be listed, if so."""
    emulator = BUILT_ELF.is_file() and "emulated" in installed("devices")
    names = ["twin", "host", *(["emulated"] if emulator else [])]
    found = [(name, KINDS[name]) for name in names]
    try:
        return (*found, *((f"serial:{path}", about) for path, about in serial_ports())), ""
    except BuildError as error:
        return tuple(found), str(error)


def device_names() -> tuple[str, ...]:
    return tuple(name for name, _ in available_devices()[0])

"""The devices of this machine: which are available, and which are in use."""

from __future__ import annotations

import threading
from collections.abc import Collection, Iterator
from contextlib import contextmanager

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

    @contextmanager
    def hold(self, device: str, holder: str) -> Iterator[None]:
        """Acquire a device, and release it again if what is done then fails."""
        self.acquire(device, holder)
        try:
            yield
        except BaseException:
            self.release(device)
            raise

    def release(self, device: str) -> None:
        """Release a device; a second time does nothing."""
        with self._lock:
            self._holders.pop(device, None)

    def holder(self, device: str) -> str:
        """Return who uses a device; empty if it is free."""
        with self._lock:
            return self._holders.get(device, "")


LOCAL = ("twin", "host", "emulated")
"""Devices that need no more than this machine."""


def may_be_listed(device: str) -> bool:
    """Return whether a device is of a kind that the studio lists, be it there now or not.

    None of these runs what a file says: the name of one can stand in a file without being trusted.
    """
    kind, _, where = device.partition(":")
    return device in LOCAL or (kind == "serial" and bool(where))


def available_devices() -> tuple[tuple[tuple[str, str], ...], str]:
    """Return every available device with its description, and why serial ports cannot be listed, if so."""
    emulator = BUILT_ELF.is_file() and "emulated" in installed("devices")
    devices = tuple((name, KINDS[name]) for name in LOCAL if emulator or name != "emulated")
    try:
        return (*devices, *((f"serial:{path}", about) for path, about in serial_ports())), ""
    except BuildError as error:
        return devices, str(error)


def require_listed(what: str, given: str, choices: Collection[str], remedy: str = "") -> None:
    """Refuse what is none of the choices. InputError; remedy : else the choices are named."""
    if given not in choices:
        reason = f"there is no {given[:80]!r}"
        raise InputError(what, what, reason, remedy or f"use one of {', '.join(choices)}")


def device_names() -> tuple[str, ...]:
    return tuple(name for name, _ in available_devices()[0])

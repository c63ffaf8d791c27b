"""Who uses which device: one at a time."""

from __future__ import annotations

import threading

from fdvv.errors import InputError


class Leases:
    """Devices in use, by what `fdvv.device` calls them. Any thread may ask."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._holders: dict[str, str] = {}

    def take(self, device: str, holder: str) -> None:
        """Note who uses a device; InputError that names who does so already."""
        with self._lock:
            if device in self._holders:
                reason = f"{device} is used by {self._holders[device]}"
                raise InputError(device, "device", reason, "wait until that is over, or end it")
            self._holders[device] = holder

    def give_back(self, device: str) -> None:
        """Let a device be used by others; a second time does nothing."""
        with self._lock:
            self._holders.pop(device, None)

    def holder(self, device: str) -> str:
        """Tell who uses a device; empty if nobody does."""
        with self._lock:
            return self._holders.get(device, "")

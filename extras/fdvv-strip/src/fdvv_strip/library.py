"""The LED strip's board without hardware: the firmware's core, run in this process."""

from __future__ import annotations

import ctypes
from bisect import insort

from fdvv import _native
from fdvv.device.serial import SerialPort
from fdvv.device.wire import Port
from fdvv.errors import InputError
from fdvv_strip.board import LedPointingTask

STEP_us = 500
"""The board looks at its bytes so often here."""
KEY_s = 0.1
"""How long a key pressed by `press_at` stays down."""
REPLY_BYTES = 70
STRIPS = {
    "host": "the firmware's core in this process; nothing is seen, and no key is pressed",
    "serial:PORT": "a strip's board on a serial port, its key line on the rig's controller",
}
"""LED strips that a word opens, and what each is."""


class LibraryStrip:
    """A line to a board that is no more than the firmware's core; its clock runs only while a caller waits.

    Simulated: there is no strip to be seen, and a key is pressed only by `press_at`.

    Attributes
    ----------
    bullet_px : where the bullet is, None without one.
    """

    name = "host"

    def __init__(self) -> None:
        library = _native.library()
        library.fdvv_strip_bridge_new.restype = ctypes.c_void_p
        library.fdvv_strip_bridge_run.restype = ctypes.c_uint8
        self._library = library
        self._handle = ctypes.c_void_p(library.fdvv_strip_bridge_new())
        self._time_us = 0
        self._edges_us: list[int] = []
        self._up_us = 0
        self._asked = self._reply = b""
        self.bullet_px: int | None = None

    def now_s(self) -> float:
        return 1e-6 * self._time_us

    def press_at(self, time_s: float) -> None:
        """Let the key go down at a time of the board's clock that is still to come, and up KEY_s later."""
        insort(self._edges_us, round(1e6 * time_s))

    def write(self, data: bytes) -> None:
        self._asked += data

    def read(self, until_s: float) -> bytes:
        until_us = round(1e6 * until_s)
        while not self._reply and self._time_us < until_us:
            self._step()
        reply, self._reply = self._reply, b""
        return reply

    def _step(self) -> None:
        self._time_us += STEP_us
        while self._edges_us and self._edges_us[0] <= self._time_us:
            edge_us = self._edges_us.pop(0)
            self._up_us = edge_us + round(1e6 * KEY_s)
            self._library.fdvv_strip_edge(self._handle, ctypes.c_uint32(edge_us))
        now_us = ctypes.c_uint32(self._time_us)
        bullet = self._library.fdvv_strip_bridge_run(self._handle, now_us)
        self.bullet_px = None if bullet == 255 else bullet
        if self._asked:
            self._converse(now_us)

    def _converse(self, now_us: ctypes.c_uint32) -> None:
        room = ctypes.create_string_buffer(REPLY_BYTES * len(self._asked))
        key = ctypes.c_uint8(self._time_us < self._up_us)
        count = self._library.fdvv_strip_bridge_receive(
            self._handle, self._asked, len(self._asked), now_us, key, room
        )
        self._asked, self._reply = b"", self._reply + room.raw[:count]

    def reopen(self) -> None:
        """Nothing breaks this line."""

    def close(self) -> None:
        self._library.fdvv_strip_bridge_free(self._handle)
        self._handle = ctypes.c_void_p()  # freeing it again does nothing


def strip_port(spec: str) -> Port:
    """Open the line to the strip that spec names (STRIPS). Raises InputError, DeviceError."""
    kind, _, where = spec.partition(":")
    if kind == "serial" and where:
        return SerialPort(where)
    if spec == "host":
        return LibraryStrip()
    raise InputError("--strip", spec, "names no LED strip", f"use one of {', '.join(STRIPS)}")


def open_strip(spec: str) -> LedPointingTask:
    """Open the strip that spec names (STRIPS). Raises InputError, DeviceError."""
    return LedPointingTask(strip_port(spec))

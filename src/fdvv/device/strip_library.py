"""The LED strip's board without hardware: the firmware's core, run in this process."""

from __future__ import annotations

import ctypes
from bisect import insort

from fdvv import _native

STEP_us = 500
"""The board looks at its bytes so often here."""
KEY_s = 0.1
"""How long a key pressed by `press_at` stays down."""
REPLY_BYTES = 70


class LibraryStrip:
    """A line to a board that is no more than the firmware's core; its clock goes only while somebody waits.

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
        self._asked = self._told = b""
        self.bullet_px: int | None = None

    def now_s(self) -> float:
        """Give the board's clock, which is the line's."""
        return 1e-6 * self._time_us

    def press_at(self, time_s: float) -> None:
        """Let the key go down at a time of the board's clock that is still to come, and up KEY_s later."""
        insort(self._edges_us, round(1e6 * time_s))

    def write(self, data: bytes) -> None:
        """Send bytes; the board sees them in its next step."""
        self._asked += data

    def read(self, until_s: float) -> bytes:
        """Let time pass until there are bytes or the time is there."""
        until_us = round(1e6 * until_s)
        while not self._told and self._time_us < until_us:
            self._step()
        told, self._told = self._told, b""
        return told

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
        self._asked, self._told = b"", self._told + room.raw[:count]

    def reopen(self) -> None:
        """Nothing breaks this line."""

    def close(self) -> None:
        """Free the board."""
        self._library.fdvv_strip_bridge_free(self._handle)
        self._handle = ctypes.c_void_p()  # freeing it again does nothing

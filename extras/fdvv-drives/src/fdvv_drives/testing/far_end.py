"""The far end of a line: a pseudo-terminal, a simulated drive behind it, and faults on request; simulated.

A drive answers bytes. Whoever runs it in a process of its own (`serve`) asks for presses, faults and its
state by lines of JSON.
"""

from __future__ import annotations

import os
import select
import sys
import time
from contextlib import suppress
from typing import Literal, Protocol

from fdvv_drives.testing.plant import LivePlant

FaultKind = Literal["", "silent", "garbage", "error", "mode", "unplug", "delay", "jump", "beyond"]
IDLE_s = 0.002
GARBAGE = bytes(range(1, 256)) + b"\n"


class FarDrive(Protocol):
    """A simulated drive behind a line.

    Attributes
    ----------
    torque : what it commands its motor at the moment, in its own unit, 0 where it is off.
    finger_N : between finger and cap, for a drive with an input for a load cell.
    """

    torque: float
    finger_N: float

    def answer(self, data: bytes, position: float, now_s: float) -> bytes:
        """Take bytes from the line and return what goes back."""

    def look(self, position: float, now_s: float) -> bytes:
        """Let time pass: the watchdog, and what is sent unasked."""

    def fail(self, kind: FaultKind) -> None:
        """Get into a fault of its own: ``error`` or ``mode``; with "" it is well again."""


class FarEnd:
    """A drive on a pseudo-terminal in real time.

    mm_unit, N_unit : travel and force per unit of the drive's position and torque; direction 1.

    Attributes
    ----------
    port : the name that an adapter opens.
    """

    def __init__(self, drive: FarDrive, mm_unit: float, N_unit: float, travel_mm: float = 6.0) -> None:
        if sys.platform == "win32":
            raise OSError("far ends need the pseudo-terminals of a POSIX system")
        import tty  # POSIX only

        self.drive, self.plant = drive, LivePlant(travel_mm)
        self._mm_unit, self._N_unit = mm_unit, N_unit
        self._fault: FaultKind = ""
        self._held = b""
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)
        os.set_blocking(self._master, False)
        self.port = os.ttyname(self._slave)

    @property
    def force_N(self) -> float:
        """Return the force that the drive commands against the finger."""
        return -self.drive.torque * self._N_unit

    def fault(self, kind: FaultKind) -> None:
        """Plant a fault of the line, the drive or the sensor; "" ends it."""
        self._fault = kind
        self.drive.fail(kind if kind in ("error", "mode") else "")
        if kind == "unplug":
            os.close(self._master)
            os.close(self._slave)
            self._master = -1

    def position(self) -> float:
        moved = {"jump": 4.0, "beyond": 8.5}.get(self._fault, 0.0)
        return (self.plant.x_mm + moved) / self._mm_unit

    def step(self, others: list[int]) -> list[int]:
        """Wait for bytes, at most 2 ms; answer them. Return those of the other files that can be read."""
        files = [*others, *([self._master] if self._master >= 0 else [])]
        ready = select.select(files, [], [], IDLE_s)[0]
        now_s = time.perf_counter()
        self.plant.advance(now_s, self.force_N)
        self.drive.finger_N = self.plant.finger_N
        if self._master >= 0:
            self._serve(now_s)
        else:
            self.drive.look(self.position(), now_s)
        return [file for file in ready if file != self._master]

    def _serve(self, now_s: float) -> None:
        data, reply = self._received(), b""
        # answered before the watchdog is looked at: if this process was held up, the host was not silent
        if data and self._fault != "silent":
            reply = self.drive.answer(data, self.position(), now_s)
        reply += self.drive.look(self.position(), now_s)
        if reply and self._fault == "garbage":
            reply = GARBAGE
        if self._fault == "delay":
            self._held += reply
            return
        if (reply or self._held) and self._fault != "silent":
            with suppress(BlockingIOError):  # nobody reads: what finds no room is lost
                os.write(self._master, self._held + reply)
            self._held = b""

    def _received(self) -> bytes:
        with suppress(BlockingIOError):
            return os.read(self._master, 4096)
        return b""

"""A simulated rig behind a pseudo-terminal, in real time: hosts open it as they open a real one."""

from __future__ import annotations

import os
import threading
import time
from collections import Counter
from contextlib import suppress
from dataclasses import replace

from fdvv.device.boards import LibraryBoard
from fdvv.device.client import Client
from fdvv.device.linked import LockstepPort
from fdvv.device.plant import DeepPerson, Person
from fdvv.errors import BuildError
from fdvv.firmware.limits import limits_like
from fdvv.protocol.tables import Fault

LAG_s = 0.01
"""Beyond this a busy machine's lost time is left out, so that the rig never runs ahead of its host."""
POLL_s = 1e-3
UNSENT_bytes = 1 << 20
"""Kept for a host that does not read; what is older is lost."""
BETWEEN_s = 0.4
PATIENCE_ms = 5000
"""The host's timeout: both run on one machine, which may be busy."""


class RigServer(threading.Thread):
    """The firmware in real time behind a pseudo-terminal, and a person who presses while it is armed.

    Parameters
    ----------
    person : with the rig. presses : how many at most, None without end.
    between_s : from arming, or the end of a press, to the next press.

    Attributes
    ----------
    path : of the terminal that a host opens. counts : of "ticks" and "presses" so far.
    over : set when it ends.
    tick_s : when the tick under way began, on the host's clock; the board's own clock goes with it, as a real
        one does, whatever ticks a busy machine leaves out.
    """

    def __init__(self, person: Person, presses: int | None = None, between_s: float = BETWEEN_s) -> None:
        super().__init__(daemon=True)
        try:
            import tty
        except ImportError:
            raise BuildError("a rig cannot be served here: this system has no pseudo-terminals") from None
        self.person, self.presses, self.between_s = person, presses, between_s
        self.settings = replace(person.settings, host_timeout_ms=PATIENCE_ms)
        self.line, self.slave = os.openpty()
        tty.setraw(self.slave)
        os.set_blocking(self.line, False)
        self.path = os.ttyname(self.slave)
        self.board = LibraryBoard()
        deepest = {"travel_mm": person.travel_limit_mm} if isinstance(person, DeepPerson) else {}
        self.board.build(limits_like(self.settings), **deepest)
        self.port = LockstepPort(self.board, person.rest(self.settings), self.settings.tick_us)
        self._prepare()
        for wire in (self.board.unplug, self.board.plug):
            wire()  # the next host begins afresh
        self.counts: Counter[str] = Counter()
        self._due = self._ticks_of(self.between_s)
        self.over = threading.Event()
        self._begun_s = self.tick_s = time.monotonic()
        self._unsent = self._heard = b""

    def _prepare(self) -> None:
        """Write the rig's settings, and clear what only the settings that a board starts with found wrong."""
        client = Client(self.port)
        client.write_settings(self.settings)
        if (fault := Fault(client.read_fault().fault)) is not Fault.NONE:
            client.clear_fault(fault)

    def _ticks_of(self, time_s: float) -> int:
        return round(time_s * 1e6 / self.settings.tick_us)

    def run(self) -> None:
        tick_s, last_s = self.settings.tick_us * 1e-6, time.monotonic()
        while not self.over.wait(POLL_s):
            self.hear()
            last_s = max(last_s, time.monotonic() - LAG_s)
            for _ in range(int((time.monotonic() - last_s) / tick_s)):
                self.tick()
                last_s += tick_s

    def hear(self) -> None:
        """Hand on what the host has sent."""
        with suppress(BlockingIOError):
            self._heard += os.read(self.line, 4096)

    def tick(self) -> None:
        """Run a tick of the board; the person begins a press when one is due."""
        self.tick_s = time.monotonic()
        self.port.set_clock(self.tick_s - self._begun_s)
        armed = bool(self.port.step().enable)
        self.counts["ticks"] += 1
        # a board stamps what it hears with the time of its last tick, which is not before it came
        self.board.write(self._heard)
        self._heard = b""
        self._send(self.board.read())
        self._due = self._due - 1 if armed else self._ticks_of(self.between_s)
        if self._due <= 0 and self.presses != 0:
            self._press()

    def _send(self, data: bytes) -> None:
        """Send what the line takes, the rest later: a host that is busy loses nothing, as on USB."""
        self._unsent = (self._unsent + data)[-UNSENT_bytes:]
        with suppress(BlockingIOError):
            self._unsent = self._unsent[os.write(self.line, self._unsent) :]

    def _press(self) -> None:
        image = self.board.program()
        if image is None:
            return
        self.counts["presses"] += 1
        self.presses = None if self.presses is None else self.presses - 1
        # under the rig's own settings: its limits have no room for this board's patience with its host
        plant = self.person.press(image, self.board.announced_mm_s, self.person.settings)
        self._due = plant.ticks + self._ticks_of(self.between_s)
        self.port.connect(plant)

    def end(self) -> None:
        """Stop, and close the terminal."""
        self.over.set()
        self.join()
        for file in (self.line, self.slave):
            os.close(file)
        self.board.close()

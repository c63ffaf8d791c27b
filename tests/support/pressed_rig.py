"""Rigs that a script presses, and their keys."""

from __future__ import annotations

import os
import threading
import time
import tty

from fdvv.device.boards import LibraryBoard
from fdvv.device.linked import LockstepPort
from fdvv.device.remote import surface_image
from fdvv.firmware.limits import limits_like
from fdvv.protocol.frame import FrameDecoder
from fdvv.protocol.tables import Message, Settings
from fdvv.testing.conformance import plain_surface
from tests.support.scripted_person import ScriptedPerson

SETTINGS = Settings(host_timeout_ms=5000)
"""Patient, as this machine may be busy; otherwise the board's own."""


class Rig(threading.Thread):
    """A board that runs in real time behind a pseudo-terminal, and someone who presses while it is armed.

    Attributes
    ----------
    between : ticks from the beginning of one press to that of the next.
    """

    between = 100

    def __init__(self, person: ScriptedPerson, presses: int) -> None:
        super().__init__(daemon=True)
        self.person, self.presses = person, presses
        self.line, self.slave = os.openpty()
        tty.setraw(self.slave)
        os.set_blocking(self.line, False)
        self.path = os.ttyname(self.slave)
        self.board = LibraryBoard()
        self.board.build(limits_like(SETTINGS))
        self.port = LockstepPort(self.board, person.rest(SETTINGS), SETTINGS.tick_us)
        self.over = threading.Event()

    def run(self) -> None:
        last_s = time.monotonic()
        while not self.over.wait(0.001):
            self.hear()
            # time that the machine had no time for is left out, so that the rig never runs ahead of its host
            last_s = max(last_s, time.monotonic() - 0.01)
            for _ in range(int((time.monotonic() - last_s) / 250e-6)):
                self.tick()
                last_s += 250e-6

    def hear(self) -> None:
        try:
            self.board.write(os.read(self.line, 4096))
        except BlockingIOError:
            return

    def tick(self) -> None:
        out = self.port.step()
        try:
            os.write(self.line, self.board.read())
        except BlockingIOError:
            return
        if out.enable and self.presses and len(self.port.ticks) > self.between:
            self.presses -= 1
            self.port.connect(self.person.press(surface_image(plain_surface(), 4.0), 100.0, SETTINGS))

    def end(self) -> None:
        self.over.set()
        self.join()
        os.close(self.line)
        os.close(self.slave)


class KeyedRig(Rig):
    """A rig that notes when its board reports a key that went down, as its tick runs.

    Attributes
    ----------
    pressed_s : when, on the host's clock. lose : so many of the next frames of ticks are lost on the line.
    """

    between = 1200

    def __init__(self, presses: int, person: ScriptedPerson | None = None) -> None:
        super().__init__(person or ScriptedPerson(), presses)
        self.pressed_s: list[float] = []
        self.lose = 0
        self._decoder, read = FrameDecoder(), self.board.read

        def noted() -> bytes:
            data, now_s = read(), time.monotonic()
            for frame in self._decoder.feed(data):
                if frame.message == Message.KEY and frame.payload[0] > 0:
                    self.pressed_s.append(now_s)
                elif frame.message == Message.RECORDS and self.lose:
                    self.lose -= 1
                    return b""
            return data

        self.board.read = noted  # type: ignore[method-assign]

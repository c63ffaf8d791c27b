"""Boards and programs that the tests of the link share."""

from __future__ import annotations

import numpy as np

from fdvv.device.boards import LibraryBoard
from fdvv.device.linked import LinkedDevice, LockstepPort
from fdvv.device.remote import surface_image
from fdvv.model.surface import ForceSurface
from fdvv.protocol.frame import Frame, FrameDecoder, encode
from fdvv.protocol.messages import request_frame
from fdvv.protocol.record import Record
from fdvv.protocol.tables import HASH, VERSION, HelloRequest, Message, Settings
from fdvv.testing.conformance import plain_surface
from tests.support.scripted_person import ScriptedPerson

TRAVELS_mm = (3.0, 5.0)
PROGRAMS = tuple(surface_image(plain_surface(20.0, travel), travel) for travel in TRAVELS_mm)
"""Two programs that their travel tells apart."""

TABLE = np.full((6, 255), 30.0)
LONG = surface_image(ForceSurface(np.linspace(0.0, 5.08, 255), np.arange(1.0, 7.0), TABLE, TABLE - 5), 4.0)
"""A program that nearly fills a bank."""


class Bench:
    """A board inside this process, spoken to frame by frame."""

    def __init__(self, seed: int = 0) -> None:
        self.board = LibraryBoard()
        self.person = ScriptedPerson(seed)
        self.port = LockstepPort(self.board, self.person.rest(Settings()), Settings().tick_us)
        self.decoder = FrameDecoder()
        self.sequence = 0

    def run(self, ticks: int = 1) -> list[Frame]:
        """Run ticks and return the frames that came."""
        found: list[Frame] = []
        for _ in range(ticks):
            self.port.step()
            found += self.decoder.feed(self.board.read())
        return found

    def send(self, data: bytes, ticks: int = 4) -> list[Frame]:
        """Put bytes on the line and return the frames that came in some ticks."""
        self.port.write(data)
        return self.run(ticks)

    def ask(self, message: Message, body: Record | None = None, ticks: int = 8) -> Frame:
        """Ask once and return the one reply."""
        self.sequence = (self.sequence + 1) % 256
        found = self.send(encode(request_frame(message, self.sequence, body)), ticks)
        replies = [frame for frame in found if frame.message < 0xC0 or frame.message == 0xFF]
        assert len(replies) == 1, replies
        assert replies[0].sequence == self.sequence
        return replies[0]

    def hello(self) -> Frame:
        """Introduce the host."""
        return self.ask(Message.HELLO, HelloRequest(version=VERSION, hash=HASH))


def linked(seed: int = 0) -> LinkedDevice:
    """Return a device inside this process."""
    return LinkedDevice(LibraryBoard(), ScriptedPerson(seed))

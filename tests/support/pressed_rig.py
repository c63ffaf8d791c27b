"""Rigs that a script presses, and their keys."""

from __future__ import annotations

from fdvv.device.serve import RigServer
from fdvv.protocol.frame import FrameDecoder
from fdvv.protocol.tables import Message, Settings
from tests.support.scripted_person import ScriptedPerson

SETTINGS = Settings(host_timeout_ms=5000)
"""Patient, as this machine may be busy; otherwise the board's own."""


class Rig(RigServer):
    """A board that runs in real time behind a pseudo-terminal, and someone who presses while it is armed."""

    def __init__(self, person: ScriptedPerson, presses: int, between_s: float = 0.025) -> None:
        super().__init__(person, presses, between_s)
        self.scripted = person


class KeyedRig(Rig):
    """A rig that notes when its board reports a key that went down, as its tick runs.

    Attributes
    ----------
    pressed_s : when, see tick_s. lose : so many of the next frames of ticks get lost.
    """

    def __init__(self, presses: int, person: ScriptedPerson | None = None) -> None:
        super().__init__(person or ScriptedPerson(), presses, 0.3)
        self.pressed_s: list[float] = []
        self.lose = 0
        self._decoder, read = FrameDecoder(), self.board.read

        def noted() -> bytes:
            data, now_s = read(), self.tick_s
            for frame in self._decoder.feed(data):
                if frame.message == Message.KEY and frame.payload[0] > 0:
                    self.pressed_s.append(now_s)
                elif frame.message == Message.RECORDS and self.lose:
                    self.lose -= 1
                    return b""
            return data

        self.board.read = noted  # type: ignore[method-assign]

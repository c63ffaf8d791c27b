"""Requests to the LED strip's board and their replies, over a line that may lose or damage bytes."""

from __future__ import annotations

from typing import TypeVar

from fdvv.device._port import Port
from fdvv.errors import DeviceError, ModelError
from fdvv.protocol import (
    REPLY,
    STRIP_HASH,
    STRIP_VERSION,
    Frame,
    FrameDecoder,
    Record,
    StripHelloReply,
    StripHelloRequest,
    StripMessage,
    StripRefusal,
    StripRefusedReply,
    encode,
)

Kind = TypeVar("Kind", bound=Record)
TRIES = 4
TIMEOUT_s = 0.1
"""A request may wait for a frame of the strip, 3 ms, and crosses in 10 ms."""
HELLO_TRIES = 30
"""An Uno starts again when its port is opened, and its bootloader keeps it for 1 to 2 s."""

REASONS = {
    StripRefusal.NONE: "no reason given",
    StripRefusal.UNKNOWN_MESSAGE: "it does not know this request; update its firmware",
    StripRefusal.BAD_LENGTH: "the request has a wrong length",
    StripRefusal.BAD_VALUE: "a value is out of range",
    StripRefusal.BUSY: "the strip is at a round of another program; wait for its end, or stop it",
    StripRefusal.HASH_MISMATCH: "it was started anew and knows nobody; open the strip again",
}


class StripWire:
    """Sends requests one at a time, again if need be. A board that carried one out answers the same again.

    Parameters
    ----------
    port : an open line. DeviceError if nobody answers, or somebody else than a strip's board of this version.

    Attributes
    ----------
    hello : what the board said of itself.
    """

    def __init__(self, port: Port) -> None:
        self.port = port
        self._decoder = FrameDecoder()
        self._sequence = 0
        port.write(b"\0")
        request = StripHelloRequest(version=STRIP_VERSION, hash=STRIP_HASH)
        self.hello = self.ask(StripMessage.HELLO, StripHelloReply, request, HELLO_TRIES)
        if self.hello.hash != STRIP_HASH:
            raise DeviceError(
                f"{port.name}: the strip's firmware speaks protocol {self.hello.hash:08x}, "
                f"this fdvv {STRIP_HASH:08x}; update the firmware or fdvv, so that both are of one version"
            )

    def ask(
        self, message: StripMessage, kind: type[Kind], body: Record | None = None, tries: int = TRIES
    ) -> Kind:
        """Ask and give the reply's body. DeviceError if it is refused, or no answer comes."""
        return kind.unpack(self._exchange(message, body, tries))

    def tell(self, message: StripMessage, body: Record | None = None) -> None:
        """Ask for what has no answer but that it is done. DeviceError as `ask`."""
        self._exchange(message, body, TRIES)

    def _exchange(self, message: StripMessage, body: Record | None, tries: int) -> bytes:
        self._sequence = (self._sequence + 1) % 256
        data = encode(Frame(message, self._sequence, body.pack() if body else b""))
        heard = False
        for attempt in range(tries):
            # zeros end whatever half a frame the board still holds
            self.port.write(b"\0" + data if attempt else data)
            until_s = self.port.now_s() + TIMEOUT_s
            while came := self.port.read(until_s):
                heard = True
                for frame in self._decoder.feed(came):
                    if frame.sequence == self._sequence and frame.message == message + REPLY:
                        return frame.payload
                    self._refuse(frame, message)
        found = "what answers there is no LED strip's board" if heard else "no answer"
        raise DeviceError(
            f"{self.port.name}: {found} ({message.name.lower()}, {tries * TIMEOUT_s:.1f} s); "
            "check the port's name, the cable and the board's program (uno_strip)"
        )

    def _refuse(self, frame: Frame, message: StripMessage) -> None:
        """Raise DeviceError if the frame refuses the message."""
        if (frame.message, frame.sequence) != (StripMessage.REFUSED + REPLY, self._sequence):
            return
        try:
            body = StripRefusedReply.unpack(frame.payload)
            reason = REASONS[StripRefusal(body.refusal)]
        except (ModelError, ValueError):
            return
        if body.request == message:
            where = f" (field {body.detail})" if body.refusal == StripRefusal.BAD_VALUE else ""
            raise DeviceError(f"{self.port.name}: refused {message.name.lower()}: {reason}{where}")

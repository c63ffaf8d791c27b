"""Requests and their replies over a line that may lose or damage bytes."""

from __future__ import annotations

from collections.abc import Callable

from fdvv.device._port import Port
from fdvv.errors import DeviceError, ModelError
from fdvv.protocol import (
    REPLY,
    FaultedRequest,
    Frame,
    FrameDecoder,
    KeyRequest,
    Message,
    Record,
    RecordsRequest,
    Refusal,
    RefusedReply,
    encode,
    read_notice,
    read_reply,
    request_frame,
)

Notice = RecordsRequest | FaultedRequest | KeyRequest
Listener = Callable[[Notice, bytes, int], None]
"""Told of what a device sends unasked: the notice, the bytes of its records, its sequence number."""

TRIES = 6
TIMEOUT_s = 0.1
SLOW_s = {Message.COMMIT: 1.0, Message.SELFTEST: 5.0}
"""Time for a reply; most come within a few ticks."""


class RefusedError(DeviceError):
    """A device did not carry a request out.

    Attributes
    ----------
    message, refusal, detail : what was asked, why not, and where (an offset or the number of a field).
    """

    def __init__(self, name: str, message: Message, refusal: Refusal, detail: int) -> None:
        self.message, self.refusal, self.detail = message, refusal, detail
        where = f" (detail {detail})" if detail else ""
        super().__init__(f"{name}: refused {message.name.lower()}: {REASONS[refusal]}{where}")


REASONS = {
    Refusal.NONE: "no reason given",
    Refusal.UNKNOWN_MESSAGE: "it does not know this request; its firmware is older",
    Refusal.BAD_LENGTH: "the request has a wrong length",
    Refusal.BAD_VALUE: "a value is out of range",
    Refusal.WRONG_MODE: "not in this mode; stop it first, or clear its fault",
    Refusal.WRONG_ORDER: "not at this point; something must come before",
    Refusal.TOO_LARGE: "more bytes than it holds",
    Refusal.CHECKSUM: "the program arrived damaged; upload it again",
    Refusal.IMAGE_LAYOUT: "the program is not laid out as it must be",
    Refusal.IMAGE_RANGE: "a number of the program is beyond its range or the rig's limits",
    Refusal.NO_IMAGE: "it has no program; upload one first",
    Refusal.FAULT_LATCHED: "a fault is latched; read and clear it first",
    Refusal.BUSY: "it is still at an earlier request",
    Refusal.HASH_MISMATCH: "its firmware speaks another version of the protocol; update one of the two",
}


class Wire:
    """Sends requests one at a time, again if need be, and hands what comes unasked to a listener.

    A repeated request keeps its sequence number: a device that has carried it out answers the same again.

    Attributes
    ----------
    repeated : requests that had to be sent again so far.
    """

    def __init__(self, port: Port, listener: Listener) -> None:
        self.port = port
        self.repeated = 0
        self._listener = listener
        self._decoder = FrameDecoder()
        self._sequence = 0

    @property
    def damaged(self) -> int:
        """Count frames from the device that arrived damaged."""
        return self._decoder.bad

    def request(self, message: Message, body: Record | None = None) -> Record | None:
        """Ask and give the reply's body. RefusedError, or DeviceError if none comes."""
        self._sequence = (self._sequence + 1) % 256
        data = encode(request_frame(message, self._sequence, body))
        for attempt in range(TRIES):
            self.repeated += attempt > 0
            # zeros end whatever half a frame the device still holds
            self.port.write(b"\0" + data if attempt else data)
            found = self._await(message, SLOW_s.get(message, TIMEOUT_s))
            if found is not None:
                return found[0]
        spent = TRIES * SLOW_s.get(message, TIMEOUT_s)
        raise DeviceError(
            f"{self.port.name}: no answer to {message.name.lower()} in {spent:g} s; "
            "is it powered, and is this the right port?"
        )

    def _await(self, message: Message, timeout_s: float) -> tuple[Record | None] | None:
        until_s = self.port.now_s() + timeout_s
        while True:
            data = self.port.read(until_s)
            if not data:
                return None
            replies = [frame for frame in self._decoder.feed(data) if not self._told(frame)]
            for frame in replies:
                if frame.sequence == self._sequence and (found := self._reply(frame, message)):
                    return found

    def _reply(self, frame: Frame, message: Message) -> tuple[Record | None] | None:
        """Give the body of the reply to message; None if this frame is another's."""
        try:
            replied, body = read_reply(frame)
        except ModelError:
            return None
        if isinstance(body, RefusedReply):
            if body.request != message or body.refusal not in REASONS:
                return None
            raise RefusedError(self.port.name, message, Refusal(body.refusal), body.detail)
        return (body,) if replied == message else None

    def _told(self, frame: Frame) -> bool:
        """Hand a notice on; say whether it was one."""
        if not Message.RECORDS <= frame.message < Message.REFUSED + REPLY:
            return False
        try:
            notice, rest = read_notice(frame)
        except ModelError:
            return True  # of a newer firmware
        self._listener(notice, rest, frame.sequence)
        return True

    def listen(self, until_s: float) -> bool:
        """Take what comes unasked until then, at most one reading; say whether there was any."""
        data = self.port.read(until_s)
        for frame in self._decoder.feed(data):
            self._told(frame)
        return bool(data)

    def reset(self) -> None:
        """Forget half a frame after the line was opened again."""
        self._decoder.reset()

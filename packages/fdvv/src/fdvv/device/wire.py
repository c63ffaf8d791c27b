"""Requests and replies over a line that may lose or damage bytes, and the relation of the two clocks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from fdvv.errors import DeviceError, ModelError
from fdvv.protocol.frame import Frame, FrameDecoder, encode
from fdvv.protocol.messages import REPLY, read_notice, read_reply, request_frame
from fdvv.protocol.record import Record
from fdvv.protocol.tables import FaultedRequest, KeyRequest, Message, RecordsRequest, Refusal, RefusedReply

Notice = RecordsRequest | FaultedRequest | KeyRequest
Listener = Callable[[Notice, bytes, int], None]
"""Called with what a device sends unasked: the notice, the bytes of its records, its sequence number."""
TRIES = 6
TIMEOUT_s = 0.1
SLOW_s = {Message.COMMIT: 1.0, Message.SELFTEST: 5.0}
"""Time for a reply; most come within a few ticks."""
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
    Refusal.NO_LOAD_CELL: "it has no load cell",
    Refusal.HASH_MISMATCH: "its firmware speaks another version of the protocol; update one of the two",
}
WRAP_us = 2**32  # the wire's clock has 32 bits (protocol/fdvv.toml: time_us)


class Port(Protocol):
    """A line to a board. Time is the port's own: a board in lockstep runs only while someone waits."""

    @property
    def name(self) -> str:
        """Name the line for messages to a person."""

    def now_s(self) -> float:
        """Return a clock that never goes back."""

    def write(self, data: bytes) -> None:
        """Send bytes; DeviceError if the line is dead."""

    def read(self, until_s: float) -> bytes:
        """Wait for bytes until now_s() reaches until_s; b"" if none came. DeviceError if the line is dead."""

    def reopen(self) -> None:
        """Open the line again after it broke; DeviceError if it cannot be."""

    def close(self) -> None:
        """Close the line; a second time does nothing."""


class RefusedError(DeviceError):
    """A device did not carry a request out.

    Attributes
    ----------
    message, refusal, detail : what was asked, why not, and where (an offset or the number of a field).
    """

    def __init__(
        self, name: str, message: Message, refusal: Refusal, detail: int, why: str | None = None
    ) -> None:
        self.message, self.refusal, self.detail = message, refusal, detail
        where = f" (detail {detail})" if detail else ""
        super().__init__(f"{name}: refused {message.name.lower()}: {why or REASONS[refusal] + where}")


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

    def request(self, message: Message, body: Record | None = None) -> Record | None:
        """Ask and give the reply's body. RefusedError, or DeviceError if none comes."""
        self._sequence = (self._sequence + 1) % 256
        data = encode(request_frame(message, self._sequence, body))
        timeout_s = SLOW_s.get(message, TIMEOUT_s)
        for attempt in range(TRIES):
            self.repeated += attempt > 0
            # zeros end whatever half a frame the device still holds
            self.port.write(b"\0" + data if attempt else data)
            if reply := self._await(message, timeout_s):
                return reply[0]
        raise DeviceError(
            f"{self.port.name}: no answer to {message.name.lower()} in {TRIES * timeout_s:g} s; "
            "is it powered, and is this the right port?"
        )

    def _await(self, message: Message, timeout_s: float) -> tuple[Record | None] | None:
        until_s = self.port.now_s() + timeout_s
        while data := self.port.read(until_s):
            replies = [frame for frame in self._decoder.feed(data) if not self._notify(frame)]
            for frame in replies:
                if frame.sequence == self._sequence and (reply := self._reply(frame, message)):
                    return reply
        return None

    def _reply(self, frame: Frame, message: Message) -> tuple[Record | None] | None:
        """Return the body of the reply to message; None if this frame is another's."""
        try:
            replied, body = read_reply(frame)
        except ModelError:
            return None
        if isinstance(body, RefusedReply):
            if body.request != message or body.refusal not in REASONS:
                return None
            raise RefusedError(self.port.name, message, Refusal(body.refusal), body.detail)
        return (body,) if replied == message else None

    def _notify(self, frame: Frame) -> bool:
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
            self._notify(frame)
        return bool(data)

    def reset(self) -> None:
        self._decoder.reset()


@dataclass(frozen=True)
class Exchange:
    """One ping: when it left, what the device's clock said when it was there, when the answer was back.

    Attributes
    ----------
    sent_us, received_us : on the host's clock.
    device_us : on the device's, unwrapped.
    """

    sent_us: float
    received_us: float
    device_us: float


@dataclass(frozen=True)
class ClockRelation:
    """host = offset + (1 + drift) * device, from the quickest exchanges.

    Attributes
    ----------
    offset_us : host's clock at the device's zero.
    drift_ppm : how much faster the host's clock runs; 0 unless the exchanges span a second.
    residual_us : rms distance of the exchanges used from the line.
    shortest_us : shortest round trip. error_us : bound of the error, however ways were held up: the device's
        clock was read between the two ends of every exchange.
    exchanges : used.
    """

    offset_us: float
    drift_ppm: float
    residual_us: float
    shortest_us: float
    exchanges: int
    error_us: float

    def host_us(self, device_us: float) -> float:
        return self.offset_us + (1 + self.drift_ppm * 1e-6) * device_us


def unwrap_us(time_us: int, near_us: float) -> float:
    """Return the time nearest to near_us that a 32-bit microsecond clock shows as time_us."""
    return time_us + WRAP_us * round((near_us - time_us) / WRAP_us)


def relate(exchanges: Sequence[Exchange]) -> ClockRelation:
    """Relate the clocks by least squares over the quicker half of the exchanges.

    A slow exchange was held up on one of its ways, nobody knows which; its middle is no good estimate.
    Raises DeviceError without any.
    """
    if not exchanges:
        raise DeviceError("clocks cannot be related without a ping; ping the device first")
    trips = np.array([e.received_us - e.sent_us for e in exchanges])
    quick = np.argsort(trips, kind="stable")[: max(1, (trips.size + 1) // 2)]
    device = np.array([exchanges[i].device_us for i in quick])
    host = np.array([(exchanges[i].sent_us + exchanges[i].received_us) / 2 for i in quick])
    span = device - device.mean()
    steady = np.ptp(device) < 1e6
    drift = 0.0 if steady else float(span @ (host - host.mean() - span) / (span @ span))
    offset = float(host.mean() - (1 + drift) * device.mean())
    residual = host - offset - (1 + drift) * device
    rms = float(np.sqrt(np.mean(residual**2)))
    error = float(np.min(np.abs(residual) + trips[quick] / 2))
    return ClockRelation(offset, drift * 1e6, rms, float(trips.min()), quick.size, error)

"""The LED strip of the paper's pointing task: its messages, its rounds, and when a key went down."""

from __future__ import annotations

import struct
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Protocol, Self, TypeVar

import numpy as np

from fdvv.device.wire import Port, unwrap_us
from fdvv.errors import DeviceError
from fdvv.protocol.frame import Frame, FrameDecoder, encode
from fdvv.protocol.messages import REPLY
from fdvv.protocol.record import Record
from fdvv_strip.tables import (
    STRIP_HASH,
    STRIP_PRESSES,
    STRIP_VERSION,
    StripBeginReply,
    StripBeginRequest,
    StripBoardFlag,
    StripHelloReply,
    StripHelloRequest,
    StripLed,
    StripMessage,
    StripMode,
    StripReadRoundReply,
    StripRefusal,
    StripRefusedReply,
    StripShowRequest,
    StripStatusReply,
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
GLANCE_s = 0.05
"""Between two polls of a round; they also keep the link alive."""
DELAYS_s = 0.8, 1.6
"""From asking for a round to its bullet, drawn evenly: nobody can press by rhythm alone (assumed)."""
LONGEST_DELAY_s, PATIENCE_s = 10.0, 1.0
PLAYING = StripMode.WAITING, StripMode.MOVING


class StripWire:
    """Sends requests one at a time, again if need be. A board that carried one out answers the same again.

    `hello` is what the board said of itself. DeviceError without an answer, or from another board or version.
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
        return kind.unpack(self.command(message, body, tries))

    def command(self, message: StripMessage, body: Record | None = None, tries: int = TRIES) -> bytes:
        """Ask, and give the bytes of the answer, none where it only says that it is done."""
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
        except ValueError:  # ModelError too
            return
        if body.request == message:
            where = f" (field {body.detail})" if body.refusal == StripRefusal.BAD_VALUE else ""
            raise DeviceError(f"{self.port.name}: refused {message.name.lower()}: {reason}{where}")


class KeyLine(Protocol):
    """The key line of a board without hardware."""

    def press_at(self, time_s: float) -> None:
        """Let the key go down at a time of the board's clock that is still to come, after all others."""


@dataclass(frozen=True)
class StripRound:
    """What one round shows; checked by the board, which refuses what it cannot show (DeviceError).

    Attributes
    ----------
    speed_px_s : of the bullet, 20 to 200; the paper's 100 (easy) or 150 (hard).
    delay_s : from asking to the bullet's start, 0.05 to 10.
    pixels : length of the strip, 8 to 240.
    zone_px : pixel in the middle of the zone, from 0; the bullet comes to it at the target's time.
    zone_half_px : pixels of the zone on either side of that, 0 to 7.
    after_s : from the target to the end of the round, 0.05 to 5.
    brightness : of what is lit, 1 to 31.
    led : EACH (APA102, a pixel shows what it is sent at once) or TOGETHER (SK9822, all after the frame).
    """

    speed_px_s: int = 100
    delay_s: float = 1.0
    pixels: int = 144
    zone_px: int = 100
    zone_half_px: int = 5
    after_s: float = 0.6
    brightness: int = 8
    led: StripLed = StripLed.EACH

    def drawn(self, seed: int, number: int) -> StripRound:
        """Return this round with the start delay that the seed and the round's number determine."""
        delay_s = float(np.random.default_rng((seed, number)).uniform(*DELAYS_s))
        return replace(self, delay_s=delay_s)

    def request(self, number: int) -> StripBeginRequest:
        """Return the request for it. ModelError for a number beyond the wire's range."""
        same = {k: v for k, v in vars(self).items() if k not in ("delay_s", "after_s")}
        delay_ms, after_ms = round(1e3 * self.delay_s), round(1e3 * self.after_s)
        return StripBeginRequest(round=number, delay_ms=delay_ms, after_ms=after_ms, **same)


@dataclass(frozen=True)
class StripStart:
    """When a round's bullet starts and is at the zone's middle, and when it ends, on the board's clock."""

    start_s: float
    target_s: float
    end_s: float


@dataclass(frozen=True)
class StripResult:
    """How a round went.

    Attributes
    ----------
    start_s, target_s : when the bullet started and was at the zone's middle, on the board's clock.
    activations_s : when the key went down, rising, on that clock, to 1 us; the first eight of `presses`.
    presses : how often it did between asking for the round and its end.
    frames : sent for steps of the bullet.
    late_s : the latest of them was begun so long after its time, by the board's clock.
    is_whole : false: the board went dark in the round since it heard nothing of the host.
    """

    start_s: float
    target_s: float
    activations_s: tuple[float, ...]
    presses: int
    frames: int
    late_s: float
    is_whole: bool


class LedPointingTask:
    """The board with the LED strip at an open line.

    Raises DeviceError, and closes the line, if the board is silent, another one, of another version, or at
    another's round.
    """

    def __init__(self, port: Port) -> None:
        self.port = port
        try:
            self._wire = StripWire(port)
            status = self.status()
            if status.mode in PLAYING:
                raise DeviceError(
                    f"{port.name}: the strip is at a round of another program; wait for its end, or stop it"
                )
        except BaseException:
            port.close()
            raise
        self._near_us, self._near_at_s = float(status.time_us), port.now_s()
        # another than that of a program before this one, whose request might still be repeated
        self._number = status.time_us % 2**16

    def status(self) -> StripStatusReply:
        """Ask how the board is: its clock, edges of the key line since boot, level of that line."""
        return self._wire.ask(StripMessage.STATUS, StripStatusReply)

    def begin(self, order: StripRound) -> StripStart:
        """Start a round. DeviceError if one goes on, or the strip cannot show this one."""
        self._number = (self._number + 1) % 2**16
        reply = self._wire.ask(StripMessage.BEGIN, StripBeginReply, order.request(self._number))
        start_s, target_s, end_s = (self._s(us) for us in (reply.start_us, reply.target_us, reply.end_us))
        return StripStart(start_s, target_s, end_s)

    def result(self) -> StripResult | None:
        """Ask how the round that was begun last went; None while it goes on."""
        reply = self._wire.ask(StripMessage.READ_ROUND, StripReadRoundReply)
        if reply.round != self._number:
            raise DeviceError(f"{self.port.name}: another program used the strip; play the round again")
        return None if reply.mode in PLAYING else self._read(reply)

    def _read(self, reply: StripReadRoundReply) -> StripResult:
        target_s = self._s(reply.target_us)
        errors_us = struct.unpack(f"<{STRIP_PRESSES}i", reply.asynchronies_us)
        activations_s = tuple(target_s + 1e-6 * us for us in errors_us[: min(reply.presses, STRIP_PRESSES)])
        whole, late_s = reply.mode == StripMode.OVER, 1e-6 * reply.late_us
        counts = reply.presses, reply.frames
        return StripResult(self._s(reply.start_us), target_s, activations_s, *counts, late_s, whole)

    def play(self, order: StripRound) -> StripResult:
        """Start a round and wait for its end."""
        return self.wait(self.begin(order))

    def wait(self, start: StripStart, meanwhile: Callable[[], None] | None = None) -> StripResult:
        """Wait for a round, calling `meanwhile` every GLANCE_s; DeviceError if it does not end in time."""
        until_s = self.port.now_s() + LONGEST_DELAY_s + (start.end_s - start.start_s) + PATIENCE_s
        while self.port.now_s() < until_s:
            if (found := self.result()) is not None:
                return found
            if meanwhile:
                meanwhile()
            self.port.read(self.port.now_s() + GLANCE_s)
        raise DeviceError(f"{self.port.name}: the strip does not end its round; reset the board")

    def show(self, first: int, count: int, colour: tuple[int, int, int], brightness: int = 8) -> None:
        """Light at most 16 pixels in red, green, blue of 0 to 255 until the next command, to check the strip.

        It goes dark by itself where `status` is not asked for half a second.
        """
        light = {"red": colour[0], "green": colour[1], "blue": colour[2], "brightness": brightness}
        self._wire.command(StripMessage.SHOW, StripShowRequest(first=first, count=count, **light))

    def stop(self) -> None:
        self._wire.command(StripMessage.STOP)

    @property
    def firmware(self) -> str:
        return ".".join(str(self._wire.hello.firmware >> shift & 255) for shift in (16, 8, 0))

    @property
    def was_reset(self) -> bool:
        return bool(self._wire.hello.flags & StripBoardFlag.WATCHDOG)

    def _s(self, time_us: int) -> float:
        """Return a time without the turns of the board's counter, which the line's clock bridges."""
        now_s = self.port.now_s()
        self._near_us = unwrap_us(time_us, self._near_us + 1e6 * (now_s - self._near_at_s))
        self._near_at_s = now_s
        return 1e-6 * self._near_us

    def close(self) -> None:
        """Go dark and let the line go; a second time does nothing."""
        try:
            with suppress(DeviceError):  # it is gone, and dark by itself
                self.stop()
        finally:
            self.port.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

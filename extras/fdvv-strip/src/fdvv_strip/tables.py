"""Made by tools/make_protocol.py from protocol/strip.toml; do not edit."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum, IntFlag
from typing import ClassVar

from fdvv.protocol.record import Limits, Record

STRIP_VERSION = 1
"""Of the definition."""
STRIP_HASH = 0xFEAE5A1E
"""Of what the definition means; host and firmware compare it on connecting."""

STRIP_FRAME_BYTES = 64
"""Largest frame before stuffing: id, sequence, payload, checksum."""
STRIP_MOST_PIXELS = 240
"""Longest strip."""
STRIP_PRESSES = 8
"""Presses of a round that are kept; more are counted."""
STRIP_LIT_PIXELS = 16
"""Most pixels lit at once by show: a strip all white would take 8 A."""
STRIP_HOST_TIMEOUT_MS = 500
"""Silence of the host after which the strip goes dark."""


class StripMode(IntEnum):
    """What the board is at."""

    IDLE = 0
    WAITING = 1
    MOVING = 2
    OVER = 3
    SHOWING = 4
    LOST = 5


class StripRefusal(IntEnum):
    """Why a request was not carried out."""

    NONE = 0
    UNKNOWN_MESSAGE = 1
    BAD_LENGTH = 2
    BAD_VALUE = 3
    BUSY = 4
    HASH_MISMATCH = 5


class StripLed(IntEnum):
    """When a pixel shows what it was sent."""

    EACH = 0
    TOGETHER = 1


class StripBoardFlag(IntFlag):
    """Bits of what happened to the board."""

    WATCHDOG = 1 << 0
    EDGES_LOST = 1 << 1


class StripMessage(IntEnum):
    """Numbers of the messages."""

    HELLO = 0x01
    """Who are you; must be the first request."""
    STATUS = 0x02
    """I am here; how are you."""
    BEGIN = 0x03
    """Play a round: show the zone, after the delay let the bullet run; the round that is already played only has its result repeated."""
    READ_ROUND = 0x04
    """How does the round go, or how did it."""
    STOP = 0x05
    """End the round or what is shown; go dark."""
    SHOW = 0x06
    """Light a few pixels, to check the strip; not during a round."""
    REFUSED = 0x7F
    """Reply to a request that was not carried out (sent as id + 0x80)."""


STRIP_REQUEST_BYTES = {
    StripMessage.HELLO: 8,
    StripMessage.STATUS: 0,
    StripMessage.BEGIN: 14,
    StripMessage.READ_ROUND: 0,
    StripMessage.STOP: 0,
    StripMessage.SHOW: 6,
    StripMessage.REFUSED: 0,
}
"""Bytes of every request."""

STRIP_REPLY_BYTES = {
    StripMessage.HELLO: 28,
    StripMessage.STATUS: 16,
    StripMessage.BEGIN: 12,
    StripMessage.READ_ROUND: 48,
    StripMessage.STOP: 0,
    StripMessage.SHOW: 0,
    StripMessage.REFUSED: 4,
}
"""Bytes of every reply."""


@dataclass(frozen=True, kw_only=True)
class StripHelloRequest(Record):
    """Who are you; must be the first request (request).

    Attributes
    ----------
    version : 0 to 65535
    spare : zero
    hash : 0 to 4294967295; of this definition
    """

    FORMAT: ClassVar[str] = "<HHI"
    LIMITS: ClassVar[Limits] = {
        "version": (0, 65535),
        "spare": (0, 0),
        "hash": (0, 4294967295),
    }

    version: int
    spare: int = 0
    hash: int


@dataclass(frozen=True, kw_only=True)
class StripHelloReply(Record):
    """Who are you; must be the first request (reply).

    Attributes
    ----------
    hash : 0 to 4294967295; of the definition the board was built from
    firmware : 0 to 4294967295; version, major.minor.patch in bytes 2, 1, 0
    most_pixels : px; 0 to 65535; longest strip
    mode : 0 to 5
    flags : 0 to 255; bits of flags.board
    name : ASCII; 0 to 126; kind of board
    """

    FORMAT: ClassVar[str] = "<IIHBB16s"
    LIMITS: ClassVar[Limits] = {
        "hash": (0, 4294967295),
        "firmware": (0, 4294967295),
        "most_pixels": (0, 65535),
        "mode": (0, 5),
        "flags": (0, 255),
    }

    hash: int
    firmware: int
    most_pixels: int
    mode: int
    flags: int
    name: bytes


@dataclass(frozen=True, kw_only=True)
class StripStatusReply(Record):
    """I am here; how are you (reply).

    Attributes
    ----------
    time_us : us; 0 to 4294967295; the board's clock
    edges : 0 to 4294967295; of the key line since boot
    bad_frames : 0 to 4294967295; received with checksum, stuffing or length wrong
    key : 0 to 1; level of the key line
    mode : 0 to 5
    flags : 0 to 255; bits of flags.board
    spare : zero
    """

    FORMAT: ClassVar[str] = "<IIIBBBB"
    LIMITS: ClassVar[Limits] = {
        "time_us": (0, 4294967295),
        "edges": (0, 4294967295),
        "bad_frames": (0, 4294967295),
        "key": (0, 1),
        "mode": (0, 5),
        "flags": (0, 255),
        "spare": (0, 0),
    }

    time_us: int
    edges: int
    bad_frames: int
    key: int
    mode: int
    flags: int
    spare: int = 0


@dataclass(frozen=True, kw_only=True)
class StripBeginRequest(Record):
    """Play a round: show the zone, after the delay let the bullet run; the round that is already played only has its result repeated (request).

    Attributes
    ----------
    round : 0 to 65535; the host's number, another for every round
    speed_px_s : px/s; 20 to 200; of the bullet; a frame of the longest strip must fit into a step with time to spare
    delay_ms : ms; 50 to 10000; from now to the bullet's start
    after_ms : ms; 50 to 5000; from the target's time to the end of the round
    pixels : px; 8 to 240; length of the strip
    zone_px : px; 1 to 239; the zone's middle, counted from 0, reached at the target's time; all of the zone must lie on the strip
    zone_half_px : px; 0 to 7; pixels of the zone on either side of it
    brightness : 1/31; 1 to 31; of the pixels that are lit
    led : 0 to 1; kind of pixel
    spare : zero
    """

    FORMAT: ClassVar[str] = "<HHHHBBBBBB"
    LIMITS: ClassVar[Limits] = {
        "round": (0, 65535),
        "speed_px_s": (20, 200),
        "delay_ms": (50, 10000),
        "after_ms": (50, 5000),
        "pixels": (8, 240),
        "zone_px": (1, 239),
        "zone_half_px": (0, 7),
        "brightness": (1, 31),
        "led": (0, 1),
        "spare": (0, 0),
    }

    round: int
    speed_px_s: int
    delay_ms: int
    after_ms: int
    pixels: int
    zone_px: int
    zone_half_px: int
    brightness: int
    led: int
    spare: int = 0


@dataclass(frozen=True, kw_only=True)
class StripBeginReply(Record):
    """Play a round: show the zone, after the delay let the bullet run; the round that is already played only has its result repeated (reply).

    Attributes
    ----------
    start_us : us; 0 to 4294967295; the bullet appears at pixel 0
    target_us : us; 0 to 4294967295; it reaches the zone's middle
    end_us : us; 0 to 4294967295; presses are taken until then
    """

    FORMAT: ClassVar[str] = "<III"
    LIMITS: ClassVar[Limits] = {
        "start_us": (0, 4294967295),
        "target_us": (0, 4294967295),
        "end_us": (0, 4294967295),
    }

    start_us: int
    target_us: int
    end_us: int


@dataclass(frozen=True, kw_only=True)
class StripReadRoundReply(Record):
    """How does the round go, or how did it (reply).

    Attributes
    ----------
    round : 0 to 65535; the host's number
    mode : 0 to 5
    presses : 0 to 255; rising edges of the key line since the round began; 255 and more
    start_us : us; 0 to 4294967295; the bullet appeared at pixel 0
    target_us : us; 0 to 4294967295; it reached the zone's middle
    frames : 0 to 65535; sent for steps of the bullet
    late_us : us; 0 to 65535; the latest of them was begun so long after its time
    asynchronies_us : 0 to 255; eight i32: the first presses' times less the target's, us
    """

    FORMAT: ClassVar[str] = "<HBBIIHH32s"
    LIMITS: ClassVar[Limits] = {
        "round": (0, 65535),
        "mode": (0, 5),
        "presses": (0, 255),
        "start_us": (0, 4294967295),
        "target_us": (0, 4294967295),
        "frames": (0, 65535),
        "late_us": (0, 65535),
    }

    round: int
    mode: int
    presses: int
    start_us: int
    target_us: int
    frames: int
    late_us: int
    asynchronies_us: bytes


@dataclass(frozen=True, kw_only=True)
class StripShowRequest(Record):
    """Light a few pixels, to check the strip; not during a round (request).

    Attributes
    ----------
    first : px; 0 to 239; first pixel lit
    count : px; 0 to 16; how many
    red : 0 to 255
    green : 0 to 255
    blue : 0 to 255
    brightness : 1/31; 1 to 31
    """

    FORMAT: ClassVar[str] = "<BBBBBB"
    LIMITS: ClassVar[Limits] = {
        "first": (0, 239),
        "count": (0, 16),
        "red": (0, 255),
        "green": (0, 255),
        "blue": (0, 255),
        "brightness": (1, 31),
    }

    first: int
    count: int
    red: int
    green: int
    blue: int
    brightness: int


@dataclass(frozen=True, kw_only=True)
class StripRefusedReply(Record):
    """Reply to a request that was not carried out (sent as id + 0x80) (reply).

    Attributes
    ----------
    request : 0 to 255; id
    refusal : 0 to 255
    detail : 0 to 65535; number of the field
    """

    FORMAT: ClassVar[str] = "<BBH"
    LIMITS: ClassVar[Limits] = {
        "request": (0, 255),
        "refusal": (0, 255),
        "detail": (0, 65535),
    }

    request: int
    refusal: int
    detail: int

"""Frames on a byte stream: id, sequence, payload, CRC-16, stuffed (COBS) and ended by a zero byte."""

from __future__ import annotations

import binascii
from dataclasses import dataclass

from fdvv.errors import ModelError
from fdvv.protocol.tables import FRAME_BYTES

OVERHEAD_BYTES = 4
"""Id, sequence and checksum."""


@dataclass(frozen=True)
class Frame:
    """One message as it travels.

    Attributes
    ----------
    message : its number; a reply's is the request's plus 0x80.
    sequence : 0 to 255; a reply has its request's.
    payload : bytes of the message's structure.
    """

    message: int
    sequence: int
    payload: bytes = b""

    def __post_init__(self) -> None:
        if not (0 <= self.message <= 255 and 0 <= self.sequence <= 255):
            raise ModelError(f"message and sequence must be 0 to 255, got {self.message}, {self.sequence}")
        if len(self.payload) > FRAME_BYTES - OVERHEAD_BYTES:
            limit = FRAME_BYTES - OVERHEAD_BYTES
            raise ModelError(f"a payload has at most {limit} bytes, got {len(self.payload)}")


def crc16(data: bytes, start: int = 0xFFFF) -> int:
    """Return the CRC-16 of CCITT: polynomial 0x1021, not reflected, started at 0xffff."""
    return binascii.crc_hqx(data, start)


def stuff(data: bytes) -> bytes:
    """Free data (at most 253 bytes) of zeros: consistent overhead byte stuffing, Cheshire and Baker 1999."""
    return b"".join(bytes([len(block) + 1]) + block for block in data.split(b"\0"))


def unstuff(data: bytes) -> bytes:
    """Undo `stuff`; ModelError on bytes that it cannot have made."""
    blocks, place = [], 0
    while place < len(data):
        code = data[place]
        block = data[place + 1 : place + code]
        if code == 0 or len(block) != code - 1 or 0 in block:
            raise ModelError(f"stuffing is wrong at byte {place}")
        blocks.append(block)
        place += code
    return b"\0".join(blocks)


def encode(frame: Frame) -> bytes:
    """Return the bytes of a frame on the wire, its ending zero among them."""
    data = bytes([frame.message, frame.sequence]) + frame.payload
    return stuff(data + crc16(data).to_bytes(2, "little")) + b"\0"


def decode(stuffed: bytes) -> Frame:
    """Read what lies between two zeros; ModelError says what is wrong with it."""
    data = unstuff(stuffed)
    if not OVERHEAD_BYTES <= len(data) <= FRAME_BYTES:
        raise ModelError(f"a frame has {OVERHEAD_BYTES} to {FRAME_BYTES} bytes, got {len(data)}")
    sent, computed = int.from_bytes(data[-2:], "little"), crc16(data[:-2])
    if sent != computed:
        raise ModelError(f"checksum is {sent:#06x}, the bytes give {computed:#06x}")
    return Frame(data[0], data[1], data[2:-2])


class FrameDecoder:
    """Cuts a stream of bytes into frames; what is damaged is counted and left out.

    Attributes
    ----------
    whole, bad : frames so far.
    """

    def __init__(self) -> None:
        self.whole = self.bad = 0
        self._open = b""

    def feed(self, data: bytes) -> list[Frame]:
        """Take bytes as they come and give the frames that they complete."""
        *ended, self._open = (self._open + data).split(b"\0")
        if len(self._open) > FRAME_BYTES + 1:
            self._open = self._open[: FRAME_BYTES + 2]  # too long already: bad at its end, whatever follows
        frames = []
        for stuffed in filter(None, ended):
            try:
                frames.append(decode(stuffed))
            except ModelError:
                self.bad += 1
        self.whole += len(frames)
        return frames

    def reset(self) -> None:
        """Forget an unfinished frame; the counters stay."""
        self._open = b""

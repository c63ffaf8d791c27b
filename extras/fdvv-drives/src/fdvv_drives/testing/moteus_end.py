"""A moteus behind a fdcanusb, written from mjbots' reference manual; it shares no code with their library.

Lines: ``can send ID HEX FLAGS`` is answered by ``OK`` and, where bit 15 of the identifier asks for it, by
``rcv ID HEX FLAGS``. Subframes of the multiplex protocol: 0x00 to 0x0f write, 0x10 to 0x1f read, 0x50
nothing; bits 2 and 3 choose int8, int16, int32 or float, bits 0 and 1 the count, 0 for one that follows.
Simulated.
"""

from __future__ import annotations

import math
import struct

from fdvv_drives.testing.far_end import FaultKind

STOPPED, FAULT, POSITION, TIMEOUT = 0, 1, 10, 11
OVER_TEMPERATURE = 38
COUNTS_REV = 2**14
CELL_ZERO, CELL_SPAN_N = 0.25, 20.0
"""Of the load cell at the input aux1.2, register 0x061."""
KINDS = ("<b", "<h", "<i", "<f")
SCALES = {
    0x01: (0.01, 1e-4, 1e-5),
    0x02: (0.1, 0.00025, 1e-5),
    0x03: (0.5, 0.01, 0.001),
    0x0D: (0.5, 0.1, 0.001),
    0x0E: (1.0, 0.1, 0.001),
    0x20: (0.01, 1e-4, 1e-5),
    0x21: (0.1, 0.00025, 1e-5),
    0x22: (0.5, 0.01, 0.001),
    0x23: (1 / 127, 1 / 32767, 1 / 2147483647),
    0x24: (1 / 127, 1 / 32767, 1 / 2147483647),
    0x25: (0.5, 0.01, 0.001),
    0x61: (1 / 127, 1 / 32767, 1 / 2147483647),
    0x27: (0.01, 0.001, 1e-6),
}
"""Of a register as an integer of 1, 2 and 4 bytes; others are plain numbers."""


class FarMoteus:
    """One controller, id 1.

    Attributes
    ----------
    torque : in Nm. mode, fault : as the registers 0x000 and 0x00f.
    """

    ID = 1

    def __init__(self, watchdog_s: float | None) -> None:
        """Ignore watchdog_s: it comes with every command."""
        self.torque = self.finger_N = 0.0
        self.mode, self.fault = STOPPED, 0
        self._registers: dict[int, float] = {}
        self._heard_s = 0.0
        self._waiting = b""
        self._position = 0.0

    def fail(self, kind: FaultKind) -> None:
        self.fault = OVER_TEMPERATURE if kind == "error" else 0
        if kind == "error":
            self.mode = FAULT
        elif kind == "mode":
            self.mode = 12  # as if another host had asked for zero velocity
        elif self.mode in (FAULT, 12):
            self.mode = STOPPED

    def look(self, position: float, now_s: float) -> bytes:
        self._position = position
        timeout_s = self._registers.get(0x27, math.nan)
        if self.mode == POSITION and now_s - self._heard_s > timeout_s:
            self.mode = TIMEOUT
        self.torque = self._commanded() if self.mode == POSITION else 0.0
        return b""

    def _commanded(self) -> float:
        """Return the feedforward torque; with any gain left this end would not know what acts."""
        registers = self._registers
        if registers.get(0x23, 1.0) or registers.get(0x24, 1.0):
            raise ValueError("the gains are not scaled to zero")
        limit = registers.get(0x25, math.inf)
        return min(limit, max(-limit, registers.get(0x22, 0.0)))

    def answer(self, data: bytes, position: float, now_s: float) -> bytes:
        *lines, self._waiting = (self._waiting + data).split(b"\n")
        replies = b"".join(self._line(line.decode("ascii").split(), now_s) for line in lines if line.strip())
        self.look(position, now_s)
        return replies

    def _line(self, words: list[str], now_s: float) -> bytes:
        if (
            words[:2] != ["can", "send"]
            or len(words) < 4
            or len(words[3]) // 2 not in (*range(9), 12, 16, 20, 24, 32, 48, 64)
        ):
            return b"ERR unknown command\r\n"
        identifier, frame = int(words[2], 16), bytes.fromhex(words[3])
        if identifier & 0x7F != self.ID:
            return b"OK\r\n"
        reads = self._frame(frame, now_s)
        self.look(self._position, now_s)
        if not identifier & 0x8000:
            return b"OK\r\n"
        source = identifier >> 8 & 0x7F
        body = b"".join(self._reply(*read) for read in reads)
        return f"OK\r\nrcv {self.ID << 8 | source:x} {body.hex()} E B F\r\n".encode()

    def _frame(self, frame: bytes, now_s: float) -> list[tuple[int, int, int]]:
        """Carry out what a frame writes; return what it reads as (kind, register, count)."""
        reads, written, at = [], {}, 0
        while at < len(frame):
            head = frame[at]
            at += 1
            if head == 0x50:
                continue
            if head >= 0x20:
                raise ValueError(f"subframe {head:#x} is not expected of a host")
            kind, count = head >> 2 & 3, head & 3
            if not count:
                count, at = frame[at], at + 1
            register, at = frame[at], at + 1  # none above 0x7f is used here
            if head & 0x10:
                reads.append((kind, register, count))
                continue
            for number in range(register, register + count):
                (raw,) = struct.unpack_from(KINDS[kind], frame, at)
                written[number] = _value(number, kind, raw)
                at += struct.calcsize(KINDS[kind])
        self._write(written, now_s)
        return reads

    def _write(self, written: dict[int, float], now_s: float) -> None:
        if 0 not in written:
            return
        mode = int(written.pop(0))
        if mode == STOPPED:
            self.mode = STOPPED if not self.fault else FAULT
        elif self.mode in (STOPPED, POSITION):
            self.mode = mode
        if mode == POSITION:
            self._registers, self._heard_s = written, now_s

    def _reply(self, kind: int, register: int, count: int) -> bytes:
        head = 0x20 | kind << 2 | (count if count < 4 else 0)
        body = bytes([head, *([count] if count > 3 else []), register])
        for number in range(register, register + count):
            value = self._read(number)
            if kind < 3:
                value = round(value / SCALES.get(number, (1.0, 1.0, 1.0))[kind])
            body += struct.pack(KINDS[kind], value)
        return body

    def _read(self, register: int) -> float:
        return {
            0x00: float(self.mode),
            0x01: round(self._position * COUNTS_REV) / COUNTS_REV,
            0x03: self.torque,
            0x0D: 24.0,
            0x0E: 31.0,
            0x0F: float(self.fault),
            0x61: min(1.0, max(0.0, CELL_ZERO + self.finger_N / CELL_SPAN_N)),
        }.get(register, 0.0)


def _value(register: int, kind: int, raw: float) -> float:
    if kind == 3 or register == 0:
        return raw
    lowest = (-(2**7), -(2**15), -(2**31))[kind]
    return math.nan if raw == lowest else raw * SCALES.get(register, (1.0, 1.0, 1.0))[kind]

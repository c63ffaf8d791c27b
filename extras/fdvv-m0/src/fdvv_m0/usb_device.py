"""The USB device of the emulated chip, as the wire sees it: SETUP, IN and OUT on eight endpoints."""

from __future__ import annotations

import struct
from collections.abc import Callable
from enum import Enum

from fdvv_m0.bus import Bus

BASE = 0x41005000
CTRLA, SYNCBUSY, CTRLB, DADD = BASE, BASE + 2, BASE + 8, BASE + 0xA
INTENCLR, INTENSET, INTFLAG, EPINTSMRY, DESCADD = (BASE + at for at in (0x14, 0x18, 0x1C, 0x20, 0x24))
SUSPEND, END_OF_RESET, RESUME = 1 << 0, 1 << 3, 1 << 4
EP, EP_STEP, ENDPOINTS = BASE + 0x100, 0x20, 8
STATUSCLR, STATUSSET, STATUS, FLAG, ENCLR, ENSET = range(4, 10)
STALL_OUT, STALL_IN, OUT_FULL, IN_FULL = 1 << 4, 1 << 5, 1 << 6, 1 << 7
DONE_OUT, DONE_IN, SETUP_CAME = 1 << 0, 1 << 1, 1 << 4


class Answer(Enum):
    """What a device says when it has no data to give."""

    NAK = "not now"
    STALL = "never"


class UsbDevice:
    """Registers and memory banks; `attached` and `given` are called when a host would notice something."""

    def __init__(self, bus: Bus, attached: Callable[[], None], given: Callable[[], None]) -> None:
        self._bus, self._attached, self._given = bus, attached, given
        self._is_resetting = False
        bus.put(CTRLB, 2, 1)  # detached
        bus.on_write(CTRLA, self._control)
        bus.on_read(SYNCBUSY, self._busy)
        bus.on_write(CTRLB, self._attach)
        bus.on_write(INTENSET, lambda size, value: self._enable(bus.get(INTENSET, 2) | value))
        bus.on_write(INTENCLR, lambda size, value: self._enable(bus.get(INTENSET, 2) & ~value))
        bus.on_write(INTFLAG, lambda size, value: bus.put(INTFLAG, 2, bus.get(INTFLAG, 2) & ~value))
        for endpoint in range(ENDPOINTS):
            self._claim(endpoint)

    def _claim(self, endpoint: int) -> None:
        bus, at = self._bus, EP + EP_STEP * endpoint
        bus.on_write(at + STATUSSET, lambda size, value: self._status(at, bus.get(at + STATUS, 1) | value))
        bus.on_write(at + STATUSCLR, lambda size, value: self._status(at, bus.get(at + STATUS, 1) & ~value))
        bus.on_write(at + ENSET, lambda size, value: self._allow(at, bus.get(at + ENSET, 1) | value))
        bus.on_write(at + ENCLR, lambda size, value: self._allow(at, bus.get(at + ENSET, 1) & ~value))
        bus.on_write(at + FLAG, lambda size, value: self._flag(at, bus.get(at + FLAG, 1) & ~value))

    # -- the program's side ----------------------------------------------------------------------------------

    def _control(self, size: int, value: int) -> None:
        self._is_resetting = bool(value & 1)
        self._bus.put(CTRLA, size, value & ~1)

    def _busy(self, _size: int) -> int:
        busy, self._is_resetting = self._is_resetting, False
        return int(busy)

    def _attach(self, size: int, value: int) -> None:
        was_detached = self._bus.get(CTRLB, 2) & 1
        self._bus.put(CTRLB, size, value)
        if was_detached and not value & 1:
            self._attached()

    def _enable(self, value: int) -> None:
        for register in (INTENSET, INTENCLR):  # both read back what is enabled
            self._bus.put(register, 2, value)

    def _status(self, at: int, value: int) -> None:
        for register in (STATUS, STATUSSET, STATUSCLR):
            self._bus.put(at + register, 1, value)
        self._given()

    def _allow(self, at: int, value: int) -> None:
        self._bus.put(at + ENSET, 1, value)
        self._bus.put(at + ENCLR, 1, value)
        self._summarise(at)

    def _flag(self, at: int, value: int) -> None:
        self._bus.put(at + FLAG, 1, value)
        self._summarise(at)

    def _summarise(self, at: int) -> None:
        bit = 1 << (at - EP) // EP_STEP
        waits = self._bus.get(at + FLAG, 1) & self._bus.get(at + ENSET, 1)
        self._bus.put(EPINTSMRY, 2, self._bus.get(EPINTSMRY, 2) & ~bit | (bit if waits else 0))

    # -- the wire's side -------------------------------------------------------------------------------------

    def raise_flag(self, flag: int) -> None:
        """Let the program see a bus event."""
        self._bus.put(INTFLAG, 2, self._bus.get(INTFLAG, 2) | flag)

    def bus_reset(self) -> None:
        """Drive a bus reset: address and endpoints forgotten."""
        self._bus.put(DADD, 1, 0)
        for at in range(EP, EP + EP_STEP * ENDPOINTS, EP_STEP):
            self._bus.put(at, 1, 0)
            for register in (STATUSCLR, STATUSSET, STATUS, FLAG, ENCLR, ENSET):
                self._bus.put(at + register, 1, 0)
        self._bus.put(EPINTSMRY, 2, 0)
        self.raise_flag(END_OF_RESET)

    def _bank(self, endpoint: int, is_in: bool) -> tuple[int, int, int]:
        at = self._bus.get(DESCADD, 4) + 32 * endpoint + 16 * is_in
        data, sizes = struct.unpack("<II", self._bus.ram_read(at, 8))
        return at + 4, data, sizes

    def setup(self, packet: bytes) -> None:
        """Send a SETUP packet, which a device takes once it has set up endpoint 0."""
        if not self._bus.get(EP, 1) & 7:
            return
        at, data, sizes = self._bank(0, False)
        self._bus.ram_write(data, packet)
        self._bus.ram_write(at, struct.pack("<I", sizes & ~0x3FFF | len(packet)))
        self._bus.put(EP + STATUS, 1, OUT_FULL)
        self._flag(EP, self._bus.get(EP + FLAG, 1) | SETUP_CAME)

    def give(self, endpoint: int) -> bytes | Answer:
        """Ask for data with IN."""
        at = EP + EP_STEP * endpoint
        status = self._bus.get(at + STATUS, 1)
        if status & STALL_IN:
            return Answer.STALL
        if not status & IN_FULL:
            return Answer.NAK
        _at, data, sizes = self._bank(endpoint, True)
        packet = self._fetch(data, sizes & 0x3FFF)
        self._bus.put(at + STATUS, 1, status & ~IN_FULL)
        self._flag(at, self._bus.get(at + FLAG, 1) | DONE_IN)
        return packet

    def _fetch(self, address: int, count: int) -> bytes:
        if address >= 0x20000000 or not count:
            return self._bus.ram_read(address, count) if count else b""
        return bytes(self._bus.flash[address : address + count])

    def take(self, endpoint: int, packet: bytes) -> Answer | None:
        """Offer a packet with OUT; None if it was taken."""
        at = EP + EP_STEP * endpoint
        status = self._bus.get(at + STATUS, 1)
        if status & STALL_OUT:
            return Answer.STALL
        if status & OUT_FULL or not self._bus.get(at, 1) & 7:
            return Answer.NAK
        sizes_at, data, sizes = self._bank(endpoint, False)
        count = (sizes & 0x3FFF) + len(packet)
        if packet:
            self._bus.ram_write(data + (sizes & 0x3FFF), packet)
        self._bus.ram_write(sizes_at, struct.pack("<I", sizes & ~0x3FFF | count))
        limit = 8 << (sizes >> 28 & 7)
        if len(packet) < limit or count >= sizes >> 14 & 0x3FFF:
            self._bus.put(at + STATUS, 1, status | OUT_FULL)
            self._flag(at, self._bus.get(at + FLAG, 1) | DONE_OUT)
        return None

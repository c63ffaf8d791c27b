"""The I2C bus of the emulated board: SERCOM3 as master, and who answers."""

from __future__ import annotations

from fdvv_m0.bus import Bus
from fdvv_m0.records import CPU_MHZ, WireMessage
from fdvv_m0.system import Clocks

BASE = 0x42001400
CTRLA, CTRLB, BAUD, INTFLAG, STATUS, ADDR, DATA = (BASE + at for at in (0, 4, 0xC, 0x18, 0x1A, 0x24, 0x28))
PERIPHERAL, ENABLE, MASTER_ON_BUS, STOP, NOT_ACKNOWLEDGED, IDLE, OWNER = 0x17, 2, 1, 3, 4, 1 << 4, 2 << 4
RISE_CLOCKS = 14  # 300 ns, as the data sheet's formula for the rate counts it


class Wire:
    """Moves bytes at the programmed rate; addresses in `answering` acknowledge, others do not."""

    def __init__(self, bus: Bus, clocks: Clocks) -> None:
        self._bus, self._clocks = bus, clocks
        self.answering = {0x2A}
        self.is_stuck = False  # a slave holds the clock low: nothing ends
        self.messages: list[WireMessage] = []
        self._started = 0
        self._address: int | None = None
        self._data = bytearray()
        self._acknowledged = False
        bus.on_write(CTRLA, self._control)
        bus.on_write(ADDR, self._address_written)
        bus.on_write(DATA, self._data_written)
        bus.on_write(CTRLB, self._command)

    def bit_cycles(self) -> float:
        """Return the processor cycles of one bit."""
        clocks = 10 + 2 * (self._bus.get(BAUD, 4) & 0xFF) + RISE_CLOCKS
        return clocks * self._clocks.cycles_per_clock(PERIPHERAL)

    def _control(self, size: int, value: int) -> None:
        self._bus.put(CTRLA, size, value & ~1)
        if value & 1:
            self._address = None
            self._bus.put(STATUS, 2, 0)
            self._bus.put(INTFLAG, 1, 0)

    def _address_written(self, size: int, value: int) -> None:
        self._bus.put(ADDR, size, value)
        if not self._bus.get(CTRLA, 4) & ENABLE or not self._bus.get(STATUS, 2) & IDLE:
            return
        self._started, self._address, self._data = self._bus.cycles, value >> 1 & 0x7F, bytearray()
        self._acknowledged = self._address in self.answering
        self._bus.put(STATUS, 2, OWNER)
        self._finish_after(10)  # START, seven bits of address, direction, acknowledge

    def _data_written(self, _size: int, value: int) -> None:
        if self._address is None:
            return
        self._data.append(value & 0xFF)
        self._bus.put(INTFLAG, 1, 0)
        self._finish_after(9)

    def _finish_after(self, bits: int) -> None:
        if not self.is_stuck:
            self._bus.after(round(bits * self.bit_cycles()), self._finish)

    def _finish(self) -> None:
        if self._address is not None:
            self._bus.put(STATUS, 2, OWNER | (0 if self._acknowledged else NOT_ACKNOWLEDGED))
            self._bus.put(INTFLAG, 1, MASTER_ON_BUS)

    def _command(self, size: int, value: int) -> None:
        self._bus.put(CTRLB, size, value & ~(3 << 16))
        if value >> 16 & 3 == STOP and self._address is not None:
            stopped = (self._bus.cycles + self.bit_cycles()) / CPU_MHZ
            times = self._started / CPU_MHZ, stopped
            message = WireMessage(*times, self._address, bytes(self._data), self._acknowledged)
            self.messages.append(message)
            self._address = None
            self._bus.put(INTFLAG, 1, 0)
            self._bus.put(STATUS, 2, IDLE)

"""The tick's timers 3 and 4, and the pulse-width timers 0 and 1 of the emulated chip."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from fdvv_m0.bus import COUNTER, Bus
from fdvv_m0.records import CPU_MHZ, PwmChange
from fdvv_m0.system import Clocks, Port

TC3, TC4 = 0x42002C00, 0x42003000
CTRLA, EVCTRL, COUNT, CC0 = 0x00, 0x0A, 0x10, 0x18
ENABLE = 1 << 1
TC2_TC3, TC4_TC5, TCC0_TCC1 = 0x1B, 0x1C, 0x1A
OVERFLOW_EVENT, COUNT_EVENTS = 1 << 8, 2 | 1 << 5
EVSYS_CHANNEL, EVSYS_USER = 0x42000404, 0x42000408
TC3_OVERFLOW, USER_TC4, USER_ADC_START = 0x33, 0x13, 0x17
TCC0, TCC1 = 0x42002000, 0x42002400
PER, CC, CCB = 0x40, 0x44, 0x70
PINS = {"IN1": (18, 2), "IN2": (19, 3)}  # pin and compare channel
ENABLE_PIN, STOP_PIN, STOP_CHANNEL = 16, 7, 1
FUNCTION_E, FUNCTION_F = 4, 5
PRESCALES = (1, 2, 4, 8, 16, 64, 256, 1024)


class Tick:
    """Timer 3 overflowing, and what its event starts: timer 4 counting and the converter."""

    def __init__(self, bus: Bus, clocks: Clocks, overflowed: Callable[[], None]) -> None:
        self._bus, self._clocks, self._overflowed = bus, clocks, overflowed
        self.users: set[int] = set()
        self.period_cycles = 0
        self._run = 0  # since it was set; what an older run had planned is void
        bus.clockwork.counter_period = 0
        bus.mark(TC3 + COUNT, COUNTER)
        bus.on_write(TC3 + CTRLA, self._control)
        bus.on_write(EVSYS_USER, self._connect)

    def _connect(self, _size: int, value: int) -> None:
        if value >> 8 & 31:
            self.users.add(value & 31)

    def _control(self, size: int, value: int) -> None:
        self._bus.put(TC3 + CTRLA, size, value)
        self._run += 1
        self._bus.clockwork.counter_period = 0
        if value & ENABLE:
            clocks = self._bus.get(TC3 + CC0, 2) + 1
            self.period_cycles = round(clocks * self._clocks.cycles_per_clock(TC2_TC3))
            self._bus.clockwork.counter_start = self._bus.cycles
            self._bus.clockwork.counter_period = self.period_cycles
            self._plan(self._bus.cycles + self.period_cycles, self._run)

    def _plan(self, cycle: int, this: int) -> None:
        self._bus.at(cycle, lambda: self._overflow(cycle, this))

    def _overflow(self, cycle: int, this: int) -> None:
        if this != self._run:
            return
        self._plan(cycle + self.period_cycles, this)
        is_chosen = self._bus.get(EVSYS_CHANNEL, 4) >> 16 & 0x7F == TC3_OVERFLOW
        if is_chosen and self._bus.get(TC3 + EVCTRL, 2) & OVERFLOW_EVENT and USER_TC4 in self.users:
            self._count()
        self._overflowed()

    def _count(self) -> None:
        if self._bus.get(TC4 + CTRLA, 2) & ENABLE and self._bus.get(TC4 + EVCTRL, 2) == COUNT_EVENTS:
            self._clocks.cycles_per_clock(TC4_TC5)
            self._bus.put(TC4 + COUNT, 2, self._bus.get(TC4 + COUNT, 2) + 1 & 0xFFFF)


class Pwm:
    """Bridge and servo: duty, enable and pulse as the pins show them."""

    def __init__(self, bus: Bus, clocks: Clocks, port_of: Callable[[], Port]) -> None:
        self._bus, self._clocks, self._port = bus, clocks, port_of
        self.changes: list[PwmChange] = []
        self.written_cycle: int | None = None  # of the second compare value
        for timer, channels in ((TCC0, (2, 3)), (TCC1, (STOP_CHANNEL,))):
            for channel in channels:
                at = timer + CCB + 4 * channel
                bus.on_write(at, partial(self._buffer, at))

    def _buffer(self, address: int, size: int, value: int) -> None:
        self._bus.put(address, size, value)
        self._bus.put(address - CCB + CC, size, value)
        if address == TCC0 + CCB + 4 * 3:
            self.written_cycle = self._bus.cycles
            self.changed()

    def changed(self) -> None:
        """Log the bridge's duty if it is another than before."""
        last = self.changes[-1] if self.changes else None
        duty_q15, enable = self.duty_q15(), self.enable()
        if last is None or (last.duty_q15, last.enable) != (duty_q15, enable):
            cycle = self._bus.cycles
            period = 2 * self._bus.get(TCC0 + PER, 4) or 1
            at_bottom = -(-cycle // period) * period
            self.changes.append(PwmChange(cycle / CPU_MHZ, at_bottom / CPU_MHZ, duty_q15, enable))

    def is_running(self, timer: int) -> bool:
        """Return whether a timer counts."""
        return bool(self._bus.get(timer, 4) & ENABLE)

    def _share(self, name: str) -> float:
        pin, channel = PINS[name]
        if self._port().function(pin) != FUNCTION_F:
            return float(self._port().level(pin))
        period = self._bus.get(TCC0 + PER, 4)
        if not self.is_running(TCC0) or not period:
            return 0.0
        return min(self._bus.get(TCC0 + CC + 4 * channel, 4) / period, 1.0)

    def inputs(self) -> tuple[float, float]:
        """Return the parts of the time that IN1 and IN2 are high."""
        return self._share("IN1"), self._share("IN2")

    def enable(self) -> bool:
        """Return whether the bridge is awake."""
        return self._port().level(ENABLE_PIN)

    def duty_q15(self) -> int:
        """Return the mean voltage across the coil in parts of the supply, Q15."""
        if not self.enable():
            return 0
        first, second = self.inputs()
        return max(-32768, min(32767, round((first - second) * 32768)))

    def frequency_Hz(self) -> float:
        """Return the bridge's switching frequency: dual slope, up and down."""
        clock_Hz = CPU_MHZ * 1e6 / self._clocks.cycles_per_clock(TCC0_TCC1)
        return clock_Hz / (2 * self._bus.get(TCC0 + PER, 4))

    def stop_us(self) -> float:
        """Return the servo's pulse, 0 without one."""
        return self._stop_clock_us() * self._bus.get(TCC1 + CC + 4 * STOP_CHANNEL, 4)

    def stop_period_us(self) -> float:
        """Return the servo's frame."""
        return self._stop_clock_us() * (self._bus.get(TCC1 + PER, 4) + 1)

    def _stop_clock_us(self) -> float:
        if not self.is_running(TCC1) or self._port().function(STOP_PIN) != FUNCTION_E:
            return 0.0
        prescale = PRESCALES[self._bus.get(TCC1, 4) >> 8 & 7]
        return prescale * self._clocks.cycles_per_clock(TCC0_TCC1) / CPU_MHZ

"""The ItsyBitsy M4 that closes the force loop, emulated: the parts of the ATSAMD51 that its program uses.

Cycles are those of the Cortex-M4's manual without wait states of the flash, and an assumed 2 for each access
to a peripheral: an estimate of how long the program takes.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from functools import partial
from typing import Any

from fdvv.errors import DeviceError
from fdvv_m0.bus import POLLED, WRITE_ONE_CLEARS, Bus, Chip
from fdvv_m0.emulator import M0Emulator
from fdvv_m0.records import KeyChange, PwmChange, TickInputs
from fdvv_m0.system import RESETS
from fdvv_m0.timers import USER_ADC_START
from fdvv_m0.usb_host import UsbHost
from fdvv_m0.wire import Wire

FLASH_START = 0x4000
SAMD51 = Chip(
    model="UC_CPU_ARM_CORTEX_M4",
    cpu_mhz=120,
    windows={
        **{0x40000000: 0x4000, 0x41000000: 0xF000, 0x41010000: 0x9000, 0x42000000: 0x4000},
        **{0x43000000: 0x3000, 0xE0000000: 0xF000},
    },
    gated=0,
    flash_bytes=0x80000,
    ram_bytes=0x30000,
    # bias of the converters, USB pads; and the serial number
    factory={0x800080: 0x00920248, 0x800084: 0x7FFF, 0x8061FC: 0x51000001},
)
TIMER_CYCLES, DAC_MHZ = 2.5, 12
RCAUSE, CPACR, FPU_ON = 0x40000C00, 0xE000ED88, 0xF << 20
DFLLCTRLA, DFLL_STATUS, DFLL_READY = 0x4000101C, 0x40001010, 1 << 8
DPLLCTRLA, DPLLRATIO, DPLLSTATUS, DPLL_READY = 0x40001030, 0x40001034, 0x40001040, 3
GENCTRL, PCHCTRL, GENERATOR_ON, CHANNEL_ON = 0x40001C20, 0x40001C80, 1 << 8, 1 << 6
SLOW, DFLL, DPLL = 4, 6, 7
SUPC_STATUS, BOD_READY = 0x4000180C, 5
WDT_CTRLA, WDT_CLEAR, WDT_KEY, WDT_US = 0x40002000, 0x4000200C, 0xA5, 7812
DIR, DIRCLR, DIRSET, OUT, OUTCLR, OUTSET, IN = (0x41008000 + at for at in (0, 4, 8, 0x10, 0x14, 0x18, 0x20))
PIN_KEY, PIN_STOP, PIN_ENABLE, PULLED = 18, 19, 21, 1 << 12 | 1 << 13 | 1 << 20
TC0, TC1, TC_CTRLA, TC_CTRLBSET, TC_EVCTRL, TC_COUNT, TC_CC0 = 0x40003800, 0x40003C00, 0, 5, 6, 0x14, 0x1C
READSYNC, TC_ENABLE, OVERFLOW_EVENT, COUNT_EVENTS = 4 << 5, 2, 1 << 8, 2 | 1 << 5
EVSYS_CHANNEL, EVSYS_TC1, EVSYS_ADC0 = 0x4100E020, 0x4100E120 + 4 * 45, 0x4100E120 + 4 * 55
TC0_OVERFLOW = 73 | 2 << 8
TCC1, TCC_PER, TCC_CCBUF, STOP_CHANNEL = 0x41018000, 0x40, 0x70, 3
ADC0, ADC1, ADC_INPUTCTRL, ADC_CTRLB, ADC_SWTRIG = 0x43001C00, 0x43002000, 4, 6, 0x14
ADC_EVCTRL, ADC_INTFLAG, ADC_RESULT = 2, 0x2E, 0x40
FREERUN, ADC_ENABLE, START_BY_EVENT, FLUSH, START, READY = 2, 2, 2, 1, 2, 1
CONVERSION_CLOCKS, POSITION, FORCE, SUPPLY = 13, 4 | 0x18 << 8, 0x18 << 8, 1 | 0x18 << 8
THERMISTOR, SETPOINT = 6 | 0x18 << 8, 0x18 << 8
DMA_CTRL, DMA_BASE, DMA_CHANNEL, DMA_FLAG = 0x4100A000, 0x4100A034, 0x4100A040, 0x4100A04E
DMA_ENABLE, DMA_BY_ADC0, COMPLETE, DESCRIPTOR = 2, 68 << 8 | 2 << 20, 2, 1 | 1 << 8 | 1 << 11
DAC_CTRLA, DAC_CTRLB, DAC_STATUS, DAC_DATA, ZERO = 0x43002400, 0x43002401, 0x43002407, 0x43002410, 2048
VREFPU, VDDANA, VREFA_PMUX, VREFA_PINCFG = 0, 1, 0x41008031, 0x41008043


class Moved:
    """A bus on which a peripheral of the SAMD21 lies elsewhere."""

    def __init__(self, bus: Bus, by: int) -> None:
        self._bus, self._by = bus, by

    def __getattr__(self, name: str) -> Any:
        found = getattr(self._bus, name)
        if name not in ("get", "put", "mark", "on_write", "on_read"):
            return found
        return lambda address, *rest: found(address + self._by, *rest)


class Oscillators:
    """DFLL, DPLL and the generators; a peripheral that none of them feeds is a failure."""

    def __init__(self, bus: Bus) -> None:
        self._bus = bus
        self.fpu_cycle: int | None = None
        bus.put(SUPC_STATUS, 4, BOD_READY)
        for register, status, ready in (
            (DFLLCTRLA, DFLL_STATUS, DFLL_READY),
            (DPLLCTRLA, DPLLSTATUS, DPLL_READY),
        ):
            bus.on_write(register, partial(self._enable, register, status, ready))
        bus.on_write(CPACR, self._coprocessors)

    def _coprocessors(self, size: int, value: int) -> None:
        self._bus.put(CPACR, size, value)
        if value & FPU_ON == FPU_ON and self.fpu_cycle is None:
            self.fpu_cycle = self._bus.cycles

    def _enable(self, register: int, status: int, ready: int, size: int, value: int) -> None:
        if register == DFLLCTRLA and not value & 2 and self.source(0) != SLOW:
            raise DeviceError("the DFLL is stopped while the processor runs from it")
        self._bus.put(register, size, value)
        self._bus.put(status, 4, ready if value & 2 else 0)

    def source(self, generator: int) -> int:
        """Return what feeds a generator."""
        return self._bus.get(GENCTRL + 4 * generator, 4) & 15

    def hz(self, generator: int) -> float:
        """Return a generator's frequency; DeviceError if it is off, or what feeds it."""
        control = self._bus.get(GENCTRL + 4 * generator, 4)
        found = {SLOW: 32_768.0, DFLL: 48e6}.get(control & 15, 0.0)
        if control & 15 == DPLL and self._bus.get(DPLLSTATUS, 4) == DPLL_READY:
            found = self.peripheral_hz(1) * (1 + (self._bus.get(DPLLRATIO, 4) & 0x1FFF))
        if not found or not control & GENERATOR_ON:
            raise DeviceError(f"clock generator {generator} is used but not fed")
        return found / max(control >> 16, 1)

    def peripheral_hz(self, peripheral: int) -> float:
        """Return the clock of a peripheral; DeviceError if it has none."""
        channel = self._bus.get(PCHCTRL + 4 * peripheral, 4)
        if not channel & CHANNEL_ON:
            raise DeviceError(f"peripheral clock {peripheral} is used but not fed")
        return self.hz(channel & 15)

    def cycles_per_clock(self, _peripheral: int) -> float:
        """Return the processor's cycles per clock of the I2C master (SERCOM2)."""
        return SAMD51.cpu_mhz * 1e6 / self.peripheral_hz(23)


class PortA:
    """Port A: the key, the enable of the current stage, and what rests high."""

    def __init__(self, bus: Bus, changed: Callable[[], None]) -> None:
        self._bus, self._changed = bus, changed
        self.key_log: list[KeyChange] = []
        self.pulled = PULLED
        bus.on_write(DIRCLR, lambda size, value: self._set(DIR, 0, value))
        bus.on_write(DIRSET, lambda size, value: self._set(DIR, value, 0))
        bus.on_write(OUTCLR, lambda size, value: self._set(OUT, 0, value))
        bus.on_write(OUTSET, lambda size, value: self._set(OUT, value, 0))
        bus.on_read(IN, lambda size: self._levels())

    def _set(self, register: int, ones: int, zeros: int) -> None:
        was_down = self.level(PIN_KEY)
        self._bus.put(register, 4, self._bus.get(register, 4) & ~zeros | ones)
        if (is_down := self.level(PIN_KEY)) != was_down:
            self.key_log.append(KeyChange(self._bus.cycles / self._bus.cpu_mhz, is_down))
        self._changed()

    def _levels(self) -> int:
        driven = self._bus.get(DIR, 4)
        return self._bus.get(OUT, 4) & driven | self.pulled & ~driven

    def level(self, pin: int) -> bool:
        """Return whether the port drives the pin high."""
        return bool(self._bus.get(OUT, 4) & self._bus.get(DIR, 4) & 1 << pin)


class Setpoint:
    """The DAC, the current stage's enable, and the servo."""

    def __init__(self, bus: Bus, clocks: Oscillators, port_of: Callable[[], PortA]) -> None:
        self._bus, self._clocks, self._port = bus, clocks, port_of
        self.changes: list[PwmChange] = []
        self.written_cycle: int | None = None
        bus.on_write(DAC_CTRLA, self._enable)
        bus.on_write(DAC_DATA, self._written)

    def _enable(self, size: int, value: int) -> None:
        if self._clocks.peripheral_hz(42) > DAC_MHZ * 1e6:
            raise DeviceError("the DAC's clock exceeds 12 MHz")
        is_connected = self._bus.get(VREFA_PMUX, 1) >> 4 == 1 and self._bus.get(VREFA_PINCFG, 1) & 1
        if self._reference() not in (VREFPU, VDDANA) or (self._reference() == VREFPU and not is_connected):
            raise DeviceError(f"reference {self._reference()} of the DAC is not connected, or not modelled")
        self._bus.put(DAC_CTRLA, size, value)
        self._bus.put(DAC_STATUS, 1, value >> 1 & 1)

    def _written(self, size: int, value: int) -> None:
        self._bus.put(DAC_DATA, size, value)
        self.written_cycle = self._bus.cycles
        self.changed()

    def _reference(self) -> int:
        return self._bus.get(DAC_CTRLB, 1) >> 1 & 3

    def pin_counts(self) -> int:
        """Return the output in 4096ths of the supply.

        With the analogue supply as reference code 0 gives half of it, and the code counts as signed, as in
        differential mode: what a user of TinyGo measured (its pull request 1198). MicroPython quotes the
        maker's erratum 2.9.2: that reference is not available.
        """
        code = self._bus.get(DAC_DATA, 2) & 0xFFF
        return code ^ ZERO if self._reference() == VDDANA else code

    def changed(self) -> None:
        """Log the setpoint if it is another than before."""
        enable = self._port().level(PIN_ENABLE)
        duty = 16 * (self.pin_counts() - ZERO) if enable else 0
        last = self.changes[-1] if self.changes else None
        if last is None or (last.duty_q15, last.enable) != (duty, enable):
            now_us = self._bus.cycles / self._bus.cpu_mhz
            self.changes.append(PwmChange(now_us, now_us, duty, enable))

    def stop_us(self) -> float:
        """Return the servo's pulse, 0 without one: 3 steps are a microsecond."""
        if not self._bus.get(TCC1, 4) & 2:
            return 0.0
        steps_us = self._clocks.peripheral_hz(25) / 16e6
        return self._bus.get(TCC1 + TCC_CCBUF + 4 * STOP_CHANNEL, 4) / steps_us


class Timers:
    """Timer 0 overflowing, its event, and timer 1 that counts it; counts are read by command."""

    def __init__(self, bus: Bus, clocks: Oscillators, overflowed: Callable[[], None]) -> None:
        self._bus, self._clocks, self._overflowed = bus, clocks, overflowed
        self.period_cycles = 0
        self._start, self._ticks, self._run = 0, 0, 0
        bus.on_write(TC0 + TC_CTRLA, self._control)
        for timer in (TC0, TC1):
            bus.on_write(timer + TC_CTRLBSET, partial(self._command, timer))

    @property
    def users(self) -> set[int]:
        """Whom the event starts: the converter."""
        return {USER_ADC_START} if self._connected(EVSYS_ADC0) else set()

    def _connected(self, user: int) -> bool:
        chosen = self._bus.get(EVSYS_CHANNEL, 4) == TC0_OVERFLOW and self._bus.get(user, 4) == 1
        return chosen and bool(self._bus.get(TC0 + TC_EVCTRL, 2) & OVERFLOW_EVENT)

    def _control(self, size: int, value: int) -> None:
        self._bus.put(TC0 + TC_CTRLA, size, value)
        self._run += 1
        self.period_cycles = 0
        if value & TC_ENABLE:
            each = self._bus.cpu_mhz * 1e6 / self._clocks.peripheral_hz(9)
            self.period_cycles = round((self._bus.get(TC0 + TC_CC0, 2) + 1) * each)
            self._start = self._bus.cycles
            self._plan(self._start + self.period_cycles, self._run)

    def _plan(self, cycle: int, this: int) -> None:
        self._bus.at(cycle, lambda: self._overflow(cycle, this))

    def _overflow(self, cycle: int, this: int) -> None:
        if this != self._run:
            return
        self._plan(cycle + self.period_cycles, this)
        counts = self._bus.get(TC1 + TC_EVCTRL, 2) == COUNT_EVENTS and self._bus.get(TC1, 4) & TC_ENABLE
        self._ticks += bool(counts and self._connected(EVSYS_TC1))
        self._overflowed()

    def _command(self, timer: int, _size: int, value: int) -> None:
        if value != READSYNC:
            raise DeviceError(f"timer command {value:#x} is not modelled")
        count = self._ticks
        if timer == TC0:
            passed = (self._bus.cycles - self._start) % self.period_cycles if self.period_cycles else 0
            count = int(passed / TIMER_CYCLES)
        self._bus.put(timer + TC_COUNT, 2, count & 0xFFFF)


class Converters:
    """Converter 0, started by the event and stored by DMA, or by the program; converter 1, by the program."""

    def __init__(
        self,
        bus: Bus,
        clocks: Oscillators,
        inputs: Callable[[], TickInputs],
        setpoint_counts: Callable[[], int],
    ) -> None:
        self._bus, self._clocks, self._inputs, self._setpoint_counts = bus, clocks, inputs, setpoint_counts
        self._run, self._is_running = 0, False
        self.burst_ready_cycle: int | None = None
        bus.on_write(ADC0 + ADC_SWTRIG, self._trigger)
        bus.on_write(ADC1 + ADC_SWTRIG, self._convert)
        bus.on_write(DMA_CHANNEL, self._channel)
        for register in (ADC0 + ADC_INTFLAG, ADC1 + ADC_INTFLAG, DMA_FLAG):
            bus.mark(register, WRITE_ONE_CLEARS)
        bus.mark(DMA_FLAG, POLLED)

    def _conversion_cycles(self, base: int, peripheral: int) -> int:
        control = self._bus.get(base, 2)
        clock_hz = self._clocks.peripheral_hz(peripheral) / (2 << (control >> 8 & 7))
        if not control & ADC_ENABLE or clock_hz > 16e6:
            raise DeviceError(f"a converter is off, or its clock of {clock_hz:g} Hz exceeds 16 MHz")
        return round(CONVERSION_CLOCKS * self._bus.cpu_mhz * 1e6 / clock_hz)

    def reads(self) -> int:
        """Return how many readings DMA is to store; 0 before the program has set it up."""
        base = self._bus.get(DMA_BASE, 4)
        return int.from_bytes(self._bus.ram_read(base + 2, 2), "little") if base else 0

    def _trigger(self, _size: int, value: int) -> None:
        # the data sheet of SWTRIG.FLUSH: if a conversion was pending, the converter starts a new one
        is_pending = self._is_running and bool(self._bus.get(ADC0 + ADC_CTRLB, 2) & FREERUN)
        self._run += 1
        self._is_running = is_pending
        if is_pending:
            self._begin()
        if value & START:
            chosen = self._bus.get(ADC0 + ADC_INPUTCTRL, 2)
            if chosen not in (THERMISTOR, SETPOINT) or self._bus.get(ADC0 + ADC_CTRLB, 2) & FREERUN:
                raise DeviceError(
                    "the program starts converter 0 for another input than thermistor or setpoint"
                )
            self._bus.after(self._conversion_cycles(ADC0, 40), lambda: self._finish_other(chosen))

    def _finish_other(self, chosen: int) -> None:
        counts = self._setpoint_counts() if chosen == SETPOINT else self._inputs().thermistor_counts
        self._bus.put(ADC0 + ADC_RESULT, 2, counts)
        self._bus.put(ADC0 + ADC_INTFLAG, 1, READY)

    def _convert(self, _size: int, value: int) -> None:
        if value & START:
            chosen = self._bus.get(ADC1 + ADC_INPUTCTRL, 2)
            self._bus.after(self._conversion_cycles(ADC1, 41), lambda: self._finish_one(chosen))

    def _finish_one(self, chosen: int) -> None:
        inputs = self._inputs()
        counts = {FORCE: inputs.force_counts, SUPPLY: inputs.supply_counts}[chosen]
        self._bus.put(ADC1 + ADC_RESULT, 2, counts)
        self._bus.put(ADC1 + ADC_INTFLAG, 1, READY)

    def event(self) -> None:
        """Begin the burst that the tick's event starts; ignored while one runs."""
        wanted = self._bus.get(ADC0 + ADC_EVCTRL, 1) & START_BY_EVENT
        free = self._bus.get(ADC0 + ADC_CTRLB, 2) & FREERUN
        if wanted and free and not self._is_running:
            self._is_running = True
            self._run += 1
            self._begin()

    def _channel(self, size: int, value: int) -> None:
        self._bus.put(DMA_CHANNEL, size, value)
        if value & DMA_ENABLE and self._is_running:
            self._begin()

    def _begin(self) -> None:
        if self._bus.get(ADC0 + ADC_INPUTCTRL, 2) != POSITION:
            raise DeviceError("converter 0 reads another input than the position")
        armed = self._bus.get(DMA_CHANNEL, 4) == DMA_BY_ADC0 | DMA_ENABLE
        if armed and self._bus.get(DMA_CTRL, 2) & DMA_ENABLE:
            row = self._bus.ram_read(self._bus.get(DMA_BASE, 4), 16)
            control, count, source, end, _next = struct.unpack("<HHIII", row)
            if (control, source) != (DESCRIPTOR, ADC0 + ADC_RESULT):
                raise DeviceError(f"DMA descriptor {control:#06x} from {source:#x} is not modelled")
            this = self._run
            cycles = count * self._conversion_cycles(ADC0, 40)
            self._bus.after(cycles, lambda: self._finish(this, count, end))

    def _finish(self, this: int, count: int, end: int) -> None:
        if this != self._run or not self._bus.get(DMA_CHANNEL, 4) & DMA_ENABLE:
            return
        inputs = self._inputs()
        readings = [inputs.reading(i) for i in range(count)]
        self._bus.ram_write(end - 2 * count, struct.pack(f"<{count}H", *readings))
        self._bus.put(DMA_CHANNEL, 4, self._bus.get(DMA_CHANNEL, 4) & ~DMA_ENABLE)
        self._bus.put(DMA_FLAG, 1, COMPLETE)
        self.burst_ready_cycle = self._bus.cycles


class SlowWatchdog:
    """Calls `expired` when it is not cleared within 7.8 ms."""

    def __init__(self, bus: Bus, expired: Callable[[], None]) -> None:
        self._bus, self._expired = bus, expired
        self._round = 0
        bus.on_write(WDT_CTRLA, self._control)
        bus.on_write(WDT_CLEAR, self._clear)

    def _control(self, size: int, value: int) -> None:
        self._bus.put(WDT_CTRLA, size, value)
        if value & 2:
            self._restart()

    def _clear(self, _size: int, value: int) -> None:
        if value != WDT_KEY:
            self._expired()  # any other key resets at once
        elif self._bus.get(WDT_CTRLA, 1) & 2:
            self._restart()

    def _restart(self) -> None:
        self._round += 1
        this = self._round
        self._bus.after(WDT_US * self._bus.cpu_mhz, lambda: self._expire(this))

    def _expire(self, this: int) -> None:
        if this == self._round:
            self._expired()


class M4Emulator(M0Emulator):
    """Runs the firmware of the ItsyBitsy M4, as `M0Emulator` does that of the M0.

    pwm_log has the setpoint of the current stage, in Q15. Raises DeviceError also where a clock is missing or
    too fast.
    """

    chip = SAMD51
    pin_key = PIN_KEY
    supply_mV_counts = 3300 * 242 / 22 / 4096
    oscillators: Oscillators

    def _make_chip(self, cause: str) -> None:
        bus: Any = self._bus
        bus.put(RCAUSE, 1, RESETS[cause])
        bus.put(GENCTRL, 4, DFLL | GENERATOR_ON)
        parts: Any = self
        self.oscillators = parts.clocks = Oscillators(bus)
        parts.port = PortA(bus, lambda: self.pwm.changed())
        parts.port.key_log = self.key_log
        parts.pwm = Setpoint(bus, parts.clocks, lambda: parts.port)
        parts.pwm.changes = self.pwm_log
        parts.wire = Wire(Moved(bus, 0x41012000 - 0x42001400), parts.clocks)  # type: ignore[arg-type]
        parts.wire.messages = self.wire_log
        parts.converter = Converters(bus, parts.clocks, lambda: self._inputs, parts.pwm.pin_counts)
        parts._timer = Timers(bus, parts.clocks, self._ticked)
        parts._watchdog = SlowWatchdog(bus, lambda: self._request_reset("watchdog"))

    def _make_host(self) -> UsbHost:
        return UsbHost(Moved(self._bus, 0x41000000 - 0x41005000))  # type: ignore[arg-type]

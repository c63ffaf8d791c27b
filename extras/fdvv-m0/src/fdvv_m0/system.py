"""Clocks, reset causes, watchdog and port A of the emulated chip."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from fdvv.errors import DeviceError
from fdvv_m0.bus import WRITE_ONE_CLEARS, Bus
from fdvv_m0.records import CPU_MHZ, KeyChange

RCAUSE, APBCMASK = 0x40000438, 0x40000420
RESETS = {"power on": 1, "watchdog": 1 << 5, "brown-out": 1 << 2, "software": 1 << 6}
PCLKSR, DFLLCTRL, DFLLVAL, DFLLMUL = 0x4000080C, 0x40000824, 0x40000828, 0x4000082C
ALL_READY = 1 << 4 | 1 << 9 | 1 << 11
DFLL_ENABLE = 1 << 1
CLKCTRL, GENCTRL, GENDIV = 0x40000C02, 0x40000C04, 0x40000C08
FREQUENCY_HZ = {3: 32_768, 6: 8_000_000, 7: CPU_MHZ * 1_000_000}  # by number of the source
WDT_CTRL, WDT_CONFIG, WDT_STATUS, WDT_CLEAR = 0x40001000, 0x40001001, 0x40001007, 0x40001008
WDT_KEY, WDT_SYNC_CLOCKS, SYNCBUSY = 0xA5, 5, 1 << 7
PORT = 0x41004400
DIR, DIRCLR, DIRSET, OUT, OUTCLR, OUTSET, IN = (PORT + at for at in (0, 4, 8, 0x10, 0x14, 0x18, 0x20))
PMUX, PINCFG = PORT + 0x30, PORT + 0x40
PIN_KEY = 14
AIRCR, AIRCR_RESET = 0xE000ED0C, 0x05FA0004


class Clocks:
    """Generic clock generators and who is fed by which."""

    def __init__(self, bus: Bus) -> None:
        self._bus = bus
        self._divisors: dict[int, int] = {}
        self._sources: dict[int, int] = {}
        self._feeds: dict[int, int] = {}
        bus.put(PCLKSR, 4, ALL_READY)
        bus.on_write(CLKCTRL, self._feed)
        bus.on_write(GENCTRL, lambda size, value: self._sources.update({value & 15: value >> 8 & 31}))
        bus.on_write(GENDIV, lambda size, value: self._divisors.update({value & 15: value >> 8 & 0xFF}))
        bus.on_write(APBCMASK, self._unlock)
        bus.on_write(DFLLVAL, lambda size, value: self._needs_dfll(DFLLVAL, size, value))
        bus.on_write(DFLLMUL, lambda size, value: self._needs_dfll(DFLLMUL, size, value))
        self._unlock(4, bus.get(APBCMASK, 4))

    def _feed(self, _size: int, value: int) -> None:
        if value & 1 << 14:
            self._feeds[value & 0x3F] = value >> 8 & 15

    def _unlock(self, size: int, value: int) -> None:
        self._bus.put(APBCMASK, size, value)
        self._bus.clockwork.clocks = value

    def _needs_dfll(self, address: int, size: int, value: int) -> None:
        if not self._bus.get(DFLLCTRL, 2) & DFLL_ENABLE:
            raise DeviceError(f"register {address:#x} written before the DFLL is enabled (erratum 9905)")
        self._bus.put(address, size, value)

    def cycles_per_clock(self, peripheral: int) -> float:
        """Return processor cycles per clock of a peripheral; DeviceError if it is not fed."""
        generator = self._feeds.get(peripheral)
        if generator is None or generator not in self._sources:
            raise DeviceError(f"peripheral clock {peripheral:#x} is used but not fed")
        divisor = max(self._divisors.get(generator, 1), 1)
        return CPU_MHZ * 1_000_000 * divisor / FREQUENCY_HZ[self._sources[generator]]


class Watchdog:
    """Calls `expired` when it is not cleared in time."""

    PERIPHERAL = 3

    def __init__(self, bus: Bus, clocks: Clocks, expired: Callable[[], None]) -> None:
        self._bus, self._clocks, self._expired = bus, clocks, expired
        self._round = 0  # of clearing; an older round's expiry is void
        bus.on_write(WDT_CTRL, self._control)
        bus.on_write(WDT_CLEAR, self._clear)

    def _clocks_to_cycles(self, clocks: int) -> int:
        return round(clocks * self._clocks.cycles_per_clock(self.PERIPHERAL))

    def _control(self, size: int, value: int) -> None:
        self._bus.put(WDT_CTRL, size, value)
        if value & 2:
            self._restart()

    def _restart(self) -> None:
        self._round += 1
        this = self._round
        period = 8 << (self._bus.get(WDT_CONFIG, 1) & 15)
        self._bus.after(self._clocks_to_cycles(period), lambda: self._expire(this))

    def _expire(self, this: int) -> None:
        if this == self._round:
            self._expired()

    def _clear(self, _size: int, value: int) -> None:
        if value != WDT_KEY:
            self._expired()  # any other key resets at once
        elif not self._bus.get(WDT_CTRL, 1) & 2:
            return
        else:
            self._restart()
            self._bus.put(WDT_STATUS, 1, SYNCBUSY)
            self._bus.after(self._clocks_to_cycles(WDT_SYNC_CLOCKS), lambda: self._bus.put(WDT_STATUS, 1, 0))


class Port:
    """Port A: what the pins do, as far as the program decides it."""

    def __init__(self, bus: Bus, changed: Callable[[], None]) -> None:
        self._bus, self._changed = bus, changed
        self.key_log: list[KeyChange] = []
        self.pulled = 1 << 21 | 1 << 22 | 1 << 23  # nFAULT, SDA and SCL rest high
        bus.on_write(DIRCLR, lambda size, value: self._set(DIR, 0, value))
        bus.on_write(DIRSET, lambda size, value: self._set(DIR, value, 0))
        bus.on_write(OUTCLR, lambda size, value: self._set(OUT, 0, value))
        bus.on_write(OUTSET, lambda size, value: self._set(OUT, value, 0))
        bus.on_read(IN, lambda size: self.levels())
        for pin in range(32):
            bus.on_write(PINCFG + pin, partial(self._configure, PINCFG + pin))

    def _set(self, register: int, ones: int, zeros: int) -> None:
        was_down = self.level(PIN_KEY)
        self._bus.put(register, 4, self._bus.get(register, 4) & ~zeros | ones)
        if (is_down := self.level(PIN_KEY)) != was_down:
            self.key_log.append(KeyChange(self._bus.cycles / CPU_MHZ, is_down))
        self._changed()

    def _configure(self, register: int, _size: int, value: int) -> None:
        self._bus.put(register, 1, value)
        self._changed()

    def levels(self) -> int:
        """Return the pins' levels, those that a peripheral drives taken as low."""
        driven = self._bus.get(DIR, 4)
        return self._bus.get(OUT, 4) & driven | self.pulled & ~driven

    def function(self, pin: int) -> int | None:
        """Return the peripheral function that has the pin, None if the port has it."""
        if not self._bus.get(PINCFG + pin, 1) & 1:
            return None
        return self._bus.get(PMUX + pin // 2, 1) >> 4 * (pin & 1) & 15

    def level(self, pin: int) -> bool:
        """Return whether the port drives the pin high."""
        return bool(self._bus.get(OUT, 4) & self._bus.get(DIR, 4) & 1 << pin)


def mark_plain(bus: Bus) -> None:
    """Mark the flags that writing a one clears and that nothing else depends on."""
    for address in (0x4100484E, 0x42004018, 0x42001418):
        bus.mark(address, WRITE_ONE_CLEARS)

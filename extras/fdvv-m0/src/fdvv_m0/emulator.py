"""The board as a whole: processor, chip, cable, and the world at its pins."""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path

from fdvv.errors import DeviceError, InputError
from fdvv_m0.bus import NEVER, SAMD21, Bus, Chip
from fdvv_m0.converter import Converter
from fdvv_m0.elf import read_elf
from fdvv_m0.processor import Processor
from fdvv_m0.records import KeyChange, PwmChange, TickCost, TickInputs, TickOutputs, WireMessage
from fdvv_m0.system import AIRCR, AIRCR_RESET, PIN_KEY, RCAUSE, RESETS, Clocks, Port, Watchdog, mark_plain
from fdvv_m0.timers import USER_ADC_START, Pwm, Tick
from fdvv_m0.usb_host import UsbHost
from fdvv_m0.wire import Wire

BOOT_LIMIT_us = 200_000  # without a tick: the program does not get there
BUS_WAIT_CYCLES = 2  # assumed for each register access over the peripheral bridges


class M0Emulator:
    """Runs the firmware of the ItsyBitsy M0, instruction by instruction, on modelled time.

    elf is what `make firmware` builds. tick_inputs is called at the instant of each tick with what the pins
    do, and gives what the converter finds from then on. is_cached False takes every flash access as slow.
    The bootloader is left out: the program starts at once, with the heat of a cold coil kept from before,
    as after a reset; `forget` is what a power cut does to that. Raises DeviceError if the emulator is not
    installed or the program does what the chip would not bear, InputError for an unusable elf.

    duty, pulse, messages and key line as logs: pwm_log, wire_log, key_log, costs; all times in us since power
    on, emulated.
    """

    chip: Chip = SAMD21
    pin_key = PIN_KEY
    supply_mV_counts = 3300 * 122 / 22 / 4096

    def __init__(
        self, elf: Path, tick_inputs: Callable[[TickOutputs], TickInputs], *, is_cached: bool = True
    ) -> None:
        self._program = read_elf(elf)
        self._vectors = min((load for load, _data in self._program.parts), default=0)
        if not self._program.parts or self._vectors >= self.chip.flash_bytes:
            reason = "nothing to load into flash"
            raise InputError(elf, "program headers", reason, "build it with make firmware")
        self._tick_inputs = tick_inputs
        self._inputs = TickInputs(0)
        self._bus = Bus(is_cached, BUS_WAIT_CYCLES, self.chip)
        for load, data in self._program.parts:
            self._bus.flash[load : load + len(data)] = data
        self.processor = Processor(self._bus)
        self._bus.stop = self.processor.stop
        self._host: UsbHost | None = None
        self.tick = 0
        self.reset_cause = "power on"
        self.resets = 0
        self.pwm_log: list[PwmChange] = []
        self.wire_log: list[WireMessage] = []
        self.key_log: list[KeyChange] = []
        self.costs: list[TickCost] = []
        self._keep(0, 2**32 - 1)
        self._start("power on")

    def forget(self) -> None:
        """Lose the heat that is kept over resets, as a power cut does."""
        self._keep(0, 0)

    def _keep(self, *words: int) -> None:
        at = self._program.symbols.get("kept_heat")
        if at is not None:
            self._bus.ram_write(at, struct.pack("<2I", *words))

    # -- the parts -------------------------------------------------------------------------------------------

    def _start(self, cause: str) -> None:
        bus = self._bus
        bus.forget_events()
        for memory in bus.memories.values():
            memory[:] = bytes(len(memory))
        clockwork = bus.clockwork
        clockwork.counter_period = clockwork.waited = clockwork.is_conditional = clockwork.is_stopped = 0
        clockwork.polled_at, clockwork.longest_pass, clockwork.shortest_pass = bus.cycles, 0, NEVER
        self._make_chip(cause)
        if self.key_log and self.key_log[-1].is_down:  # the pin floats, and its resistor pulls it down
            self.key_log.append(KeyChange(self.time_us, False))
        bus.on_write(AIRCR, self._software_reset)
        host = self._make_host()
        if self._host is not None:  # the same computer as before
            host.is_plugged, host.incoming = self._host.is_plugged, self._host.incoming
        self.usb = self._host = host
        self.reset_cause = cause
        self._reset_wanted: str | None = None
        self._is_watching = False
        self._messages_reported = len(self.wire_log)
        self._tick_cycle: int | None = None
        self.pwm.changed()
        stack, entry = struct.unpack_from("<II", bus.flash, self._vectors)
        self.processor.set_stack(stack)
        self._pc = entry & ~1

    def _make_chip(self, cause: str) -> None:
        bus = self._bus
        bus.put(RCAUSE, 1, RESETS[cause])
        bus.put(0x40000420, 4, 1 << 16)
        mark_plain(bus)
        self.clocks = Clocks(bus)
        self.port = Port(bus, lambda: self.pwm.changed())
        self.port.key_log = self.key_log
        self.pwm = Pwm(bus, self.clocks, lambda: self.port)
        self.pwm.changes = self.pwm_log
        self.wire = Wire(bus, self.clocks)
        self.wire.messages = self.wire_log
        self.converter = Converter(bus, self.clocks, lambda: self._inputs)
        self._timer = Tick(bus, self.clocks, self._ticked)
        self._watchdog = Watchdog(bus, self.clocks, lambda: self._request_reset("watchdog"))

    def _make_host(self) -> UsbHost:
        return UsbHost(self._bus)

    # -- running ---------------------------------------------------------------------------------------------

    def run_ticks(self, count: int) -> None:
        """Run until so many more ticks have come; DeviceError if the program fails or none comes."""
        self._target = self.tick + count
        self._limit = self._bus.cycles + BOOT_LIMIT_us * self._bus.cpu_mhz
        while self.tick < self._target:
            if not self._is_watching:
                self._watch()
            self._run()

    def run_us(self, duration_us: float) -> None:
        """Run for a time, ticks or not."""
        end = self._bus.cycles + round(duration_us * self._bus.cpu_mhz)
        self._target = self._limit = NEVER
        while self._bus.cycles < end:
            self._bus.at(end, self.processor.stop)
            self._run()

    def _run(self) -> None:
        trouble = self.processor.run(self._pc)
        self._pc = self.processor.at()
        if trouble is not None:
            raise DeviceError(f"the emulated program fails at {self.name_of(self._pc)}: {trouble}")
        if self._bus.failure is not None:
            failure, self._bus.failure = self._bus.failure, None
            raise failure
        if self._bus.clockwork.unclocked:
            raise DeviceError(f"register {self._bus.clockwork.unclocked:#x} used without its bus clock")
        if self._reset_wanted is not None:
            self.resets += 1
            self._start(self._reset_wanted)

    def _watch(self) -> None:
        self._is_watching = self._limit != NEVER
        if self._bus.cycles >= self._limit:
            where = self.name_of(self.processor.at())
            raise DeviceError(f"the emulated program has come to no tick; it is at {where}")
        if self._is_watching:
            self._bus.at(self._limit, self._watch)

    def _ticked(self) -> None:
        self._close_tick()
        self._tick_cycle = self._bus.cycles
        self.converter.burst_ready_cycle = self.pwm.written_cycle = None
        self.tick += 1
        self._limit = self._bus.cycles + BOOT_LIMIT_us * self._bus.cpu_mhz
        self._inputs = self._tick_inputs(self.outputs())
        self._messages_reported = len(self.wire_log)
        if USER_ADC_START in self._timer.users:
            self.converter.event()
        if self.usb.outgoing:
            self.usb.pump()
        if self.tick >= self._target:
            self.processor.stop()

    def _close_tick(self) -> None:
        clockwork, start = self._bus.clockwork, self._tick_cycle
        if start is not None:
            idle = clockwork.passes * (clockwork.shortest_pass if clockwork.shortest_pass != NEVER else 0)
            ready, written = self.converter.burst_ready_cycle, self.pwm.written_cycle
            cost = TickCost(
                self.tick,
                None if ready is None else (ready - start) / self._bus.cpu_mhz,
                None if written is None else (written - start) / self._bus.cpu_mhz,
                clockwork.longest_pass / self._bus.cpu_mhz,
                max(self._bus.cycles - start - idle, 0),
            )
            self.costs.append(cost)
        clockwork.longest_pass = clockwork.passes = 0

    # -- the world -------------------------------------------------------------------------------------------

    @property
    def time_us(self) -> float:
        """Emulated time since power on."""
        return self._bus.cycles / self._bus.cpu_mhz

    @property
    def tick_us(self) -> float:
        """Period that the program has set."""
        return self._timer.period_cycles / self._bus.cpu_mhz

    @property
    def reads(self) -> int:
        """Readings per tick that the program has asked for."""
        return self.converter.reads()

    def outputs(self) -> TickOutputs:
        """Return what the pins do now."""
        drive = self.pwm_log[-1]
        return TickOutputs(
            self.tick,
            self.time_us,
            drive.duty_q15,
            drive.enable,
            self.pwm.stop_us(),
            tuple(self.wire_log[self._messages_reported :]),
            self.port.level(self.pin_key),
        )

    def write(self, data: bytes) -> None:
        """Send bytes from the computer to the board's serial port; they leave as time goes on."""
        self.usb.outgoing += data

    def read(self) -> bytes:
        """Return what has come from the board's serial port since the last call."""
        data = bytes(self.usb.incoming)
        self.usb.incoming.clear()
        return data

    def unplug(self) -> None:
        """Pull the USB cable; the board goes on, fed by the rig's supply."""
        self.usb.unplug()

    def plug(self) -> None:
        """Put the USB cable in again; the port opens when the computer has enumerated the board."""
        self.usb.plug()

    def reset(self, cause: str = "power on") -> None:
        """Reset the chip: "power on", "brown-out", "watchdog" or "software"."""
        self.resets += 1
        self._start(cause)

    def hang(self, symbol: str) -> None:
        """Let a function of the program loop for ever from its first instruction, as a fault to inject."""
        self.processor.loop_at(self._program.symbols[symbol])

    def stall(self, duration_us: float) -> None:
        """Keep the processor from working for a time, as a fault to inject; the peripherals go on."""
        self._bus.clockwork.waited += round(duration_us * self._bus.cpu_mhz)

    def name_of(self, address: int) -> str:
        """Return the function that an address lies in, for messages."""
        symbols = self._program.symbols.items()
        below = [(at, name) for name, at in symbols if at <= address and name[:1] != "$"]
        return f"{max(below)[1]} ({address:#x})" if below else f"{address:#x}"

    def _request_reset(self, cause: str) -> None:
        self._reset_wanted = cause
        self._bus.forget_events()
        self.processor.stop()

    def _software_reset(self, _size: int, value: int) -> None:
        if value == AIRCR_RESET:
            self._request_reset("software")

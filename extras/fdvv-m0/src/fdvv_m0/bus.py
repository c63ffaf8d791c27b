"""The registers of the emulated chip: plain memory in C, with a Python callback only where one is needed."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from dataclasses import dataclass
from heapq import heappop, heappush

from fdvv._native import library

NO_WAIT = 2  # of is_cached
CALL_WRITE, CALL_READ, WRITE_ONE_CLEARS, COUNTER, POLLED = 1, 2, 4, 8, 16
NEVER = 2**64 - 1
BASE_BITS = 0xFFFF0000  # of an address, which name its window
RAM_START = 0x20000000

EVENT = ctypes.CFUNCTYPE(None)
READ = ctypes.CFUNCTYPE(ctypes.c_uint64, ctypes.c_uint32, ctypes.c_uint32)
WRITE = ctypes.CFUNCTYPE(None, ctypes.c_uint32, ctypes.c_uint32, ctypes.c_uint32)


def address_of(memory: bytearray) -> int:
    """Return where a memory lies; it must not be resized and must be kept."""
    return ctypes.addressof((ctypes.c_char * len(memory)).from_buffer(memory))


@dataclass(frozen=True)
class Chip:
    """What differs between the emulated chips.

    Attributes
    ----------
    model : of the processor, as unicorn names it. cpu_mhz : its clock.
    windows : of registers, sizes by address. gated : the one whose peripherals all start without a clock; 0:
        clocks are not watched.
    flash_bytes, ram_bytes : of memory. factory : words written at production, by address.
    """

    model: str
    cpu_mhz: int
    windows: dict[int, int]
    gated: int
    flash_bytes: int
    ram_bytes: int
    factory: dict[int, int]

    @property
    def is_m4(self) -> bool:
        """Whether its flash has a cache of its own, whose misses are not counted."""
        return self.model.endswith("M4")


SAMD21 = Chip(
    model="UC_CPU_ARM_CORTEX_M0",
    cpu_mhz=48,
    windows={0x40000000: 0x2000, 0x41000000: 0x6000, 0x42000000: 0x5000, 0xE0000000: 0xF000},
    gated=0x42000000,
    flash_bytes=0x40000,
    ram_bytes=0x8000,
    # DFLL coarse and fine, USB pads; and the serial number
    factory={
        0x806020: 0xF8000000,
        0x806024: 0x7C000000 | 0x1F << 13 | 0x1F << 18,
        0x806028: 0x1FF,
        0x80A00C: 0x0FD00001,
    },
)


class Clockwork(ctypes.Structure):
    """Mirror of fdvv_m0 in m0_cycles.c."""

    _fields_ = (
        *((name, ctypes.c_uint64) for name in ("cycles", "next_event")),
        *(("event", EVENT), ("read", READ), ("write", WRITE)),
        *((name, ctypes.c_void_p) for name in ("flash", "code")),
        *((name, ctypes.c_uint64) for name in ("counter_start", "counter_period", "polled_at")),
        *((name, ctypes.c_uint64) for name in ("longest_pass", "shortest_pass", "passes", "touches")),
        *(("line_used", ctypes.c_uint64 * 8), ("line", ctypes.c_uint32 * 8)),
        *((name, ctypes.c_uint32) for name in ("flash_bytes", "bus_wait", "waited", "start", "after")),
        *((name, ctypes.c_uint32) for name in ("is_stopped", "is_conditional", "is_cached")),
        *((name, ctypes.c_uint32) for name in ("unclocked", "clocks", "is_m4")),
    )


class Window(ctypes.Structure):
    """Mirror of fdvv_m0_window: one run of registers."""

    _fields_ = (
        ("m0", ctypes.c_void_p),
        ("memory", ctypes.c_void_p),
        ("kind", ctypes.c_void_p),
        ("base", ctypes.c_uint32),
        ("gated", ctypes.c_uint32),
    )


class Bus:
    """Registers, memory, cycles and the queue of what happens when.

    Peripherals claim their registers with on_write and on_read, keep their state in the registers themselves
    where they can, and put what happens later in the queue with `after`.
    """

    def __init__(self, is_cached: bool, bus_wait_cycles: int, chip: Chip = SAMD21) -> None:
        self.chip = chip
        self.flash = bytearray(b"\xff" * chip.flash_bytes)
        self.ram = bytearray(chip.ram_bytes)
        self.clockwork = Clockwork(bus_wait=bus_wait_cycles, next_event=NEVER, shortest_pass=NEVER)
        self.clockwork.is_cached = NO_WAIT if chip.is_m4 else is_cached
        self.clockwork.is_m4 = chip.is_m4
        self._code = bytearray(library().fdvv_m0_bytes(2) * (chip.flash_bytes // 2))
        self.clockwork.flash = address_of(self.flash)
        self.clockwork.code = address_of(self._code)
        self.clockwork.flash_bytes = chip.flash_bytes
        self.memories = {base: bytearray(size) for base, size in chip.windows.items()}
        self.kinds = {base: bytearray(size) for base, size in chip.windows.items()}
        self.windows = {base: self._window(base) for base in chip.windows}
        self._writes: dict[int, Callable[[int, int], None]] = {}
        self._reads: dict[int, Callable[[int], int]] = {}
        self._queue: list[tuple[int, int, Callable[[], None]]] = []
        self._order = 0
        self.failure: BaseException | None = None
        self.stop: Callable[[], None] = lambda: None
        # kept here so that they outlive the calls
        self.clockwork.event = self._event = EVENT(self._run_events)
        self.clockwork.read = self._read = READ(self._called_read)
        self.clockwork.write = self._write = WRITE(self._called_write)

    def _window(self, base: int) -> Window:
        return Window(
            ctypes.addressof(self.clockwork),
            address_of(self.memories[base]),
            address_of(self.kinds[base]),
            base,
            base == self.chip.gated,
        )

    # -- registers -------------------------------------------------------------------------------------------

    def get(self, address: int, size: int) -> int:
        """Return what a register holds."""
        base = address & BASE_BITS
        at = address - base
        return int.from_bytes(self.memories[base][at : at + size], "little")

    def put(self, address: int, size: int, value: int) -> None:
        """Let a register hold a value, without its effects."""
        base = address & BASE_BITS
        at = address - base
        self.memories[base][at : at + size] = value.to_bytes(size, "little")

    def mark(self, address: int, kind: int) -> None:
        """Say how C treats a register, beyond memory."""
        base = address & BASE_BITS
        self.kinds[base][address - base] |= kind

    def on_write(self, address: int, call: Callable[[int, int], None]) -> None:
        """Have call(size, value) instead of the write to a register."""
        self.mark(address, CALL_WRITE)
        self._writes[address] = call

    def on_read(self, address: int, call: Callable[[int], int]) -> None:
        """Have call(size) give what a register reads."""
        self.mark(address, CALL_READ)
        self._reads[address] = call

    # -- memory ----------------------------------------------------------------------------------------------

    def ram_read(self, address: int, count: int) -> bytes:
        """Return bytes of RAM."""
        at = address - RAM_START
        return bytes(self.ram[at : at + count])

    def ram_write(self, address: int, data: bytes) -> None:
        """Put bytes into RAM, as DMA and USB do."""
        at = address - RAM_START
        if not 0 <= at <= len(self.ram) - len(data):
            raise ValueError(f"a peripheral writes {len(data)} bytes to {address:#x}, which is not RAM")
        self.ram[at : at + len(data)] = data

    # -- time ------------------------------------------------------------------------------------------------

    @property
    def cpu_mhz(self) -> int:
        return self.chip.cpu_mhz

    @property
    def cycles(self) -> int:
        """Cycles of the processor since the emulator was made."""
        return int(self.clockwork.cycles)

    def at(self, cycle: int, call: Callable[[], None]) -> None:
        """Have call() at a cycle."""
        self._order += 1
        heappush(self._queue, (cycle, self._order, call))
        self.clockwork.next_event = self._queue[0][0]

    def after(self, cycles: int, call: Callable[[], None]) -> None:
        """Have call() in so many cycles."""
        self.at(self.cycles + cycles, call)

    def forget_events(self) -> None:
        """Empty the queue: reset."""
        self._queue.clear()
        self.clockwork.next_event = NEVER

    # -- called from C: nothing may be raised through it -----------------------------------------------------

    def _guard(self, error: BaseException) -> None:
        self.failure = self.failure or error
        self.forget_events()
        self.stop()

    def _run_events(self) -> None:
        try:
            _cycle, _order, call = heappop(self._queue)
            self.clockwork.next_event = self._queue[0][0] if self._queue else NEVER
            call()
        except BaseException as error:
            self._guard(error)

    def _called_read(self, address: int, size: int) -> int:
        try:
            return self._reads[address](size)
        except BaseException as error:
            self._guard(error)
            return 0

    def _called_write(self, address: int, size: int, value: int) -> None:
        try:
            self._writes[address](size, value)
        except BaseException as error:
            self._guard(error)

"""The LED strip's Uno in simavr as a line for the driver, and what its strip was sent: emulated."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from tests.firmware._simavr import CLOCK_HZ, Signature, compile_emulator

CYCLES_us = CLOCK_HZ // 1_000_000
GLANCE_CYCLES = CLOCK_HZ // 1000
BOOT_CYCLES = 160_000
KEY_CYCLES = CLOCK_HZ // 10
ROOM = 1_000_000
WIRE_us = 2.0
"""A byte at 4 MHz."""
HEAD = 0xE0
CALM_CYCLES = 400
"""Silence on the strip's line after which no frame is on its way; between two bytes there are some 50."""

BOARD, U8, U32, U64 = ctypes.c_void_p, ctypes.c_uint8, ctypes.c_uint32, ctypes.c_uint64
SIGNATURES: dict[str, Signature] = {
    "strip_open": (BOARD, [ctypes.c_char_p, U32]),
    "strip_close": (None, [BOARD]),
    "strip_cycle": (U64, [BOARD]),
    "strip_zero": (U64, [BOARD]),
    "strip_run": (None, [BOARD, U64]),
    "strip_key_at": (ctypes.c_int, [BOARD, U64, U8]),
    "strip_ask": (ctypes.c_int, [BOARD, ctypes.c_char_p, U32]),
    "strip_replies": (U32, [BOARD, ctypes.c_void_p]),
    "strip_sent": (U32, [BOARD, ctypes.c_void_p, ctypes.c_void_p]),
    "strip_last": (U64, [BOARD]),
    "strip_peek": (U8, [BOARD, ctypes.c_uint16]),
    "strip_poke": (None, [BOARD, ctypes.c_uint16, U8]),
}


def build_strip_emulator(folder: Path) -> ctypes.CDLL:
    """Compile the emulator's half in C and load it."""
    return compile_emulator(Path(__file__).with_name("_simavr_strip.c"), folder, SIGNATURES)


@dataclass(frozen=True)
class StripFrame:
    """One frame as a strip takes it.

    begun_us, ended_us : its first bit and its last, on the board's clock.
    pixels : (n, 4) brightness head, blue, green, red of each pixel.
    shown_us : (n,) when each pixel had its colour.
    latched_us : when an SK9822 shows all of them.
    """

    begun_us: float
    ended_us: float
    pixels: npt.NDArray[np.uint8]
    shown_us: npt.NDArray[np.float64]
    latched_us: float

    @property
    def is_dark(self) -> bool:
        """Whether nothing is lit."""
        return not self.pixels[:, 1:].any()

    def lit(self, blue: int, green: int, red: int) -> list[int]:
        """Return the pixels of a colour."""
        return [int(i) for i in np.flatnonzero((self.pixels[:, 1:] == (blue, green, red)).all(axis=1))]


def frames_of(us: npt.NDArray[np.float64], data: npt.NDArray[np.uint8]) -> list[StripFrame]:
    """Take frames apart as an APA102 does: 32 zeros, pixels that begin with three ones, zeros."""
    found, place = [], 0
    while place < len(data):
        assert not data[place : place + 4].any(), "a frame begins with 32 zeros"
        first = last = place + 4
        while data[last] >= HEAD:
            last += 4
        pixels = data[first:last].reshape(-1, 4)
        # 32 zeros for an SK9822, and half a clock for each pixel of an APA102
        end = last + 4 + (len(pixels) + 15) // 16
        assert not data[last:end].any(), "a frame ends in zeros"
        shown_us, latched_us = us[first + 3 : last : 4], float(us[last + 3])
        found.append(StripFrame(float(us[place]) - WIRE_us, float(us[end - 1]), pixels, shown_us, latched_us))
        place = end
    return found


class UnoStrip:
    """One emulated board, booted, as a Port: its clock goes only while somebody waits."""

    name = "uno-strip (emulated)"

    def __init__(self, emulator: ctypes.CDLL, elf: Path) -> None:
        self._emulator = emulator
        self._board = emulator.strip_open(str(elf).encode(), ROOM)
        assert self._board, f"simavr cannot open {elf}"
        self._run_to(BOOT_CYCLES)

    # -- the line ------------------------------------------------------------------------------------------

    def now_s(self) -> float:
        return self.cycle / CLOCK_HZ

    def write(self, data: bytes) -> None:
        assert self._emulator.strip_ask(self._board, data, len(data)), "the line is full"

    def read(self, until_s: float) -> bytes:
        room = (U8 * 4096)()
        while True:
            count = self._emulator.strip_replies(self._board, room)
            if count or self.now_s() >= until_s:
                return bytes(room[:count])
            self._run_to(min(self.cycle + GLANCE_CYCLES, round(until_s * CLOCK_HZ) + 1))

    def reopen(self) -> None: ...

    def close(self) -> None:
        """The emulator stays for what is still to be looked at."""

    def free(self) -> None:
        self._emulator.strip_close(self._board)

    # -- time and pins -------------------------------------------------------------------------------------

    @property
    def cycle(self) -> int:
        return int(self._emulator.strip_cycle(self._board))

    def cycle_of(self, board_us: float) -> int:
        """Return the cycle of a time on the board's clock."""
        return int(self._emulator.strip_zero(self._board)) + round(board_us * CYCLES_us)

    def _run_to(self, cycle: int) -> None:
        self._emulator.strip_run(self._board, cycle)

    def run_s(self, duration_s: float) -> None:
        self._run_to(self.cycle + round(duration_s * CLOCK_HZ))

    def key_at(self, cycle: int, down_cycles: int = KEY_CYCLES) -> None:
        """Let the key line rise at a cycle that is still to come, after all others."""
        assert self._emulator.strip_key_at(self._board, cycle, 1)
        assert self._emulator.strip_key_at(self._board, cycle + down_cycles, 0)

    def press_at(self, time_s: float) -> None:
        """Let the key go down at a time of the board's clock."""
        self.key_at(self.cycle_of(1e6 * time_s))

    def peek(self, address: int) -> int:
        return int(self._emulator.strip_peek(self._board, address))

    def poke(self, address: int, value: int) -> None:
        self._emulator.strip_poke(self._board, address, value)

    def frames(self) -> list[StripFrame]:
        """Return the frames sent since the last call, the last one whole."""
        while self.cycle < self._emulator.strip_last(self._board) + CALM_CYCLES:
            self._run_to(self.cycle + CALM_CYCLES)
        cycles, data = np.empty(ROOM, np.uint64), np.empty(ROOM, np.uint8)
        count = self._emulator.strip_sent(self._board, cycles.ctypes.data, data.ctypes.data)
        assert count < ROOM, "the record is full"
        at = cycles[:count].astype(np.int64)
        us = (at - int(self._emulator.strip_zero(self._board))) / CYCLES_us
        return frames_of(us, data[:count])

"""The Uno in simavr, seen from Python; _simavr.c is its other half. All figures from here are emulated."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt
import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
HEADERS = Path("/usr/include/simavr")
CLOCK_HZ = 16_000_000
ROOM = 200_000
BOOT_CYCLES = 20_000
RAM_START, RAM_END, STACK_POINTER, STACK_PAINT = 0x100, 0x8FF, 0x5D, 0xA5
FLASH_BYTES, RAM_BYTES = 32_768 - 512, 2048

Signature = tuple[Any, list[Any]]
SIGNATURES: dict[str, Signature] = {
    "uno_open": (ctypes.c_void_p, [ctypes.c_char_p, ctypes.c_uint32]),
    "uno_close": (None, [ctypes.c_void_p]),
    "uno_cycle": (ctypes.c_uint64, [ctypes.c_void_p]),
    "uno_run": (None, [ctypes.c_void_p, ctypes.c_uint64]),
    "uno_poke": (None, [ctypes.c_void_p, ctypes.c_uint16, ctypes.c_uint8]),
    "uno_peek": (ctypes.c_uint8, [ctypes.c_void_p, ctypes.c_uint16]),
    "uno_write": (
        ctypes.c_uint64,
        [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_uint32, ctypes.c_uint64, ctypes.c_int],
    ),
    "uno_read": (ctypes.c_uint64, [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_uint32, ctypes.c_uint64]),
    "uno_disturb": (None, [ctypes.c_void_p]),
    "uno_samples": (ctypes.c_uint32, [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p]),
    "uno_interrupts": (ctypes.c_uint32, [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p]),
    "uno_malformed": (ctypes.c_uint32, [ctypes.c_void_p]),
}


def say(figure: str) -> None:
    """Show a figure to whoever runs pytest with -rP."""
    sys.stdout.write(f"emulated: {figure}\n")


def require(*tools: str, **others: bool) -> None:
    """Skip by name where a tool or something else is absent; fail where CI is set."""
    missing = [tool for tool in tools if not shutil.which(tool)]
    missing += [name for name, is_there in others.items() if not is_there]
    if missing and os.environ.get("CI"):
        pytest.fail(f"make firmware-tools has not installed {', '.join(missing)}")
    if missing:
        pytest.skip(f"make firmware-tools installs {', '.join(missing)}")


def require_tools() -> None:
    """See that an Uno can be built and emulated."""
    require("avr-gcc", "avr-size", "make", "cc", **{"libsimavr-dev": (HEADERS / "sim_avr.h").is_file()})


def build_board(folder: Path, name: str = "uno_vibration") -> Path:
    """Build a board's firmware; return the ELF file."""
    board = REPOSITORY / "firmware" / "boards" / name
    subprocess.run(["make", "-C", str(board), f"BUILD={folder}"], check=True, capture_output=True)
    return folder / f"{name}.elf"


class Board(Protocol):
    """An emulated Uno."""

    def peek(self, address: int) -> int: ...

    def poke(self, address: int, value: int) -> None: ...


def check_memory(board: Board, elf: Path, work: Callable[[], object]) -> None:
    """See that flash holds the program, and RAM its data and twice the stack that it needs to work."""
    out = subprocess.run(["avr-size", str(elf)], check=True, capture_output=True, text=True).stdout
    text, data, bss = (int(word) for word in out.splitlines()[1].split()[:3])
    # paint what nothing has used, work, and see how far the paint was worn off
    free, top = RAM_START + data + bss, board.peek(STACK_POINTER) | board.peek(STACK_POINTER + 1) << 8
    for address in range(free, top - 8):
        board.poke(address, STACK_PAINT)
    work()
    painted = [board.peek(address) == STACK_PAINT for address in range(free, RAM_END + 1)]
    stack = len(painted) - painted.index(False)
    say(f"flash {text + data} B of {FLASH_BYTES}, RAM {data + bss} B of {RAM_BYTES}, stack {stack} B")
    assert text + data <= 8192
    assert data + bss + 2 * stack <= RAM_BYTES


def build_emulator(folder: Path) -> ctypes.CDLL:
    """Compile the emulator's half in C and load it."""
    return compile_emulator(Path(__file__).with_name("_simavr.c"), folder, SIGNATURES)


def compile_emulator(source: Path, folder: Path, signatures: Mapping[str, Signature]) -> ctypes.CDLL:
    """Compile a board around simavr and load it."""
    library = folder / f"lib{source.stem}.so"
    # simavr's headers are not clean under -Wextra
    flags = ["-std=gnu99", "-O2", "-Wall", "-fPIC", "-shared", f"-I{HEADERS}"]
    subprocess.run(["cc", *flags, "-o", str(library), str(source), "-lsimavr"], check=True)
    emulator = ctypes.CDLL(str(library))
    for name, (result, arguments) in signatures.items():
        function = getattr(emulator, name)
        function.restype, function.argtypes = result, arguments
    return emulator


@dataclass(frozen=True)
class Samples:
    """What the converter gave: cycles of its latch and words it latched, command bits included."""

    cycles: npt.NDArray[np.uint64]
    words: npt.NDArray[np.uint16]

    @property
    def counts(self) -> npt.NDArray[np.uint16]:
        """Return the converter's 12 bits."""
        return self.words & np.uint16(0xFFF)

    def after(self, cycle: int) -> Samples:
        """Leave out what was before a cycle."""
        late = self.cycles >= cycle
        return Samples(self.cycles[late], self.words[late])


class Uno:
    """One emulated board, booted."""

    def __init__(self, emulator: ctypes.CDLL, elf: Path) -> None:
        self._emulator = emulator
        self._board = emulator.uno_open(str(elf).encode(), ROOM)
        assert self._board, f"simavr cannot open {elf}"
        self.run(BOOT_CYCLES)

    def close(self) -> None:
        self._emulator.uno_close(self._board)

    @property
    def cycle(self) -> int:
        return int(self._emulator.uno_cycle(self._board))

    def run(self, cycles: int) -> None:
        self._emulator.uno_run(self._board, self.cycle + cycles)

    def peek(self, address: int) -> int:
        return int(self._emulator.uno_peek(self._board, address))

    def poke(self, address: int, value: int) -> None:
        self._emulator.uno_poke(self._board, address, value)

    def write(self, data: bytes, start_cycle: int = 0, stop: bool = True) -> int:
        """Send a message; return the cycle of its START."""
        start = self._emulator.uno_write(self._board, data, len(data), start_cycle, int(stop))
        assert start, "the board holds the clock for good"
        return int(start)

    def read(self, count: int) -> bytes:
        buffer = (ctypes.c_uint8 * count)()
        assert self._emulator.uno_read(self._board, buffer, count, 0), "the board holds the clock for good"
        return bytes(buffer)

    def disturb(self) -> None:
        """Let the bus hardware see an illegal START or STOP."""
        self._emulator.uno_disturb(self._board)

    def samples(self) -> Samples:
        cycles, words = np.empty(ROOM, np.uint64), np.empty(ROOM, np.uint16)
        count = self._emulator.uno_samples(self._board, cycles.ctypes.data, words.ctypes.data)
        assert count < ROOM, "the record is full"
        assert self._emulator.uno_malformed(self._board) == 0
        return Samples(cycles[:count], words[:count])

    def interrupt_cycles(self) -> npt.NDArray[np.uint32]:
        """Return the length of every timer interrupt."""
        cycles, spent = np.empty(ROOM, np.uint64), np.empty(ROOM, np.uint32)
        count = self._emulator.uno_interrupts(self._board, cycles.ctypes.data, spent.ctypes.data)
        return spent[:count]

"""Emulated seconds per second of the ItsyBitsy M0 at 4 kHz, cycles counted: ``python -m benchmarks.m0``."""

from __future__ import annotations

import time
from pathlib import Path

from fdvv.device import EmulatedBoard

ELF = Path(__file__).resolve().parents[1] / "build" / "firmware" / "itsybitsy_m0.elf"
TICKS = 8000


def main() -> None:
    """Run two emulated seconds of the controller at rest and print what they took."""
    board = EmulatedBoard(ELF)
    wall, processor = time.perf_counter(), time.process_time()
    board.emulator.run_ticks(TICKS)
    wall, processor = time.perf_counter() - wall, time.process_time() - processor
    emulated_s = TICKS * board.emulator.tick_us * 1e-6
    print(f"emulated ItsyBitsy M0: {emulated_s / processor:.2f} x real time of one core's time", end=", ")
    print(f"{emulated_s / wall:.2f} x on the clock")


if __name__ == "__main__":
    main()

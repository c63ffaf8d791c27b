"""The whole ItsyBitsy M0, emulated, cycles counted: ``python -m benchmarks.m0``.

How fast the emulator is, and whether a tick is late during upload and presses, with every tick reported.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from fdvv.device.linked import LinkedDevice
from fdvv.device.remote import surface_image
from fdvv.model.surface import ForceSurface
from fdvv.protocol.tables import Settings
from fdvv_m0.board import EmulatedBoard
from tests.support.scripted_person import ScriptedPerson

ELF = Path(__file__).resolve().parents[1] / "build" / "firmware" / "itsybitsy_m0.elf"
TICKS = 8000
FORCES = np.full((6, 255), 30.0)
LONG = surface_image(ForceSurface(np.linspace(0.0, 5.08, 255), np.arange(1.0, 7.0), FORCES, FORCES - 5), 4.0)
VELOCITIES_mm_s = (50.0, 150.0, 300.0)
RATES = ((250, 25), (200, 16), (166, 13), (125, 13))


@dataclass(frozen=True)
class Load:
    """What the board's counters and the emulator report of a run."""

    ticks: int
    late: int
    lost_records: int
    worst_tick_us: int
    latency_us: float


def run_load(
    elf: Path, ticks: int, settings: Settings, velocities_mm_s: Sequence[float] = VELOCITIES_mm_s
) -> Load:
    """Upload a full program and press it, again and again, for at least so many ticks."""
    device = LinkedDevice(EmulatedBoard(elf), ScriptedPerson(3))
    device.configure(settings)
    board = device.port.board
    assert isinstance(board, EmulatedBoard)
    start, latencies_us, turn = board.emulator.tick, list[float](), 0
    while board.emulator.tick - start < ticks:
        device.upload_program(LONG)
        device.press(velocities_mm_s[turn % len(velocities_mm_s)])
        costs = board.emulator.costs
        latencies_us += [cost.latency_us for cost in costs if cost.latency_us is not None]
        costs.clear()
        turn += 1
    counters = device.client.counters()
    median_us = float(np.median(latencies_us))
    return Load(
        board.emulator.tick - start, counters.late, counters.lost_records, counters.worst_tick_us, median_us
    )


def rate_settings(tick_us: int, reads: int) -> Settings:
    """Return settings that look ahead at another tick, the gain made up for another number of readings."""
    usual = Settings()
    gain_q14 = round(usual.position_gain_q14 * usual.reads / reads)
    plain = Settings(tick_us=tick_us, reads=reads, position_gain_q14=gain_q14)
    return replace(
        plain, predictor_q16=9000, lead_us=2000, brake_lead_us=1500, drag_q13=500, friction_cN64=100
    )


def tell_speed() -> None:
    """Run two emulated seconds of the controller at rest and print what they took."""
    board = EmulatedBoard(ELF)
    wall, processor = time.perf_counter(), time.process_time()
    board.emulator.run_ticks(TICKS)
    wall, processor = time.perf_counter() - wall, time.process_time() - processor
    emulated_s = TICKS * board.emulator.tick_us * 1e-6
    print(f"emulated ItsyBitsy M0: {emulated_s / processor:.2f} x real time of one core's time", end=", ")
    print(f"{emulated_s / wall:.2f} x on the clock")


def main() -> None:
    """Print all figures."""
    tell_speed()
    for tick_us, reads in RATES:
        load = run_load(ELF, TICKS, rate_settings(tick_us, reads))
        print(f"emulated, {tick_us} us, {reads} readings, every tick reported: {load}")


if __name__ == "__main__":
    main()

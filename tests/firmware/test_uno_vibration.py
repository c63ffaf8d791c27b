"""The Uno's firmware in simavr: every figure here is emulated."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from fdvv.program.synth import SILENCE_counts, Slot, Waveform, render
from tests.firmware._simavr import (
    CLOCK_HZ,
    Uno,
    build_board,
    build_emulator,
    check_memory,
    require_tools,
    say,
)
from tests.support.program.vibration_wire import bank_messages, play_message, read_status

pytestmark = pytest.mark.firmware

TICK_CYCLES = 1000
COMMAND = 0x3000
PHASES = range(0, TICK_CYCLES, 8)
TIMSK1, WATCHDOG_CYCLES = 0x6F, 30 * CLOCK_HZ // 1000

SNAP = Slot(Waveform.SINE, 3824, 256, 1840, 50_461)
HUM = Slot(Waveform.SINE, 16 * 60, 1200, 2047)
BLIP = Slot(Waveform.SAMPLED, 16 * 3000, 700, 2047, 60_000, wave=tuple(range(-128, 128)))
EDGES = Slot(Waveform.SAMPLED, 65_535, 400, 1500, wave=(127, -128) * 40)
HIGH = Slot(Waveform.SINE, 65_535, 333, 2047, 65_000)
SLOTS = (SNAP, HUM, BLIP, EDGES, HIGH)


@dataclass(frozen=True)
class Build:
    elf: Path
    folder: Path


@pytest.fixture(scope="module")
def build(tmp_path_factory: pytest.TempPathFactory) -> Build:
    require_tools()
    folder = tmp_path_factory.mktemp("uno")
    return Build(build_board(folder), folder)


@pytest.fixture
def uno(build: Build) -> Iterator[Uno]:
    board = Uno(build_emulator(build.folder), build.elf)
    for message in bank_messages(SLOTS):
        board.write(message)
    yield board
    board.close()


def played_after(uno: Uno, start_cycle: int, samples: int) -> np.ndarray[tuple[int], np.dtype[np.uint16]]:
    """What came out from the first sample that is not silence."""
    counts = uno.samples().after(start_cycle).counts
    first = np.flatnonzero(counts != SILENCE_counts)[0]
    return np.asarray(counts[first : first + samples])


def latency_us(uno: Uno, start_cycle: int) -> float:
    """From the START of a PLAY to the latch of the first sample that is not silence."""
    late = uno.samples().after(start_cycle)
    first = np.flatnonzero(late.counts != SILENCE_counts)[0]
    return (int(late.cycles[first]) - start_cycle) / CLOCK_HZ * 1e6


@pytest.mark.parametrize("index", range(len(SLOTS)))
@pytest.mark.parametrize("strength", [255, 100])
def test_the_converter_gets_the_samples_of_the_model(uno: Uno, index: int, strength: int) -> None:
    samples = SLOTS[index].duration_samples + 20
    start = uno.write(play_message(index, strength))
    uno.run((samples + 10) * TICK_CYCLES)
    np.testing.assert_array_equal(played_after(uno, start, samples), render(SLOTS[index], samples, strength))
    assert set((uno.samples().words & 0xF000).tolist()) == {COMMAND}


@pytest.mark.parametrize("pause_cycles", [0, 7_777, 60_000])
def test_a_play_while_one_sounds_starts_cleanly(uno: Uno, pause_cycles: int) -> None:
    first, second = render(BLIP, 800), render(SNAP, 300)
    start = uno.write(play_message(2))
    uno.run(pause_cycles)
    uno.write(play_message(0))
    uno.run(320 * TICK_CYCLES)
    counts = played_after(uno, start, 1000)
    joins = [n for n in range(1, 200) if np.array_equal(counts[n : n + 250], second[:250])]
    assert len(joins) == 1
    np.testing.assert_array_equal(counts[: joins[0]], first[: joins[0]])


def test_strength_0_silences_a_board_that_sounds(uno: Uno) -> None:
    uno.write(play_message(1))
    uno.run(100 * TICK_CYCLES)
    start = uno.write(play_message(0, 0))
    uno.run(20 * TICK_CYCLES)
    assert (uno.samples().after(start).counts[-15:] == SILENCE_counts).all()
    assert not read_status(uno.read(5)).playing


def sample_intervals(uno: Uno) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
    """Cycles between the timer's samples; the very first sample is that of the boot."""
    cycles = uno.samples().cycles[1:].astype(np.int64)
    return cycles[1:] - cycles[:-1]


def worst_deviation_us(intervals: np.ndarray[tuple[int], np.dtype[np.int64]]) -> float:
    return float(np.max(np.abs(intervals - TICK_CYCLES))) / CLOCK_HZ * 1e6


def measure(uno: Uno, sounding: bool) -> list[float]:
    latencies = []
    silent = Slot(Waveform.SINE, 16, 60_000, 0)
    for message in bank_messages([SNAP, silent]):
        uno.write(message)
    for phase in PHASES:
        if sounding:
            uno.write(play_message(1))
        start = uno.write(play_message(0), (uno.cycle // TICK_CYCLES + 2) * TICK_CYCLES + phase)
        uno.run(5 * TICK_CYCLES)
        latencies.append(latency_us(uno, start))
        uno.write(play_message(0, 0))
        uno.run(5 * TICK_CYCLES)
    return latencies


@pytest.mark.parametrize("sounding", [False, True])
def test_a_play_is_felt_within_a_quarter_of_a_millisecond_at_every_phase_of_the_timer(
    uno: Uno, sounding: bool
) -> None:
    latencies = measure(uno, sounding)
    say(
        f"{'retriggered' if sounding else 'from silence'}, {len(latencies)} phases: "
        f"{min(latencies):.1f} to {max(latencies):.1f} us, mean {np.mean(latencies):.1f} us; "
        f"samples off by {worst_deviation_us(sample_intervals(uno)):.2f} us at most"
    )
    # the bus alone: address and four bytes, 9 bits each, at 400 kHz
    assert min(latencies) > 5 * 9 * 2.5
    assert max(latencies) <= 250
    assert worst_deviation_us(sample_intervals(uno)) < 2


def test_samples_come_at_16_khz_and_commands_do_not_move_them(uno: Uno) -> None:
    for index in (0, 2, 1, 3, 4):
        uno.write(play_message(index))
        uno.read(5)
        uno.write(b"\x22\x00\x00\x00")
        uno.run(37 * TICK_CYCLES)
    intervals = sample_intervals(uno)
    jitter_us = worst_deviation_us(intervals)
    interrupts = uno.interrupt_cycles()
    say(
        f"mean interval {intervals.mean():.3f} cycles, worst deviation {jitter_us:.2f} us; "
        f"interrupt {interrupts.mean():.0f} mean, {interrupts.max()} worst of {TICK_CYCLES} cycles"
    )
    assert intervals.mean() == pytest.approx(TICK_CYCLES, abs=0.05)
    assert jitter_us < 2
    assert interrupts.max() < 1000


@pytest.mark.parametrize("bit", range(0, 32, 3))
def test_a_play_with_a_flipped_bit_is_ignored_and_counted(uno: Uno, bit: int) -> None:
    before = read_status(uno.read(5))
    damaged = bytearray(play_message(0))
    damaged[bit // 8] ^= 1 << bit % 8
    start = uno.write(bytes(damaged))
    uno.run(20 * TICK_CYCLES)
    after = read_status(uno.read(5))
    assert (uno.samples().after(start).counts == SILENCE_counts).all()
    assert (after.accepted, after.errors) == (before.accepted, before.errors + 1)


def test_a_play_cut_off_is_counted_at_the_next_start_and_the_next_is_played(uno: Uno) -> None:
    uno.write(play_message(0)[:3], stop=False)
    start = uno.write(play_message(0))
    uno.run(300 * TICK_CYCLES)
    np.testing.assert_array_equal(played_after(uno, start, 270), render(SNAP, 270))
    assert read_status(uno.read(5)).errors == 1


def test_a_disturbed_bus_is_let_go_and_works_again(uno: Uno) -> None:
    uno.write(play_message(0)[:2], stop=False)
    uno.disturb()
    start = uno.write(play_message(0))
    uno.run(300 * TICK_CYCLES)
    np.testing.assert_array_equal(played_after(uno, start, 270), render(SNAP, 270))
    assert read_status(uno.read(5)).errors == 1


def test_the_status_tells_what_was_accepted_and_whether_it_plays(uno: Uno) -> None:
    accepted = len(bank_messages(SLOTS))
    assert read_status(uno.read(5)).accepted == accepted
    uno.write(play_message(0))
    assert read_status(uno.read(5)).playing
    uno.run(300 * TICK_CYCLES)
    status = read_status(uno.read(5))
    assert (status.playing, status.watchdog, status.accepted, status.errors) == (
        False,
        False,
        accepted + 1,
        0,
    )


def test_a_timer_that_stops_resets_the_board_into_silence(uno: Uno) -> None:
    uno.write(play_message(1))
    uno.run(20 * TICK_CYCLES)
    stopped = uno.cycle
    uno.poke(TIMSK1, 0)
    uno.run(WATCHDOG_CYCLES)
    late = uno.samples().after(stopped)
    assert len(late.counts) > 100
    assert (late.counts == SILENCE_counts).all()
    status = read_status(uno.read(5))
    assert (status.playing, status.watchdog, status.accepted) == (False, True, 0)
    say(f"silent {(int(late.cycles[0]) - stopped) / CLOCK_HZ * 1e3:.1f} ms after the timer stopped")


def test_the_bus_pins_have_no_pull_ups(uno: Uno) -> None:
    portc, mcucr = 0x28, 0x55
    assert uno.peek(portc) & 0x30 == 0
    assert uno.peek(mcucr) & 0x10 == 0


def test_flash_and_ram_hold_the_program_and_its_stack(uno: Uno, build: Build) -> None:
    def play_every_slot() -> None:
        for index in range(len(SLOTS)):
            uno.write(play_message(index))
            uno.run(50 * TICK_CYCLES)
            uno.read(5)

    check_memory(uno, build.elf, play_every_slot)

"""The LED strip's Uno in simavr, spoken to by the real driver: every figure here is emulated."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from fdvv.errors import DeviceError
from fdvv_strip.board import LedPointingTask, StripResult, StripRound
from fdvv_strip.tables import STRIP_HOST_TIMEOUT_MS, StripLed, StripMode
from tests.firmware._simavr import build_board, check_memory, require_tools, say
from tests.firmware._uno_strip import CYCLES_us, StripFrame, UnoStrip, build_strip_emulator

pytestmark = pytest.mark.firmware

WHITE, GREEN = (255, 255, 255), (0, 160, 0)
BOARD, LONG = StripRound(), StripRound(200, 0.1, 240, 200, 7, 0.3)
SHORT = StripRound(200, 0.06, zone_px=20, after_s=0.4)
OVERFLOW_us = 32768
TIMSK1, PORTB, DDRB = 0x6F, 0x25, 0x24


@dataclass(frozen=True)
class Build:
    elf: Path
    emulator: ctypes.CDLL


@pytest.fixture(scope="module")
def build(tmp_path_factory: pytest.TempPathFactory) -> Build:
    require_tools()
    folder = tmp_path_factory.mktemp("strip")
    return Build(build_board(folder, "uno_strip"), build_strip_emulator(folder))


@pytest.fixture
def uno(build: Build) -> Iterator[UnoStrip]:
    board = UnoStrip(build.emulator, build.elf)
    yield board
    board.free()


@pytest.fixture
def task(uno: UnoStrip) -> LedPointingTask:
    return LedPointingTask(uno)


def bullets(frames: list[StripFrame]) -> list[tuple[int, StripFrame]]:
    """The frames with a bullet, and its pixel."""
    found = [(frame.lit(*WHITE), frame) for frame in frames]
    assert all(len(lit) <= 1 for lit, _ in found), "two bullets"
    return [(lit[0], frame) for lit, frame in found if lit]


def lateness_us(frames: list[StripFrame], order: StripRound, result: StripResult) -> npt.NDArray[np.float64]:
    """How much later than its time each pixel showed the bullet; every pixel is there once, in order."""
    seen = bullets(frames)
    assert [pixel for pixel, _ in seen] == list(range(order.pixels))
    together = order.led is StripLed.TOGETHER
    shown_us = [frame.latched_us if together else frame.shown_us[pixel] for pixel, frame in seen]
    wanted_us = 1e6 * result.start_s + 1e6 / order.speed_px_s * np.arange(order.pixels)
    return np.asarray(np.array(shown_us) - wanted_us, np.float64)


def played_with(uno: UnoStrip, task: LedPointingTask, order: StripRound, cycles: list[int]) -> StripResult:
    """Play a round in which the key line rises at these cycles after the target's."""
    start = task.begin(order)
    target = uno.cycle_of(1e6 * start.target_s)
    for cycle in cycles:
        uno.key_at(target + cycle, 2000)
    return task.wait(start)


def errors_us(result: StripResult, cycles: list[int]) -> list[float]:
    """Return the errors of the reported asynchronies."""
    reported_us = [1e6 * (at_s - result.target_s) for at_s in result.activations_s]
    return [found - cycle / CYCLES_us for found, cycle in zip(reported_us, cycles, strict=True)]


# -- timing ----------------------------------------------------------------------------


def cycles_around_frames(order: StripRound, seed: int) -> list[int]:
    """Eight edges, cycles after the target: four while a frame of the bullet is sent, four in between."""
    random, found = np.random.default_rng(seed), []
    for number, pixel in enumerate(sorted(random.choice(np.arange(2, 96), 8, replace=False).tolist())):
        lead_us = 46 / 16 * (4 + 4 * (pixel + 1))
        after_us = random.uniform(100, 1600) if number % 2 else random.uniform(2000, 4500)
        step_us = 1e6 * (pixel - order.zone_px) / order.speed_px_s
        found.append(round((step_us - lead_us + after_us) * CYCLES_us))
    return found


@pytest.mark.parametrize("seed", range(4))
def test_an_edge_is_reported_to_a_microsecond_whatever_the_board_is_sending(
    uno: UnoStrip, task: LedPointingTask, seed: int
) -> None:
    uno.frames()
    cycles = cycles_around_frames(SHORT, seed)
    result = played_with(uno, task, SHORT, cycles)
    found = errors_us(result, cycles)
    frames = uno.frames()
    at_us = [1e6 * result.target_s + cycle / CYCLES_us for cycle in cycles]
    sending = [any(f.begun_us <= at <= f.ended_us for f in frames) for at in at_us]
    say(f"{sum(sending)} of 8 edges in a frame: reported {min(found):+.2f} to {max(found):+.2f} us off")
    assert result.presses == 8
    assert sum(sending) >= 4
    assert max(map(abs, found)) <= 1.0


def test_an_edge_at_the_timers_overflow_is_reported_to_a_microsecond(
    uno: UnoStrip, task: LedPointingTask
) -> None:
    found = []
    for offset in range(-24, 25, 3):
        start = task.begin(SHORT)
        overflow_us = (1e6 * start.target_s // OVERFLOW_us + 2) * OVERFLOW_us
        cycle = uno.cycle_of(overflow_us) + offset
        uno.key_at(cycle, 2000)
        result = task.wait(start)
        found += errors_us(result, [cycle - uno.cycle_of(1e6 * start.target_s)])
    say(f"{len(found)} edges within 1.5 us of an overflow: {min(found):+.2f} to {max(found):+.2f} us off")
    assert max(map(abs, found)) <= 1.0


@pytest.mark.parametrize("led", list(StripLed))
@pytest.mark.parametrize("speed_px_s", [100, 150])
def test_the_bullet_is_at_the_pixel_that_its_time_says(
    uno: UnoStrip, task: LedPointingTask, speed_px_s: int, led: StripLed
) -> None:
    order = replace(BOARD, speed_px_s=speed_px_s, led=led)
    uno.frames()
    result = task.play(order)
    late_us = lateness_us(uno.frames(), order, result)
    say(
        f"{speed_px_s} px/s, {led.name.lower()}: bullet {late_us.min():.0f} to {late_us.max():.0f} us late, "
        f"mean {late_us.mean():.0f}, sd {late_us.std():.0f}; the board saw {1e6 * result.late_s:.0f} us"
    )
    assert late_us.min() > -20
    assert late_us.max() < 60
    assert result.frames == order.pixels + 1
    assert result.target_s - result.start_s == pytest.approx(order.zone_px / speed_px_s, abs=1e-6)


def test_neither_noise_on_the_line_nor_a_chattering_key_moves_bullet_or_edges(
    uno: UnoStrip, task: LedPointingTask
) -> None:
    order = replace(BOARD, speed_px_s=150, delay_s=0.1, after_s=0.4)
    uno.frames()
    start = task.begin(order)
    target = uno.cycle_of(1e6 * start.target_s)
    cycles = [-160_000 + 16_000 * n + 7 * n for n in range(8)]
    for cycle in cycles:
        uno.key_at(target + cycle, 2000)
    random = np.random.default_rng(1)
    while task.result() is None:
        for _ in range(20):
            uno.write(random.integers(0, 256, 90, dtype=np.uint8).tobytes())
            uno.run_s(0.009)
    result = task.wait(start)
    late_us = lateness_us(uno.frames(), order, result)
    found = errors_us(result, cycles)
    say(
        f"line full of noise: bullet up to {late_us.max():.0f} us late, "
        f"edges up to {max(map(abs, found)):.2f} us off"
    )
    assert late_us.max() < 200
    assert max(map(abs, found)) <= 1.0
    assert result.is_whole


def test_the_longest_strip_at_the_greatest_speed_is_sent_in_time(
    uno: UnoStrip, task: LedPointingTask
) -> None:
    uno.frames()
    result = task.play(LONG)
    frames = uno.frames()
    late_us = lateness_us(frames, LONG, result)
    longest_us = max(frame.ended_us - frame.begun_us for frame in frames)
    say(f"240 pixels, 200 px/s: frame {longest_us:.0f} us, bullet up to {late_us.max():.0f} us late")
    assert longest_us < 3000
    assert late_us.max() < 60


def test_a_frame_of_the_papers_strip_leaves_three_quarters_of_a_step(
    uno: UnoStrip, task: LedPointingTask
) -> None:
    uno.frames()
    task.play(replace(BOARD, speed_px_s=150))
    lengths_us = [f.ended_us - f.begun_us for _, f in bullets(uno.frames())]
    say(f"144 pixels: {np.median(lengths_us):.0f} us, {max(lengths_us):.0f} at most, of 6667 us a step")
    assert max(lengths_us) < 6667 / 4 + 100


# -- what is shown --------------------------------------------------------------------------------------


def test_the_strip_is_dark_from_the_first_frame_on(uno: UnoStrip) -> None:
    uno.run_s(0.2)
    frames = uno.frames()
    assert len(frames) >= 4
    assert all(frame.is_dark and len(frame.pixels) == 240 for frame in frames)


def test_the_zone_is_shown_from_the_start_to_the_end_and_the_bullet_passes_over_it(
    uno: UnoStrip, task: LedPointingTask
) -> None:
    uno.run_s(0.01)
    uno.frames()
    task.play(BOARD)
    frames = uno.frames()[1:]
    zone = set(range(95, 106))
    assert all(set(f.lit(*GREEN)) == zone - set(f.lit(*WHITE)) for f in frames)
    assert {int(f.pixels[100, 0]) for f in frames} == {0xE0 | BOARD.brightness}
    assert sum(bool(f.lit(*WHITE)) for f in frames) == 144


def test_a_few_pixels_can_be_lit_to_check_the_strip(uno: UnoStrip, task: LedPointingTask) -> None:
    uno.run_s(0.06)
    uno.frames()
    task.show(3, 2, (10, 20, 30))
    uno.run_s(0.1)
    assert uno.frames()[-1].lit(30, 20, 10) == [3, 4]
    task.stop()
    uno.run_s(0.1)
    assert uno.frames()[-1].is_dark


def test_more_pixels_than_the_supply_bears_are_refused(task: LedPointingTask) -> None:
    with pytest.raises(DeviceError, match=r"refused show: a value is out of range \(field 2\)"):
        task.show(230, 16, WHITE)


# -- trouble --------------------------------------------------------------------------------------------


def test_the_strip_goes_dark_when_the_host_is_gone_and_the_round_says_so(
    uno: UnoStrip, task: LedPointingTask
) -> None:
    start = task.begin(replace(BOARD, delay_s=0.05))
    uno.run_s(0.05 + STRIP_HOST_TIMEOUT_MS * 1e-3 + 0.1)
    frames = uno.frames()
    dark_us = next(f.begun_us for f in frames if f.is_dark and f.begun_us > 1e6 * start.start_s)
    say(f"dark {1e-3 * (dark_us - 1e6 * start.start_s) + 50:.0f} ms after the host was heard last")
    assert all(f.is_dark for f in frames if f.begun_us >= dark_us)
    assert frames[-1].is_dark
    result = task.result()
    assert result is not None
    assert not result.is_whole


def test_a_board_that_stands_still_is_reset_and_dark_and_says_why(
    uno: UnoStrip, task: LedPointingTask
) -> None:
    task.begin(BOARD)
    uno.run_s(0.02)
    uno.poke(TIMSK1, 0)
    uno.run_s(0.2)
    frames = uno.frames()
    assert frames[-1].is_dark
    with pytest.raises(DeviceError, match="refused status: it was started anew and knows nobody"):
        task.status()
    assert LedPointingTask(uno).was_reset


def test_presses_beyond_the_eighth_and_outside_the_round_are_counted_only(
    uno: UnoStrip, task: LedPointingTask
) -> None:
    uno.key_at(uno.cycle + 100)
    uno.run_s(0.01)
    cycles = [-400_000 + 40_000 * n for n in range(11)]
    result = played_with(uno, task, SHORT, cycles)
    uno.key_at(uno.cycle + 100)
    uno.run_s(0.3)
    assert (result.presses, len(result.activations_s)) == (11, 8)
    assert task.result() == result
    assert task.status().edges == 13
    assert task.status().mode == StripMode.OVER


def test_the_key_line_is_read_and_has_no_pull_up(uno: UnoStrip, task: LedPointingTask) -> None:
    assert task.status().key == 0
    uno.key_at(uno.cycle + 10, 1_600_000)
    uno.run_s(0.01)
    assert task.status().key == 1
    assert uno.peek(DDRB) & 1 == 0
    assert uno.peek(PORTB) & 1 == 0


def test_a_damaged_request_is_counted_and_asked_again(uno: UnoStrip, task: LedPointingTask) -> None:
    uno.write(b"\x05\x02\x01\x07\x08\0")
    before = task.status()
    assert before.bad_frames == 1
    assert task.status().time_us > before.time_us


def test_flash_and_ram_hold_the_program_and_its_stack(
    uno: UnoStrip, task: LedPointingTask, build: Build
) -> None:
    check_memory(uno, build.elf, lambda: played_with(uno, task, SHORT, [0, 5000]))

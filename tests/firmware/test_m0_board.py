"""The ItsyBitsy M0's board support, run by its check program: every figure here is emulated."""

from __future__ import annotations

import random
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import pytest

from fdvv_m0.emulator import M0Emulator
from fdvv_m0.records import TickInputs, TickOutputs
from tests.firmware._m0 import CHECK, TickFrame, build, frames
from tests.firmware._simavr import say

pytestmark = pytest.mark.firmware

TICK_US, READS, MIDDLE = 250, 25, 2048 * 25
BOOT_TICKS = 120  # enumeration and some
World = Callable[[TickOutputs], TickInputs]


@pytest.fixture(scope="module")
def elf() -> Path:
    return build(CHECK)


class Scripted:
    """Feeds each tick readings from a list or a function, and records the board's outputs."""

    def __init__(self, give: Callable[[int], TickInputs] = lambda tick: TickInputs(2048)) -> None:
        self.give = give
        self.outputs: list[TickOutputs] = []

    def __call__(self, outputs: TickOutputs) -> TickInputs:
        self.outputs.append(outputs)
        return self.give(outputs.tick)


def started(elf: Path, world: World | None = None, *, is_cached: bool = True) -> M0Emulator:
    emulator = M0Emulator(elf, world or Scripted(), is_cached=is_cached)
    emulator.run_ticks(BOOT_TICKS)
    return emulator


def test_the_board_enumerates_as_a_serial_port_with_its_serial_number(elf: Path) -> None:
    usb = started(elf).usb
    assert usb.is_open
    assert usb.device_descriptor[:8] == bytes([18, 1, 0, 2, 0xEF, 2, 1, 64])
    assert usb.device_descriptor[8:12] == bytes([0x09, 0x12, 0x01, 0x00])
    assert len(usb.configuration) == int.from_bytes(usb.configuration[2:4], "little")
    assert usb.strings == ["fdvv", "fdvv button simulator", "0FD00001"]


def test_what_the_host_sends_comes_back(elf: Path) -> None:
    emulator = started(elf)
    data = random.Random(1).randbytes(3000)
    emulator.write(data)
    emulator.run_ticks(400)
    assert frames(emulator.read())[1] == data


def test_every_tick_is_reported_with_the_sum_and_extremes_of_its_readings(elf: Path) -> None:
    randomness = random.Random(2)
    script = [
        TickInputs(
            tuple(randomness.randrange(4096) for _ in range(READS)), randomness.randrange(2100, 3500), 99
        )
        for _ in range(600)
    ]
    emulator = M0Emulator(elf, Scripted(lambda tick: script[tick % 600]))
    emulator.run_ticks(600)
    telemetry = frames(emulator.read())[0]
    assert len(telemetry) > 480
    for frame in telemetry:
        tick, rest_us = divmod(frame.time_us, TICK_US)
        readings = script[tick].readings
        assert isinstance(readings, tuple)
        assert (rest_us, frame.elapsed_ticks) == (0, 1)
        assert (frame.sum, frame.lowest, frame.highest) == (sum(readings), min(readings), max(readings))
    assert [b.time_us - a.time_us for a, b in pairwise(telemetry)] == [TICK_US] * (len(telemetry) - 1)


def test_supply_and_force_are_read_in_turn_between_two_bursts(elf: Path) -> None:
    emulator = started(elf, Scripted(lambda tick: TickInputs(2048, 2686, 1234)))
    telemetry = frames(emulator.read())[0][2:]
    assert {frame.force_counts for frame in telemetry} == {1234}
    assert {frame.supply_mV for frame in telemetry} == {2686 * 3300 * 122 // 22 // 4096}


def test_a_burst_of_25_readings_takes_100_us_from_the_tick(elf: Path) -> None:
    costs = started(elf).costs[2:]
    assert all(cost.burst_us is not None and abs(cost.burst_us - 100) < 1.5 for cost in costs)


@pytest.mark.parametrize("counts", [0, 1, 1000, 2047, 2048, 2049, 3000, 4095])
def test_the_duty_of_the_pins_is_the_one_asked_for_to_a_1024th(elf: Path, counts: int) -> None:
    emulator = started(elf, Scripted(lambda tick: TickInputs(counts)))
    asked = max(-32767, min(32767, int((counts * READS - MIDDLE) / 2)))
    assert frames(emulator.read())[0][-1].duty_q15 == asked
    assert abs(emulator.outputs().duty_q15 - asked) < 32
    assert emulator.outputs().enable


def test_one_input_of_the_bridge_stays_high_while_the_other_is_switched(elf: Path) -> None:
    down, up, zero = (started(elf, Scripted(always(counts))).pwm for counts in (3000, 1000, 2048))
    assert down.inputs()[0] == 1.0
    assert 0 < down.inputs()[1] < 1
    assert up.inputs()[1] == 1.0
    assert 0 < up.inputs()[0] < 1
    assert zero.inputs() == (1.0, 1.0)  # the coil is shorted: no voltage


def test_the_bridge_switches_above_hearing(elf: Path) -> None:
    assert started(elf).pwm.frequency_Hz() == 48e6 / 2048


def test_without_supply_the_bridge_is_off_in_the_same_tick(elf: Path) -> None:
    low = TickInputs(3000, supply_counts=1900)
    world = Scripted(lambda tick: low if tick > 150 else TickInputs(3000))
    emulator = started(elf, world)
    emulator.run_ticks(40)
    off = next(change for change in emulator.pwm_log if not change.enable and change.written_us > 1000)
    # supply and force take turns, so it is seen within two ticks
    assert off.written_us - world.outputs[151].time_us < 2 * TICK_US + 200
    assert emulator.pwm.inputs() == (0.0, 0.0)


@pytest.mark.parametrize("pulse_us", [500, 1234, 2400])
def test_the_servo_gets_its_pulse_fifty_times_a_second(elf: Path, pulse_us: int) -> None:
    emulator = started(elf, Scripted(lambda tick: TickInputs(2048, force_counts=pulse_us - 500)))
    assert emulator.outputs().stop_us == pytest.approx(pulse_us)
    assert emulator.pwm.stop_period_us() == pytest.approx(20_000)


def test_the_servo_is_never_sent_beyond_2600_us(elf: Path) -> None:
    emulator = started(elf, Scripted(lambda tick: TickInputs(2048, force_counts=4000)))
    assert emulator.outputs().stop_us == pytest.approx(2600)


def always(counts: int) -> Callable[[int], TickInputs]:
    return lambda tick: TickInputs(counts)


def hopping(tick: int) -> TickInputs:
    """Cross the middle downward every eight ticks."""
    return TickInputs(2100 if tick % 8 < 4 else 2000)


def test_a_message_to_the_vibration_board_leaves_at_400_kHz(elf: Path) -> None:
    world = Scripted(hopping)
    emulator = started(elf, world)
    assert len(emulator.wire_log) == pytest.approx(BOOT_TICKS / 8, abs=2)
    for message in emulator.wire_log:
        assert (message.address, message.data, message.acknowledged) == (0x2A, b"\x22\x01\xff\x5b", True)
    bits = 10 + 4 * 9
    spent = [message.stopped_us - message.started_us for message in emulator.wire_log]
    say(f"five bytes on the bus take {min(spent):.0f} to {max(spent):.0f} us, {bits * 2.5:.0f} of them bits")
    assert bits * 2.5 < min(spent)
    assert max(spent) < 400
    assert sum(len(outputs.messages) for outputs in world.outputs) == pytest.approx(
        len(emulator.wire_log), abs=1
    )


def test_a_message_that_nobody_acknowledges_is_given_up_and_the_next_one_goes(elf: Path) -> None:
    emulator = started(elf, Scripted(hopping))
    emulator.wire.answering.clear()
    before = len(emulator.wire_log)
    emulator.run_ticks(32)
    emulator.wire.answering.add(0x2A)
    emulator.run_ticks(32)
    refused, taken = emulator.wire_log[before + 1 : before + 3], emulator.wire_log[-2:]
    assert [(message.acknowledged, message.data) for message in refused] == [(False, b"")] * 2
    assert all(message.acknowledged for message in taken)


def test_a_bus_that_hangs_is_freed_and_used_again(elf: Path) -> None:
    emulator = started(elf, Scripted(hopping))
    emulator.wire.is_stuck = True
    emulator.run_ticks(32)
    stuck = len(emulator.wire_log)
    emulator.run_ticks(8)
    assert len(emulator.wire_log) == stuck
    emulator.wire.is_stuck = False
    emulator.run_ticks(64)
    assert len(emulator.wire_log) > stuck
    assert emulator.wire_log[-1].acknowledged
    assert emulator.resets == 0


def test_a_program_that_hangs_is_reset_and_the_bridge_is_off_meanwhile(elf: Path) -> None:
    emulator = started(elf, Scripted(lambda tick: TickInputs(3500)))
    assert emulator.outputs().enable
    hung_us = emulator.time_us
    emulator.hang("board_acquire")
    emulator.run_us(4000)
    off = next(change for change in emulator.pwm_log if change.written_us > hung_us and not change.enable)
    say(f"from the last tick served to the watchdog's reset {off.written_us - hung_us:.0f} us at most")
    assert off.written_us - hung_us < 2200
    assert (emulator.resets, emulator.reset_cause) == (1, "watchdog")
    assert emulator.pwm.inputs() == (0.0, 0.0)


@pytest.mark.parametrize(("cause", "number"), [("watchdog", 1), ("brown-out", 2), ("power on", 0)])
def test_after_a_reset_the_program_knows_why(elf: Path, cause: str, number: int) -> None:
    emulator = started(elf)
    emulator.reset(cause)
    emulator.run_ticks(4)
    assert not emulator.usb.is_open
    emulator.run_ticks(BOOT_TICKS)
    assert frames(emulator.read()[-24 * 8 :])[0][-1].reset_cause == number


def test_the_bridge_is_low_from_reset_until_the_first_readings(elf: Path) -> None:
    emulator = M0Emulator(elf, Scripted(lambda tick: TickInputs(4000)))
    emulator.run_ticks(3)
    quiet, driven = emulator.pwm_log[0], emulator.pwm_log[-1]
    assert (quiet.duty_q15, quiet.enable) == (0, False)
    assert driven.enable
    assert len(emulator.pwm_log) == 2


def test_a_pulled_cable_stops_the_port_and_not_the_ticks(elf: Path) -> None:
    world = Scripted(hopping)
    emulator = started(elf, world)
    emulator.unplug()
    emulator.read()
    emulator.run_ticks(100)
    assert emulator.read() == b""
    assert {outputs.duty_q15 for outputs in world.outputs[-16:]} == {-576, 640}
    emulator.plug()
    emulator.run_ticks(BOOT_TICKS)
    assert emulator.usb.is_open
    telemetry, _echo = frames(emulator.read())
    assert telemetry[-1].elapsed_ticks == 1


def run_stalled(elf: Path, stalls: dict[int, float], ticks: int) -> list[TickFrame]:
    """Return what the board tells of ticks whose number it reads, some stalled for so many us."""
    emulator: list[M0Emulator] = []

    def world(outputs: TickOutputs) -> TickInputs:
        emulator[0].stall(stalls.get(outputs.tick, 0.0))
        return TickInputs(outputs.tick)

    emulator.append(M0Emulator(elf, world))
    emulator[0].run_ticks(ticks)
    return frames(emulator[0].read())[0]


def test_ticks_that_the_processor_missed_are_counted_and_the_clock_stays_true(elf: Path) -> None:
    stalls = {300: 600.0, 310: 250.0, 320: 2 * TICK_US - 20.0}
    telemetry = run_stalled(elf, stalls, 400)
    late = [frame for frame in telemetry if frame.elapsed_ticks != 1]
    assert len(late) == len(stalls)
    assert all(b.time_us - a.time_us == TICK_US * b.elapsed_ticks for a, b in pairwise(telemetry))
    # the readings of a tick that was served late are those of its own burst, not of a later one
    assert all(frame.highest - frame.lowest == 0 for frame in telemetry)


def test_a_tick_that_comes_while_the_converter_is_made_ready_for_it_is_counted_as_missed(elf: Path) -> None:
    # stalls that end before, in and after that time: a conversion that the missed tick started goes on
    telemetry = run_stalled(elf, {200 + 4 * k: 205 + 0.25 * k for k in range(140)}, 780)
    assert {frame.elapsed_ticks for frame in telemetry} == {1, 2}
    assert all(b.time_us - a.time_us == TICK_US * b.elapsed_ticks for a, b in pairwise(telemetry))
    assert all(f.lowest == f.highest == f.time_us // TICK_US for f in telemetry)


def test_running_in_pieces_is_running_at_once(elf: Path) -> None:
    whole, pieces = (M0Emulator(elf, Scripted(hopping)) for _ in range(2))
    whole.run_ticks(200)
    for count in (1, 2, 3, 94, 100):
        pieces.run_ticks(count)
    assert whole.costs == pieces.costs
    assert whole.pwm_log == pieces.pwm_log
    assert whole.read() == pieces.read()


@pytest.mark.parametrize("is_cached", [True, False])
def test_no_tick_is_late_while_every_tick_is_reported_over_usb(elf: Path, is_cached: bool) -> None:
    emulator = started(elf, Scripted(hopping), is_cached=is_cached)
    emulator.read()
    emulator.run_ticks(1000)
    telemetry, _echo = frames(emulator.read())
    costs = emulator.costs[BOOT_TICKS:]
    worst_us = max(cost.latency_us or TICK_US for cost in costs)
    say(
        f"tick to duty at most {worst_us:.0f} us, longest pass {max(c.longest_pass_us for c in costs):.0f} us"
    )
    assert {frame.elapsed_ticks for frame in telemetry} == {1}
    assert len(telemetry) >= 990
    assert worst_us < 200
    # what the program says of itself ends a little later and is cut to whole microseconds
    assert all(abs(frame.served_us - worst_us) < 60 for frame in telemetry)

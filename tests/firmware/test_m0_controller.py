"""The rig's controller on the emulated ItsyBitsy M0, spoken to by the real client: figures are emulated."""

from __future__ import annotations

import struct
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fdvv.device.boards import LibraryBoard
from fdvv.device.linked import LinkedDevice
from fdvv.model.file import load_builtin
from fdvv.program.button import compile_button
from fdvv.protocol.tables import Settings, TickFlag
from fdvv_m0.board import SHARE_OF_TICK, EmulatedBoard
from fdvv_m0.emulator import M0Emulator
from fdvv_m0.records import TickInputs
from tests.firmware._m0 import CONTROLLER, build, sizes_bytes
from tests.firmware._simavr import say
from tests.support.link_rigs import LONG, PROGRAMS
from tests.support.scripted_person import ScriptedPerson, ScriptedPlant

pytestmark = pytest.mark.firmware

AHEAD = {"predictor_q16": 6000, "lead_us": 3000, "brake_lead_us": 2000, "drag_q13": 500, "friction_cN64": 100}
BUTTON = compile_button(load_builtin("mx-brown")).image
PLAIN = PROGRAMS[0]


@pytest.fixture(scope="module")
def elf() -> Path:
    return build(CONTROLLER)


@pytest.fixture
def emulated(elf: Path) -> LinkedDevice:
    return LinkedDevice(EmulatedBoard(elf), ScriptedPerson(3))


def board_of(device: LinkedDevice) -> EmulatedBoard:
    board = device.port.board
    assert isinstance(board, EmulatedBoard)
    return board


@pytest.mark.parametrize("tuning", [{}, AHEAD])
def test_a_press_on_the_board_is_the_press_of_the_same_code_on_this_machine(
    emulated: LinkedDevice, tuning: dict[str, int]
) -> None:
    here = LinkedDevice(LibraryBoard(), ScriptedPerson(3))
    for device in (emulated, here):
        if tuning:
            device.configure(replace(device.settings(), **tuning))
        device.upload_program(PLAIN)
    for velocity_mm_s in (50.0, 200.0):
        there, then = emulated.press(velocity_mm_s), here.press(velocity_mm_s)
        count = min(there.t_s.size, then.t_s.size) - 32  # two frames are still on their way
        assert there.sensed_mm is not None
        assert then.sensed_mm is not None
        assert there.commanded_cN is not None
        assert then.commanded_cN is not None
        # looking ahead remembers ticks from before the record, which are not the same ones
        first = 64 if tuning else 0
        apart = np.abs(there.commanded_cN[first:count] - then.commanded_cN[first:count])
        assert np.abs(there.sensed_mm[:count] - then.sensed_mm[:count]).max() < 1e-9
        assert apart.max() < 1e-9
        assert then.commanded_cN.max() > 15.0


def test_no_tick_is_late_while_a_long_program_is_uploaded_and_pressed(emulated: LinkedDevice) -> None:
    board = board_of(emulated)
    before = len(board.emulator.costs)
    emulated.upload_program(LONG)
    emulated.press(150.0)
    costs = board.emulator.costs[before:]
    counters = emulated.client.counters()
    latencies_us = sorted(cost.latency_us for cost in costs if cost.latency_us is not None)
    longest_us = max(cost.longest_pass_us for cost in costs)
    median_us = latencies_us[len(latencies_us) // 2]
    say(f"{len(costs)} ticks, all of them reported: tick to duty {median_us:.0f} us in the middle")
    say(f"at most {counters.worst_tick_us} us by the board's own clock")
    say(f"longest time between two looks for readings {longest_us:.0f} us")
    assert counters.late == 0
    assert counters.lost_records == 0
    assert counters.worst_tick_us < 250


def test_the_bridge_is_off_unless_armed(emulated: LinkedDevice) -> None:
    emulated.upload_program(PLAIN)
    emulator = board_of(emulated).emulator
    assert not emulator.outputs().enable
    emulated.press(100.0)
    assert any(change.enable for change in emulator.pwm_log)
    assert emulator.pwm.inputs() == (0.0, 0.0)
    assert not emulator.outputs().enable


def test_a_pulled_cable_ends_the_force_within_the_host_timeout(emulated: LinkedDevice) -> None:
    emulated.upload_program(PLAIN)
    emulated.client.arm()
    board = board_of(emulated)
    board.emulator.run_ticks(20)
    assert board.emulator.outputs().enable
    pulled_us = board.emulator.time_us
    board.unplug()
    board.emulator.run_us(Settings().host_timeout_ms * 1000 + 2000)
    off = next(c for c in board.emulator.pwm_log if c.written_us > pulled_us and not c.enable)
    assert off.written_us - pulled_us <= Settings().host_timeout_ms * 1000 + 500


def held_down(device: LinkedDevice, key_mm: float = 3.5) -> M0Emulator:
    """Arm on a button whose cap lies below its actuation point."""
    device.upload_program(BUTTON)
    random, settings = np.random.default_rng(0), device.settings()
    device.port.connect(ScriptedPlant(np.full(10, key_mm), 100.0, settings, random))
    device.port.step()  # the cap lies there before the board is armed: else it has jumped
    device.client.arm()
    device.client.listen(device.port.now_s() + 0.02)
    emulator = board_of(device).emulator
    assert emulator.outputs().key
    return emulator


def test_the_key_line_rises_and_falls_in_the_tick_that_decides(emulated: LinkedDevice) -> None:
    emulated.upload_program(BUTTON)
    emulated.press(100.0)
    telemetry, emulator = emulated.client.telemetry.columns(), board_of(emulated).emulator
    tick_us, down, up = emulator.tick_us, *emulator.key_log
    last_us = emulator.time_us - SHARE_OF_TICK * tick_us  # the board in lockstep stops there in each tick
    late_us = [(edge.time_us - last_us) % tick_us for edge in (down, up)]
    ticks = [emulator.tick + (edge.time_us - last_us) // tick_us for edge in (down, up)]
    flagged = telemetry.tick[np.flatnonzero(telemetry.flags & TickFlag.KEY_DOWN)]
    say(f"key line {max(late_us):.0f} us after the tick at most, duty {emulator.costs[-1].latency_us:.0f} us")
    assert (down.is_down, up.is_down) == (True, False)
    assert ticks == [flagged[0], flagged[-1] + 1]
    assert max(late_us) < SHARE_OF_TICK * tick_us


def test_a_key_that_is_down_comes_up_with_the_force_when_the_host_is_lost(emulated: LinkedDevice) -> None:
    emulator = held_down(emulated)
    board_of(emulated).unplug()
    emulator.run_us(Settings().host_timeout_ms * 1000 + 2000)
    off = next(change for change in emulator.pwm_log if not change.enable and change.written_us > 100_000)
    assert not emulator.outputs().key
    assert abs(emulator.key_log[-1].time_us - off.written_us) < 20


def test_a_key_that_is_down_comes_up_when_the_controller_is_reset(emulated: LinkedDevice) -> None:
    emulator = held_down(emulated)
    emulator.stall(5000)
    emulator.run_us(3000)
    assert emulator.reset_cause == "watchdog"
    assert not emulator.key_log[-1].is_down
    assert not emulator.outputs().key


def test_a_hanging_controller_is_reset_with_the_bridge_off_and_says_why(emulated: LinkedDevice) -> None:
    emulated.upload_program(PLAIN)
    emulated.client.arm()
    emulator = board_of(emulated).emulator
    emulator.run_ticks(20)
    emulator.stall(5000)
    emulator.run_us(3000)
    assert emulator.reset_cause == "watchdog"
    assert not emulator.outputs().enable


def kept_heat_K(emulator: M0Emulator) -> tuple[float, bool]:
    """Return the heat that the board would go on with after a reset, and whether it is whole."""
    at = emulator._program.symbols["kept_heat"]
    heat, check = struct.unpack("<II", emulator._bus.ram_read(at, 8))
    return heat / 65536, heat ^ check == 2**32 - 1


@pytest.mark.parametrize(
    ("cause", "flipped", "kelvins"),
    [("watchdog", 0, 2), ("watchdog", 1, 91), ("software", 0, 2), ("power on", 0, 2), ("power on", 1, 91)],
)
def test_the_heat_survives_a_reset_or_starts_at_the_limit(
    emulated: LinkedDevice, cause: str, flipped: int, kelvins: int
) -> None:
    emulator = board_of(emulated).emulator
    emulator.run_ticks(20)
    assert kept_heat_K(emulator) == (1.0, True)  # a kelvin more than it went on with
    at = emulator._program.symbols["kept_heat"]
    emulator._bus.ram_write(at, bytes([emulator._bus.ram_read(at, 1)[0] ^ flipped]))
    emulator.reset(cause)
    emulator.run_ticks(20)
    heat_K, is_whole = kept_heat_K(emulator)
    assert is_whole
    assert heat_K == pytest.approx(kelvins, abs=0.02)


@pytest.mark.parametrize(("tick_us", "reads"), [(500, 25), (1000, 25), (250, 10)])
def test_the_tick_follows_the_settings(emulated: LinkedDevice, tick_us: int, reads: int) -> None:
    emulated.configure(Settings(tick_us=tick_us, reads=reads, position_gain_q14=20000))
    emulator = board_of(emulated).emulator
    emulator.run_ticks(4)
    assert (emulator.tick_us, emulator.reads) == (tick_us, reads)
    start = emulator.time_us
    emulator.run_ticks(10)
    assert emulator.time_us - start == pytest.approx(10 * tick_us, abs=1)


def test_the_whole_controller_fits(elf: Path) -> None:
    flash, ram = sizes_bytes(elf)
    say(f"controller: {flash} bytes of flash, {ram} of RAM and 2048 of stack")
    assert flash <= 32 * 1024
    assert ram + 2048 <= 24 * 1024


def test_readings_are_made_up_to_a_sum_and_extremes() -> None:
    made = TickInputs.of_burst(25 * 100 + 3, 90, 130, 25).readings
    assert isinstance(made, tuple)
    assert (len(made), sum(made), min(made), max(made)) == (25, 2503, 90, 130)
    flat = TickInputs.of_burst(2500, 100, 101, 25).readings
    assert isinstance(flat, tuple)
    assert (len(flat), sum(flat)) == (25, 2500)

"""The ItsyBitsy M4's programs: built, started, closing the force loop in an emulator. All emulated."""

from __future__ import annotations

import re
import struct
import subprocess
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from benchmarks.core_cost import full_image
from benchmarks.force_loop_cost import dearest_settings

from fdvv.compensation.force_loop.gains import force_loop_gains
from fdvv.device.linked import LinkedDevice
from fdvv.device.plant import Inputs, Outputs
from fdvv.device.twin import SimulatedPerson
from fdvv.device.wire import RefusedError
from fdvv.firmware.core import INPUTS, OUTPUTS, Core, RecordArray
from fdvv.model.press import Press
from fdvv.protocol.tables import Fault, LoopState
from fdvv.testing.conformance import plain_surface
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import plan
from fdvv_m0.board import EmulatedBoard
from fdvv_m0.m4 import PIN_ENABLE, M4Emulator
from fdvv_m0.records import TickInputs
from tests.firmware._m0 import M4_CHECK, M4_CONTROLLER, TickFrame, build, build_with, frames, sizes_bytes
from tests.firmware._simavr import say
from tests.support.force_loop_press import CONTROLLER, KNOWN, RIG

pytestmark = pytest.mark.firmware
FLASH_BYTES, RAM_BYTES, STACK_BYTES = 512 * 1024 - 16 * 1024, 192 * 1024, 8 * 1024
FAMILY, START = 0x55114460, 0x4000
SUPPLY_GAIN_Q11 = 18150
BEFORE = 200


@pytest.fixture(scope="module")
def elf() -> Path:
    return build(M4_CONTROLLER)


def started(elf: Path, inputs: TickInputs | None = None) -> M4Emulator:
    emulator = M4Emulator(elf, lambda _outputs: inputs or TickInputs(2048, 1354, 2048))
    emulator.run_ticks(20)
    return emulator


def read_ticks(emulator: M4Emulator, count: int) -> list[TickFrame]:
    """Return what the check program tells of its first ticks over USB."""
    while not emulator.usb.is_open:
        emulator.run_ticks(1)
    emulator.run_ticks(50)
    return frames(emulator.read()[: 24 * count])[0]


def close_loop(board: EmulatedBoard, person: SimulatedPerson | None = None) -> LinkedDevice:
    """Return the device of a board, its force loop closed."""
    device = LinkedDevice(board, person or SimulatedPerson(RIG, seed=2))
    assert device.load_cell is not None
    device.close_loop(force_loop_gains(KNOWN, device.load_cell, 1e-4, CONTROLLER))
    return device


class Witness(EmulatedBoard):
    """Keeps what the board read and did in each tick."""

    def __init__(self, elf: Path) -> None:
        super().__init__(elf)
        self.log: list[tuple[Inputs, Outputs]] = []

    def tick(self, inputs: Inputs) -> Outputs:
        outputs = super().tick(inputs)
        self.log.append((inputs, outputs))
        return outputs

    def sensed(self) -> RecordArray:
        """Return the readings as the program converts them: the supply through its divider."""
        rows = np.array([tuple(inputs) for inputs, _ in self.log], INPUTS)
        counts = np.round(rows["supply_mV"] / self.emulator.supply_mV_counts).astype(int)
        rows["supply_mV"] = counts * SUPPLY_GAIN_Q11 >> 11
        return rows


class Pressed(NamedTuple):
    """A board after a press with the loop closed over USB, on the twin's rig behind its registers."""

    board: Witness
    device: LinkedDevice
    press: Press


@pytest.fixture(scope="module")
def pressed(elf: Path) -> Pressed:
    board = Witness(elf)
    device = close_loop(board)
    device.upload(plain_surface(), 4.0)
    device.client.ping()
    return Pressed(board, device, device.press(100.0))


def test_the_programs_fit_flash_and_ram(elf: Path) -> None:
    for program in (elf, build(M4_CHECK)):
        flash, ram = sizes_bytes(program)
        say(f"{program.stem}: {flash} bytes of flash, {ram} of RAM")
        assert flash <= FLASH_BYTES
        assert ram + STACK_BYTES <= RAM_BYTES


def test_the_uf2_is_for_this_chip_and_lies_behind_the_bootloader() -> None:
    data = build(M4_CONTROLLER.with_suffix(".uf2")).read_bytes()
    _, _, flags, address, _, _, _, family = struct.unpack_from("<8I", data)
    assert (address, family, bool(flags & 0x2000)) == (START, FAMILY, True)


def test_nothing_uses_the_floating_point_unit_before_it_is_on(elf: Path) -> None:
    command = ["arm-none-eabi-objdump", "-d", "--disassemble=board_reset", str(elf)]
    code = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert "isb" in code
    assert not re.search(r"\tv[a-z]+", code)
    clocks = started(elf).oscillators
    assert clocks.fpu_cycle is not None
    assert clocks.fpu_cycle < 200


def test_the_clocks_are_those_that_the_program_counts_on(elf: Path) -> None:
    emulator = started(elf)
    assert [emulator.oscillators.hz(generator) for generator in range(4)] == [120e6, 48e6, 2e6, 12e6]
    assert emulator.tick_us == pytest.approx(250)
    assert emulator.resets == 0


def test_the_drive_is_off_until_it_is_armed(elf: Path) -> None:
    emulator = started(elf)
    assert not emulator.port.level(PIN_ENABLE)
    assert {change.duty_q15 for change in emulator.pwm_log} == {0}


def planted_reference(program: Path, folder: Path) -> Path:
    """Build a program whose DAC has the analogue supply as its reference."""
    return build_with(program, folder, "itsybitsy_m4/drive.c", "DAC_CTRLB_REFSEL_VREFPU", "1 << 1")


def test_a_command_of_zero_is_no_force_and_would_be_all_of_it_with_the_analogue_supply_as_reference(
    tmp_path: Path,
) -> None:
    now = started(build(M4_CHECK)).outputs()
    assert (now.enable, now.duty_q15) == (True, 0)
    now = started(planted_reference(M4_CHECK, tmp_path)).outputs()
    assert (now.enable, now.duty_q15) == (True, -32768)


def test_a_setpoint_that_is_not_zero_at_the_start_is_a_fault_and_keeps_the_drive_off(
    elf: Path, tmp_path: Path
) -> None:
    board = EmulatedBoard(planted_reference(elf, tmp_path))
    device = LinkedDevice(board, SimulatedPerson(RIG, seed=2))
    assert device.fault().fault is Fault.OUTPUT
    with pytest.raises(RefusedError, match="a fault is latched"):
        device.clear_fault()
    with pytest.raises(RefusedError, match="a fault is latched, output"):
        device.upload(plain_surface(), 4.0)
    assert not any(change.enable for change in board.emulator.pwm_log)


def test_a_press_with_the_loop_closed_over_usb_is_that_of_the_core_bit_for_bit(pressed: Pressed) -> None:
    board, device, _ = pressed
    done = np.array([(o.duty_q15, o.enable) for _, o in board.log])
    first = int(np.flatnonzero(done[:, 1])[0])
    count = int(done[:, 1].sum())
    core = Core(device.settings(), device.image)
    assert device.loop is not None
    core.close_loop(device.loop.pack())
    core.announce(1600)
    inputs = board.sensed()
    core.run(inputs[first - BEFORE : first])
    core.arm()
    found = core.run(inputs[first : first + count])
    assert count > 5000
    # the converter has 12 bits, the duty 16
    assert np.array_equal(done[first : first + count, 0], (np.trunc(found["duty_q15"] / 16) * 16).astype(int))
    assert same_telemetry(device, found)


def same_telemetry(device: LinkedDevice, found: RecordArray) -> bool:
    """Compare command, displacement and force of the press's last records with those of the core."""
    assert found.dtype == OUTPUTS
    columns = device.client.telemetry.columns()
    n = min(columns.tick.size, found.size) - 20
    ours = np.stack([columns.commanded_cN * 64, columns.displacement_mm * 16000, columns.force_cN * 64])
    theirs = np.stack([found[name] for name in ("commanded_cN64", "displacement_um16", "force_cN64")])
    assert n > 5000
    return any(
        np.array_equal(np.round(ours[:, -n - shift : -shift or None]), theirs[:, -n:]) for shift in range(20)
    )


def test_the_loop_holds_the_force_and_no_tick_is_late(pressed: Pressed) -> None:
    board, device, press = pressed
    x, turn = press.displacement_mm, int(press.displacement_mm.argmax())
    rows = np.flatnonzero((x[:turn] > 1.0) & (x[:turn] < 3.5))
    off = np.abs(press.force_cN[rows] - 40.0 - 5.0 * x[rows])
    costs = board.emulator.costs[-5000:]
    latency = np.array([cost.latency_us for cost in costs if cost.latency_us is not None])
    burst = np.array([cost.burst_us for cost in costs if cost.burst_us is not None])
    say(f"off by {off.mean():.2f} cN on average, at most {off.max():.2f}")
    say(f"burst {np.median(burst):.1f} us, setpoint {np.median(latency):.1f} us, at most {latency.max():.1f}")
    assert off.mean() < 1.0
    assert latency.max() < 100
    counters = device.client.counters()
    assert (counters.late, counters.lost_records, board.emulator.resets) == (0, 0, 0)
    assert LoopState(device.client.read_force_loop().state) is LoopState.CLOSED


def test_the_largest_program_on_the_dearest_settings_misses_no_tick(elf: Path) -> None:
    settings = dearest_settings()
    person = SimulatedPerson(RIG, seed=2)
    person.settings = settings
    board = EmulatedBoard(elf)
    device = close_loop(board, person)
    device.upload_program(full_image(48, 32, settings))
    device.client.stream(1)
    device.client.arm()
    device.client.listen(device.port.now_s() + 0.1)
    person._plant.press(plan(Finger(), 4e-3, 0.1))
    device.client.listen(device.port.now_s() + 0.25)
    latency = np.array([cost.latency_us or 0.0 for cost in board.emulator.costs[-2500:]])
    say(f"largest program: setpoint after {np.median(latency):.1f} us, at most {latency.max():.1f}")
    counters = device.client.counters()
    assert device.fault().fault is Fault.NONE
    assert (counters.late, counters.lost_records) == (0, 0)
    assert LoopState(device.client.read_force_loop().state) is LoopState.CLOSED


def test_a_pulled_cable_ends_the_force_and_opens_the_loop(elf: Path) -> None:
    device = close_loop(EmulatedBoard(elf))
    device.upload(plain_surface(), 4.0)
    device.client.arm()
    device.port.step()
    assert device.port.step().enable
    device.port.unplug()
    for _ in range(3000):
        last = device.port.step()
    assert not last.enable
    device.client.reconnect()
    assert device.fault().fault is Fault.HOST_LOST
    assert LoopState(device.client.read_force_loop().state) is LoopState.OPEN


def flushed_while_it_runs(program: Path, folder: Path) -> Path:
    """Build a program that flushes converter 0 while it runs free."""
    stop, flush = "        stop_position();\n", "        ADC_SWTRIG(ADC0_BASE) = ADC_SWTRIG_FLUSH;\n"
    return build_with(program, folder, "itsybitsy_m4/acquire.c", stop, flush)


def test_a_converter_that_is_flushed_while_it_runs_free_starts_again_before_its_tick(tmp_path: Path) -> None:
    ticks = read_ticks(started(flushed_while_it_runs(M4_CHECK, tmp_path)), 40)
    assert {t.elapsed_ticks for t in ticks[1:]} == {0, 1}


def test_readings_that_come_twice_in_a_tick_do_not_count_as_late(elf: Path, tmp_path: Path) -> None:
    device = LinkedDevice(EmulatedBoard(flushed_while_it_runs(elf, tmp_path)), SimulatedPerson(RIG, seed=2))
    counters = device.client.counters()
    say(f"flushed while it runs: {counters.late} of {counters.ticks} ticks late")
    assert counters.late < counters.ticks


def test_a_program_that_hangs_is_reset_by_the_watchdog_with_the_drive_off(elf: Path) -> None:
    emulator = started(elf)
    emulator.hang("board_acquire")
    hung_us = emulator.time_us
    emulator.run_us(8000)
    assert emulator.resets == 1
    assert emulator.reset_cause == "watchdog"
    assert emulator.time_us - hung_us < 8100
    assert not emulator.port.level(PIN_ENABLE)


def test_the_check_program_reports_what_the_converters_read() -> None:
    ticks = read_ticks(started(build(M4_CHECK), TickInputs(1000, 1354, 3000)), 20)
    assert {(t.sum, t.lowest, t.highest, t.force_counts) for t in ticks} == {(25_000, 1000, 1000, 3000)}
    assert {t.supply_mV for t in ticks} == {1354 * SUPPLY_GAIN_Q11 >> 11}
    assert {t.elapsed_ticks for t in ticks[1:]} == {1}

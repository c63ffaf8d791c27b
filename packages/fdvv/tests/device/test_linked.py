"""Boards in lockstep as devices."""

from __future__ import annotations

import os
import signal
import struct
import subprocess
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fdvv import _native
from fdvv.device.boards import HostBoard, LibraryBoard
from fdvv.device.contract import ProgramDevice
from fdvv.device.linked import LinkedDevice
from fdvv.device.plant import Inputs
from fdvv.device.twin import SimulatedPerson
from fdvv.errors import DeviceError
from fdvv.firmware.limits import limits_like
from fdvv.model.surface import ForceSurface
from fdvv.protocol.frame import Frame, FrameDecoder, encode
from fdvv.protocol.messages import request_frame
from fdvv.protocol.tables import HASH, VERSION, Fault, HelloRequest, Message, Settings
from fdvv.testing.conformance import ProgramConformance, plain_surface
from tests.support.link_rigs import linked
from tests.support.scripted_person import Meddle, ScriptedPerson

AHEAD = {
    "predictor_q16": 6000,
    "lead_us": 3000,
    "brake_lead_us": 2000,
    "drag_q13": 3000,
    "friction_cN64": 300,
}
PROGRAM = Path(_native.__file__).with_name("fdvv-host")


class TestLibraryBoard(ProgramConformance):
    def make(self) -> ProgramDevice:
        return linked()


class TestHostBoard(ProgramConformance):
    opened: list[LinkedDevice]

    @pytest.fixture(autouse=True)
    def _closed(self) -> Iterator[None]:
        self.opened = []
        yield
        for device in self.opened:
            device.close()

    def make(self) -> ProgramDevice:
        self.opened.append(LinkedDevice(HostBoard(), ScriptedPerson()))
        return self.opened[-1]


class TestSimulatedRig(ProgramConformance):
    def make(self) -> ProgramDevice:
        return LinkedDevice(LibraryBoard(), SimulatedPerson(seed=2))


def test_the_host_program_and_the_library_do_the_same_in_every_tick() -> None:
    presses = []
    for board in (LibraryBoard(), HostBoard()):
        with LinkedDevice(board, ScriptedPerson(3)) as device:
            device.upload(plain_surface(), 4.0)
            presses.append([device.press(v) for v in (50.0, 100.0, 300.0)])
            device.configure(replace(device.settings(), **AHEAD))
            device.upload(plain_surface(), 4.0)
            presses[-1].append(device.press(100.0))
    assert presses[0][1].force_cN.tobytes() != presses[0][3].force_cN.tobytes()
    for one, other in zip(*presses, strict=True):
        assert one.sensed_mm is not None
        assert other.sensed_mm is not None
        assert one.force_cN.tobytes() == other.force_cN.tobytes()
        assert one.sensed_mm.tobytes() == other.sensed_mm.tobytes()


WRONG: dict[Fault, Meddle] = {
    Fault.SUPPLY_LOW: lambda tick, inputs: inputs._replace(supply_mV=5000) if tick > 100 else inputs,
    Fault.POSITION_LOW: lambda tick, inputs: inputs._replace(lowest=0) if tick > 100 else inputs,
    Fault.LATE: lambda tick, inputs: inputs._replace(elapsed_ticks=9) if tick == 100 else inputs,
}


@pytest.mark.parametrize("fault", WRONG)
def test_what_goes_wrong_in_a_press_is_named_and_ends_force_at_once(fault: Fault) -> None:
    person = ScriptedPerson(meddle=WRONG[fault])
    device = LinkedDevice(LibraryBoard(), person)
    device.upload(plain_surface(), 4.0)
    with pytest.raises(DeviceError, match=fault.name.lower()):
        device.press(100.0)
    assert device.port.outputs.duty_q15 == 0
    person.meddle = None
    with pytest.raises(DeviceError, match="a fault is latched"):
        device.press(100.0)
    device.clear_fault()
    assert device.press(100.0).force_cN.max() > 30


def test_a_missed_tick_is_marked_as_none() -> None:
    skipped = ScriptedPerson(meddle=lambda t, i: i._replace(elapsed_ticks=2) if t == 200 else i)
    device = LinkedDevice(LibraryBoard(), skipped)
    device.upload(plain_surface(), 4.0)
    press = device.press(100.0)
    assert press.tick is not None
    assert device.client.telemetry.missing_ticks == 1
    assert device.client.telemetry.late_ticks == 1


def test_ctrl_c_in_a_press_disarms() -> None:
    person = ScriptedPerson()

    def interrupt(tick: int, inputs: Inputs) -> Inputs:
        if tick == 150 and person.meddle:
            person.meddle = None
            raise KeyboardInterrupt
        return inputs

    person.meddle = interrupt
    device = LinkedDevice(LibraryBoard(), person)
    device.upload(plain_surface(), 4.0)
    with pytest.raises(KeyboardInterrupt):
        device.press(100.0)
    assert device.port.outputs.duty_q15 == 0
    assert device.fault().fault is Fault.NONE
    assert device.press(100.0).force_cN.max() > 30


def test_other_settings_are_used_and_want_a_new_upload() -> None:
    device = linked()
    device.upload(plain_surface(), 4.0)
    device.configure(Settings(tick_us=500, force_limit_cN64=50 * 64))
    assert device.info().force_limit_cN == 50
    assert device.info().tick_s == 0.0005
    with pytest.raises(DeviceError, match="press before upload"):
        device.press(100.0)
    with pytest.raises(DeviceError, match="limit is 50 cN"):
        device.upload(plain_surface(), 4.0)
    device.upload(plain_surface(20.0), 4.0)
    press = device.press(100.0)
    assert press.tick is not None
    assert np.diff(press.t_s[press.tick]) == pytest.approx(0.0005)


def test_a_board_is_configured_for_its_rig() -> None:
    settings = Settings(tick_us=1000, position_offset_um16=-90000, slew_cN64_tick=16000)
    device = LinkedDevice(LibraryBoard(), ScriptedPerson(settings=settings))
    assert device.client.read_settings() == settings
    device.upload(plain_surface(), 4.0)
    press = device.press(50.0)
    assert press.sensed_mm is not None
    assert press.sensed_mm.max() == pytest.approx(4.0, abs=0.01)
    assert press.tick is not None
    assert np.diff(press.t_s[press.tick]) == pytest.approx(0.001)


def test_a_table_that_no_program_holds_is_refused_with_what_it_would_lose() -> None:
    table = np.random.default_rng(1).uniform(-100, 100, (8, 255))
    surface = ForceSurface(np.linspace(0.0, 5.08, 255), np.arange(1.0, 9.0), table, table)
    with pytest.raises(DeviceError, match=r"the table would change by .* cN to fit a device"):
        linked().upload(surface, 4.0)


def test_a_board_whose_process_ends_is_reported_in_one_line() -> None:
    board = HostBoard()
    device = LinkedDevice(board, ScriptedPerson())
    device.upload(plain_surface(), 4.0)
    os.kill(board.pid, signal.SIGKILL)
    with pytest.raises(DeviceError, match="host: the program has ended"):
        device.press(100.0)
    device.close()


def test_the_host_program_also_speaks_on_standard_input_and_output() -> None:
    given, asked = os.pipe(), os.pipe()
    command = [str(PROGRAM), str(asked[0]), str(given[1])]
    process = subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, pass_fds=(asked[0], given[1])
    )
    assert process.stdin is not None
    assert process.stdout is not None
    hello = encode(request_frame(Message.HELLO, 1, HelloRequest(version=VERSION, hash=HASH)))
    process.stdin.write(hello)
    process.stdin.flush()
    for file in (asked[0], given[1]):
        os.close(file)
    frames: list[Frame] = []
    decoder = FrameDecoder()
    os.write(asked[1], limits_like(Settings()).pack() + struct.pack("<I", 99_200))
    for tick in range(10):
        inputs = Inputs(250 * tick, 51200 + tick, 2048, 2049)
        os.write(asked[1], inputs.pack() + struct.pack("<II", len(hello), 1))
        (sent,) = struct.unpack("<I", os.read(given[0], 24)[20:])
        if sent and not frames:
            frames = decoder.feed(os.read(process.stdout.fileno(), 4096))
    assert [frame.message for frame in frames] == [Message.HELLO + 0x80]
    for file in (asked[1], given[0]):
        os.close(file)
    assert process.wait(10) == 0, "it ends when the plant's pipe is closed"
    process.stdin.close()
    process.stdout.close()


def test_the_host_program_called_wrongly_tells_how() -> None:
    ran = subprocess.run([str(PROGRAM)], capture_output=True, text=True, check=False)
    assert (ran.returncode, ran.stderr) == (2, "usage: fdvv-host PLANT_IN PLANT_OUT [TTY]\n")

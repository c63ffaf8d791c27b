"""The bytes between adapter and moteus, against mjbots' reference manual."""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any

import pytest

from fdvv.errors import DeviceError
from fdvv_drives.drive import LostAnswerError
from fdvv_drives.moteus_drive import MoteusDrive, MoteusPart
from fdvv_drives.testing.moteus_end import FarMoteus
from tests.drives.conftest import need
from tests.drives.scripted import ScriptedLine, scripted


@pytest.fixture(autouse=True, scope="module")
def _library() -> None:
    need("moteus")


MANUAL_COMMAND = "01000a07206000200150ff140400130d"
MANUAL_REPLY = "2404000a005000000170ff230d181400"
"""The manual's example: section A.3 of docs/reference.md in mjbots/moteus."""
WELL = b"OK\r\nrcv 100 " + MANUAL_REPLY.encode() + b"\r\n"


def f32(value: float) -> str:
    return struct.pack("<f", value).hex()


def drive_on(line: ScriptedLine, answer_s: float = 0.5) -> MoteusDrive:
    return MoteusDrive(MoteusPart(line.port, watchdog_ms=50.0), torque_limit=0.5, answer_s=answer_s)


def test_a_command_is_a_position_frame_without_gains_and_with_a_watchdog() -> None:
    with scripted(lambda _data: WELL) as line:
        drive = drive_on(line)
        drive.exchange(0.25)
        drive.close()
        sent = line.came.decode()
    assert sent == (
        "can send 8001 "
        "01000a"  # int8, register 0 (mode): position
        + "0c0620"  # six floats from 0x020: position, velocity, torque, kp and kd scale, largest torque
        + "0000c07f"  # position nan: where it is
        + f32(0.0) + f32(0.25) + f32(0.0) + f32(0.0) + f32(0.5)
        + "0d27" + f32(0.05)  # timeout, s
        + "0d2b" + f32(0.0)  # integral limit
        + "1100" + "1f01" + "130d"  # asks for mode, position to torque, voltage to fault
        + " BF\n"
    )  # fmt: skip


def test_the_manuals_reply_is_read_as_it_says() -> None:
    with scripted(lambda _data: WELL) as line:
        drive = drive_on(line)
        reading = drive.exchange(0.0)
        drive.close()
    assert reading[:2] == pytest.approx((0.008, -1.44))
    assert reading.force_N is None


def test_a_load_cell_at_an_analog_input_is_asked_for_and_read() -> None:
    cell = "2561" + struct.pack("<h", 32767 // 4).hex()  # int16, register 0x061: a quarter
    with scripted(lambda _data: WELL[:-2] + cell.encode() + b"\r\n") as line:
        cabled = MoteusPart(line.port, force_input="aux1.2", force_zero=0.5, force_span_N=-20.0)
        drive = MoteusDrive(cabled, torque_limit=0.5, answer_s=0.5)
        reading = drive.exchange(0.0)
        drive.close()
        sent = line.came.decode()
    assert "1f01" + "130d" + "1561" in sent
    assert drive.senses_force
    assert reading.force_N == pytest.approx(-20.0 * (0.25 - 0.5), abs=1e-3)


@pytest.mark.parametrize(
    "wrong",
    [{"force_input": "aux3.1"}, {"force_input": "aux1.6"}, {"force_input": "aux1.1", "force_span_N": 0.0}],
)
def test_a_load_cell_that_is_not_described_is_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=r"needs force_input aux1.1 to aux2.5, force_span_N"):
        MoteusPart("nowhere", **{"force_span_N": 20.0, **wrong})


def test_the_far_end_reads_the_manuals_command_and_writes_its_reply() -> None:
    far = FarMoteus(None)
    assert far._frame(bytes.fromhex(MANUAL_COMMAND), 0.0) == [(1, 0x00, 4), (0, 0x0D, 3)]
    assert far.mode == 10
    assert far._registers == pytest.approx({0x20: 0.0096, 0x21: 288 * 0.00025, 0x22: -1.76}, rel=1e-6)
    values = {0: 10, 1: 0.008, 2: 256 * 0.00025, 3: -1.44, 0xD: 12.0, 0xE: 20.0, 0xF: 0}
    far._read = lambda register: values[register]  # type: ignore[method-assign]
    assert (far._reply(1, 0, 4) + far._reply(0, 0x0D, 3)).hex() == MANUAL_REPLY


def test_a_far_end_whose_gains_are_not_zero_refuses_to_move() -> None:
    far = FarMoteus(None)
    far._frame(bytes.fromhex(MANUAL_COMMAND), 0.0)
    with pytest.raises(ValueError, match="gains"):
        far.look(0.0, 0.0)


@pytest.mark.parametrize(
    "damaged",
    [
        b"rcv 100 24040\r\n",
        b"rcv 100 2404000a0050\r\n",
        b"rcv 100 zz\r\n",
        b"rcv 200 " + MANUAL_REPLY.encode() + b"\r\n",
        b"\x00\xff\xfe\r\n",
        b"rcv\r\n",
        b"",
    ],
)
def test_what_is_no_answer_is_a_lost_one(damaged: bytes) -> None:
    with scripted(lambda _data: b"OK\r\n" + damaged) as line:
        drive = drive_on(line, answer_s=0.05)
        with pytest.raises(LostAnswerError, match="no answer"):
            drive.exchange(0.0)
        drive.close()


def reply(mode: int, fault: int) -> Callable[[bytes], bytes]:
    body = MANUAL_REPLY[:6] + f"{mode:02x}" + MANUAL_REPLY[8:-2] + f"{fault:02x}"
    return lambda _data: f"OK\r\nrcv 100 {body} E B F\r\n".encode()


@pytest.mark.parametrize(
    ("mode", "fault", "text"),
    [
        (1, 38, "reports fault 38 \\(over-temperature\\)"),
        (1, 99, "reports fault 99"),
        (11, 0, "its watchdog ended the torque"),
        (12, 0, "is in mode 12"),
        (0, 0, "is in mode 0"),
    ],
)
def test_a_fault_or_another_mode_is_one_line(mode: int, fault: int, text: str) -> None:
    with scripted(reply(mode, fault)) as line:
        drive = drive_on(line)
        with pytest.raises(DeviceError, match=text) as error:
            drive.exchange(0.1)
        drive.close()
    assert not isinstance(error.value, LostAnswerError)


def test_a_frame_that_the_adapter_refuses_is_one_line() -> None:
    with scripted(lambda _data: b"ERR bus off\r\n") as line:
        drive = drive_on(line)
        with pytest.raises(DeviceError, match="refuses the frame"):
            drive.exchange(0.0)
        drive.close()

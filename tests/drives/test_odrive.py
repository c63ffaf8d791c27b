"""The bytes between adapter and ODrive, through python-can and slcan, against the CANSimple pages."""

from __future__ import annotations

import struct

import pytest

from fdvv.errors import DeviceError
from fdvv_drives.drive import LostAnswerError, Reading
from fdvv_drives.odrive_drive import ODriveDrive, ODrivePart
from tests.drives.conftest import need
from tests.drives.scripted import scripted


@pytest.fixture(autouse=True, scope="module")
def _library() -> None:
    need("odrive")


class ScriptedODrive:
    """Node 3: answers what is asked, with a heartbeat before each answer.

    Attributes
    ----------
    unasked : sent before the answers to the next estimates, as cyclic messages are. deaf : answers nothing.
    """

    def __init__(self, state: int = 8, error: int = 0) -> None:
        self.state, self.error = state, error
        self.unasked, self.deaf, self.position = b"", False, 1.5

    def __call__(self, data: bytes) -> bytes:
        replies = self.heartbeat() if not data else b""
        for frame in data.split(b"\r"):
            if frame == b"O" or frame.startswith(b"t067"):
                replies += self.heartbeat()
            if self.deaf or not frame.startswith(b"r"):
                continue
            replies += self.heartbeat()
            command = int(frame[1:4], 16) & 31
            if command == 0x09:
                replies += self.unasked + self.sent(0x09, struct.pack("<ff", self.position, 7.0))
            elif command in (0x03, 0x1C):
                replies += self.sent(command, struct.pack("<ff", 0.0, -0.125 if command == 0x1C else 0.0))
        return replies

    def heartbeat(self) -> bytes:
        return self.sent(0x01, struct.pack("<IBBBB", self.error, self.state, 0, 0, 0))

    @staticmethod
    def sent(command: int, body: bytes) -> bytes:
        return f"t{3 << 5 | command:03X}8{body.hex().upper()}\r".encode()


def part(port: str) -> ODrivePart:
    return ODrivePart(port, 50.0, interface="slcan", node=3)


def test_a_cycle_is_a_torque_and_two_remote_frames() -> None:
    with scripted(ScriptedODrive(), every_s=0.05) as line:
        drive = ODriveDrive(part(line.port), 0.5)
        drive._state = 8
        reading = drive.exchange(0.25)
        sent = line.came.decode()
        drive.close()
    assert sent.startswith("C\rS8\r")  # 1 Mbit/s
    # node 3 is 0x060; 0x0e sets the torque, 0x09 and 0x1c ask for estimates and torques
    assert sent.endswith("O\r" + "t06E40000803E\r" + "r0698\r" + "r07C8\r")
    assert reading == Reading(1.5, -0.125)


def test_torque_mode_is_set_before_closed_loop_control_and_the_torque_is_zero() -> None:
    with scripted(ScriptedODrive(), every_s=0.05) as line:
        drive = ODriveDrive(part(line.port), 0.5)
        before = len(line.came)
        drive.enable()
        drive.stop()
        assert drive._catch_up(1.0)  # what was sent before has arrived
        sent = [text for text in line.came[before:].decode().split("\r") if text[:1] == "t"]
        drive.close()
    zero = "t06E400000000"
    assert sent[0] == "t06B8" + "01000000" + "01000000"  # torque control, passthrough
    assert sent[1] == zero
    assert sent[2] == "t067408000000"  # closed-loop control
    assert sent[-2:] == [zero, "t067401000000"]  # idle


def test_positions_that_come_unasked_do_not_make_the_loop_lag() -> None:
    script = ScriptedODrive()
    with scripted(script, every_s=0.05) as line:
        drive = ODriveDrive(part(line.port), 0.5)
        drive._state = 8
        for number in range(20):
            script.unasked = 3 * script.sent(0x09, struct.pack("<ff", -1.0, 0.0))
            script.position = float(number)
            assert drive.exchange(0.0).position == float(number)
        drive.close()


def test_an_answer_that_comes_too_late_is_not_taken_for_the_next() -> None:
    script = ScriptedODrive()
    with scripted(script, every_s=0.05) as line:
        drive = ODriveDrive(part(line.port), 0.1)
        drive._state = 8
        script.deaf = True
        with pytest.raises(LostAnswerError):
            drive.exchange(0.0)
        script.deaf = False
        line.send(script.sent(0x09, struct.pack("<ff", -9.0, 0.0)))
        line.send(script.sent(0x1C, struct.pack("<ff", 0.0, 0.0)))
        assert drive.exchange(0.0) == Reading(1.5, -0.125)
        drive.close()


@pytest.mark.parametrize(
    ("state", "error", "text"),
    [
        (1, 0x2000, "reports motor_over_temp"),
        (1, 0x1000000, "reports watchdog_timer_expired"),
        (1, 0x40, "reports missing_input"),
        (1, 0, "is in axis state 1, not in closed-loop control"),
    ],
)
def test_an_error_or_another_state_is_one_line(state: int, error: int, text: str) -> None:
    with scripted(ScriptedODrive(state, error), every_s=0.05) as line:
        drive = ODriveDrive(part(line.port), 0.5)
        for call in (drive.enable, lambda: drive.exchange(0.1)):
            with pytest.raises(DeviceError, match=text):
                call()
        drive.close()


def test_a_silent_bus_is_one_line() -> None:
    with (
        scripted(lambda _data: b"\r") as line,
        pytest.raises(DeviceError, match=r"no heartbeat on .* in 1 s; check power, node and bit rate"),
    ):
        ODriveDrive(part(line.port), 0.5)

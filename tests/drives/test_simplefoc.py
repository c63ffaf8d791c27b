"""The text between adapter and SimpleFOC's commander, against Commander.cpp."""

from __future__ import annotations

import pytest

from fdvv.errors import DeviceError
from fdvv_drives.drive import LostAnswerError, Reading
from fdvv_drives.simplefoc_drive import SimpleFOCDrive, SimpleFOCPart
from tests.drives.conftest import need
from tests.drives.scripted import scripted


@pytest.fixture(autouse=True, scope="module")
def _library() -> None:
    need("simplefoc")


WELL = {
    "@1": "on!",
    "#5": "5",
    "MT": "foc curr",
    "MLC0.7500": "0.75000",
    "MC0": "torque",
    "M0": "0.00000",
    "ME1": "1",
    "ME": "1",
    "ME0": "0",
    "M0.25000": "0.25000",
    "MMG1": "1.00000",
    "MMG3": "0.24000",
    "MMG6": "1.57080",
}


class ScriptedBoard:
    """Answers from a table; what is not in it is not answered."""

    def __init__(self, **other: str) -> None:
        self.table = {**WELL, **other}
        self._waiting = b""

    def __call__(self, data: bytes) -> bytes:
        *lines, self._waiting = (self._waiting + data).split(b"\n")
        answers = [self.table.get(line.decode(), "") for line in lines]
        return "".join(f"{answer}\r\n" for answer in answers if answer).encode()


def part(port: str, **other: object) -> SimpleFOCPart:
    return SimpleFOCPart(port, **{"watchdog_ms": 50.0, **other})  # type: ignore[arg-type]


def test_a_cycle_is_a_target_and_two_questions() -> None:
    with scripted(ScriptedBoard()) as line:
        drive = SimpleFOCDrive(part(line.port), 0.75, 0.5)
        drive.enable()
        before = len(line.came)
        reading = drive.exchange(0.25)
        sent = line.came[before:].decode()
        drive.stop()
        drive.close()
    assert sent == "M0.25000\nMMG6\nMMG3\n"
    assert reading == Reading(1.5708, 0.24)  # angle, and current q
    assert line.came.decode().startswith("@1\n#5\nMT\nMLC0.7500\nMC0\nM0\nME1\n")


def test_a_stop_is_a_target_of_zero_and_a_disabled_motor() -> None:
    board = ScriptedBoard()
    with scripted(board) as line:
        drive = SimpleFOCDrive(part(line.port), 0.75, 0.5)
        drive.stop()
        assert not drive.has_fallen()  # a round trip: what was sent before has arrived
        drive.close()
    assert "M0\nME0\n" in line.came.decode()


def test_in_voltage_control_the_limit_and_the_report_are_voltages() -> None:
    with scripted(ScriptedBoard(MT="volt", **{"MLU0.7500": "0.75000"})) as line:
        drive = SimpleFOCDrive(part(line.port, torque="voltage"), 0.75, 0.5)
        assert drive.exchange(0.25) == Reading(1.5708, 1.0)
        drive.close()


@pytest.mark.parametrize(
    ("other", "text"),
    [
        ({"MT": "volt"}, "its torque controller is not foc_current; it answers 'volt' to MT"),
        ({"MT": ""}, "its torque controller is not foc_current; MT is not answered"),
        ({"MLC0.7500": "2.00000"}, "does not take the limit of torque"),
    ],
)
def test_a_board_that_is_set_up_otherwise_is_refused(other: dict[str, str], text: str) -> None:
    with scripted(ScriptedBoard(**other)) as line, pytest.raises(DeviceError, match=text):
        SimpleFOCDrive(part(line.port), 0.75, 0.05)


@pytest.mark.parametrize(
    ("other", "text"),
    [
        ({"MC0": "angle"}, "cannot be set to torque control; it answers 'angle' to MC0"),
        ({"ME1": "0"}, "the motor cannot be enabled"),
    ],
)
def test_a_board_in_another_mode_is_not_enabled(other: dict[str, str], text: str) -> None:
    with scripted(ScriptedBoard(**other)) as line:
        drive = SimpleFOCDrive(part(line.port), 0.75, 0.5)
        with pytest.raises(DeviceError, match=text):
            drive.enable()
        drive.close()


def test_a_motor_that_the_board_has_disabled_is_noticed_within_fifty_cycles() -> None:
    board = ScriptedBoard()
    with scripted(board) as line:
        drive = SimpleFOCDrive(part(line.port), 0.75, 0.5)
        drive.enable()
        board.table["ME"] = "0"
        for _ in range(49):
            drive.exchange(0.25)
        with pytest.raises(DeviceError, match="the board has disabled the motor"):
            drive.exchange(0.25)
        drive.close()


@pytest.mark.parametrize(
    ("command", "answer"),
    [
        ("M0.25000", "0.11000"),  # of an older command
        ("M0.25000", ""),
        ("MMG6", "nan"),
        ("MMG6", "1.5;7"),
        ("MMG6", "\x01\x02"),
        ("MMG6", ""),
        ("MMG3", "err"),
    ],
)
def test_what_is_no_answer_is_a_lost_one(command: str, answer: str) -> None:
    board = ScriptedBoard()
    with scripted(board) as line:
        drive = SimpleFOCDrive(part(line.port), 0.75, 0.05)
        board.table[command] = answer
        with pytest.raises(LostAnswerError, match="no answer"):
            drive.exchange(0.25)
        drive.close()


def test_what_an_older_command_has_left_is_passed_over() -> None:
    board = ScriptedBoard(**{"M0.25000": "0.11000\r\n9.0\r\n0.25000"})
    with scripted(board) as line:
        drive = SimpleFOCDrive(part(line.port), 0.75, 0.5)
        assert drive.exchange(0.25) == Reading(1.5708, 0.24)
        drive.close()


def test_a_drive_without_a_watchdog_says_so_in_its_name() -> None:
    with scripted(ScriptedBoard()) as line:
        drive = SimpleFOCDrive(part(line.port, watchdog_ms=0.0), 0.75, 0.5)
        assert drive.watchdog_s is None
        assert drive.name == "simplefoc M, no watchdog"
        drive.close()

"""Sessions on file and their replay."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from fdvv.device.contract import Device
from fdvv.device.recording import Recorder, ReplayDevice, read_session
from fdvv.errors import DeviceError, InputError
from fdvv.protocol.tables import Settings
from fdvv.testing.conformance import DeviceConformance, other_settings, plain_surface
from fdvv.testing.scripted import ScriptedDevice
from tests.support.link_rigs import PROGRAMS, linked


def session(path: Path) -> Path:
    """Record a surface, three presses, a program and a press."""
    with Recorder(linked(5), path) as device:
        device.upload(plain_surface(), 4.0)
        for speed in (100.0, 100.0, 50.0):
            device.press(speed)
        with pytest.raises(DeviceError):
            device.upload(plain_surface(1e6), 4.0)
        device.upload_program(PROGRAMS[1])
        device.press(100.0)
    return path


class TestReplay(DeviceConformance):
    @pytest.fixture(autouse=True)
    def _recorded(self, tmp_path: Path) -> None:
        self.path = tmp_path / "session.fdvv-session"
        with Recorder(linked(5), self.path) as device:
            device.configure(other_settings(device))
            for paced in (False, True):
                device.upload(plain_surface(), 4.0, paced)
                for speed in (100.0, 100.0):
                    device.press(speed)

    def make(self) -> Device:
        return ReplayDevice(self.path)


def test_a_replay_gives_the_same_presses_bit_by_bit(tmp_path: Path) -> None:
    replay, again = ReplayDevice(session(tmp_path / "s")), linked(5)
    for device in (replay, again):
        device.upload(plain_surface(), 4.0)
    for speed in (100.0, 100.0, 50.0):
        one, other = replay.press(speed), again.press(speed)
        for name in vars(one):
            assert np.array_equal(getattr(one, name), getattr(other, name)), name
    replay.upload_program(PROGRAMS[1])
    assert replay.press(100.0).displacement_mm.max() > 4.9


def test_a_replay_refuses_what_was_not_asked_then(tmp_path: Path) -> None:
    replay = ReplayDevice(session(tmp_path / "s"))
    with pytest.raises(DeviceError, match="this table is not in the rest"):
        replay.upload(plain_surface(41.0), 4.0)
    with pytest.raises(DeviceError, match="this table is not in the rest"):
        replay.upload(plain_surface(), 4.0, paced=True)
    replay.upload(plain_surface(), 4.0)
    with pytest.raises(DeviceError, match="asked at 100 mm/s, not at 60"):
        replay.press(60.0)
    replay.upload_program(PROGRAMS[1])
    replay.press(100.0)
    with pytest.raises(DeviceError, match="the recording ends here"):
        replay.press(100.0)
    with pytest.raises(DeviceError, match="this program is not in the rest"):
        replay.upload_program(PROGRAMS[0])


@pytest.mark.parametrize("cut", [1, 10, 1000])
def test_a_session_that_was_killed_is_read_up_to_its_last_whole_line(tmp_path: Path, cut: int) -> None:
    path = session(tmp_path / "s")
    whole = read_session(path)
    path.write_bytes(path.read_bytes()[:-cut])
    assert read_session(path) == whole[: len(whole) - (cut > 1)]


def test_a_second_session_follows_a_cut_one_and_is_the_one_that_is_read(tmp_path: Path) -> None:
    path = session(tmp_path / "s")
    path.write_bytes(path.read_bytes()[:-5])
    with Recorder(ScriptedDevice(), path) as device:
        device.upload(plain_surface(), 4.0)
        device.press(80.0)
    replay = ReplayDevice(path)
    assert replay.info().name == "scripted"
    replay.upload(plain_surface(), 4.0)
    assert replay.press(80.0).simulated


def test_a_press_is_on_the_disk_before_the_next_begins(tmp_path: Path) -> None:
    path = tmp_path / "s"
    device = Recorder(ScriptedDevice(), path)
    device.upload(plain_surface(), 4.0)
    for count in (1, 2, 3):
        device.press(80.0)
        assert sum("press" in line for line in read_session(path)) == count
    device.close()


def test_a_device_without_programs_says_so(tmp_path: Path) -> None:
    with (
        Recorder(ScriptedDevice(), tmp_path / "s") as device,
        pytest.raises(DeviceError, match="no programs"),
    ):
        device.upload_program(PROGRAMS[0])


FOREIGN = [
    b"",
    b"not a record\n",
    b'{"a": 1}\n',
    b"[1]\n",
    b"\xff\xfe",
    b'{"fdvv": "session", "format": 9}\n',
]


@pytest.mark.parametrize("content", FOREIGN)
def test_another_file_is_refused_in_one_line(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "other"
    path.write_bytes(content)
    with pytest.raises(InputError) as caught:
        ReplayDevice(path)
    assert "\n" not in str(caught.value)


def test_a_recording_without_settings_is_read_with_the_default_ones_at_its_tick(tmp_path: Path) -> None:
    path = session(tmp_path / "s")
    lines = [json.loads(line) for line in path.read_text().splitlines()]
    del lines[0]["settings"]
    path.write_text("".join(json.dumps(line) + "\n" for line in lines))
    replay = ReplayDevice(path)
    assert replay.settings() == Settings(tick_us=250)
    replay.upload(plain_surface(), 4.0)
    assert replay.press(100.0).simulated

"""Presses and planted faults over a pseudo-terminal, in real time, at each simulated far end."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fdvv.device.open import open_device
from fdvv.errors import DeviceError
from fdvv.testing.conformance import plain_surface
from fdvv_drives.device import DriveDevice
from fdvv_drives.testing.far_end import FaultKind
from fdvv_drives.testing.process import FarProcess
from fdvv_drives.testing.serve import make
from tests.drives.conftest import GENEROUS, OPEN, opened

pytestmark = pytest.mark.clock

Start = Callable[..., FarProcess]
DRIVES = ("moteus", "odrive", "simplefoc")
WATCHDOG_s = 0.6
"""Of the far ends here (conftest.GENEROUS)."""
COMMANDS = {  # torque mode and a torque, then the torque again, as a host sends them
    "moteus": ("", "can send 0001 01000a022300000d22cdcccc3d0d27cdcc4c3d5050505050 BF\n"),  # watchdog: 0.05 s
    "odrive": ("O\rt06B80100000001000000\rt067408000000\r", "t06E4CDCCCC3D\r"),
    "simplefoc": ("MC0\nME1\n", "M0.1\n"),
}
IN_PRESS = """
import sys
from fdvv.device.open import open_device
from fdvv.testing.conformance import plain_surface
device = open_device(sys.argv[1])
device.armed = lambda *_: print("armed", flush=True)
device.upload(plain_surface(), 4.0)
device.press(100.0)
"""


def pressing(far: FarProcess, kind: str) -> DriveDevice:
    device = opened(kind, far)
    device.upload(plain_surface(), 4.0)
    return device


def fails_in_press(far: FarProcess, device: DriveDevice, fault: FaultKind) -> str:
    """Plant a fault as soon as the cap is up, and return the one line in which the press ends."""
    forces_N: list[float] = []

    def plant(*_: float) -> None:
        forces_N.append(far.force_N())
        far.fault(fault)

    device.armed = plant
    with pytest.raises(DeviceError) as error:
        device.press(100.0)
    # there was a force to end
    assert forces_N[0] == pytest.approx(0.4, abs=0.05)
    assert "\n" not in str(error.value)
    return str(error.value)


def is_zero_soon(far: FarProcess, within_s: float = 2 * WATCHDOG_s) -> bool:
    until_s = time.monotonic() + within_s
    while time.monotonic() < until_s:
        if far.force_N() == 0.0:
            return True
        time.sleep(0.02)
    return False


@pytest.mark.skipif(sys.platform == "win32", reason="far ends need pseudo-terminals")
@pytest.mark.parametrize("kind", DRIVES)
def test_a_far_end_held_up_does_not_take_the_host_for_silent(kind: str) -> None:
    end = make(kind, 0.05)
    line = os.open(end.port, os.O_RDWR | os.O_NOCTTY)

    def held_up_then(command: str) -> float:
        time.sleep(0.1)
        os.write(line, command.encode())
        end.step([])
        return end.drive.torque

    try:
        begin, command = COMMANDS[kind]
        assert held_up_then(begin + command) == pytest.approx(0.1, rel=1e-3)
        assert held_up_then(command) == pytest.approx(0.1, rel=1e-3)
        assert held_up_then("") == 0.0
    finally:
        os.close(line)
        end.fault("unplug")


@pytest.mark.parametrize("kind", DRIVES)
def test_a_table_is_pressed_and_felt(start: Start, kind: str) -> None:
    far = start(kind)
    with pressing(far, kind) as device:
        assert device.info().simulated
        press = device.press(100.0)
        assert press.displacement_mm.max() > 3.9
        commanded_cN, force_cN = np.array(device.log.commanded_cN), np.array(device.log.force_cN)
        assert device.force_is_estimated == (kind != "moteus")
        if device.force_is_estimated:  # the torque of a cycle is the command of the one before
            assert np.allclose(force_cN[1:], commanded_cN[:-1], atol=0.1)
        else:  # a finger also feels friction, drag at up to 150 mm/s, and mass
            x_mm = np.array(device.log.displacement_mm)
            deep = (x_mm > 0.5) & (x_mm < 3.5)
            assert 0.0 < np.median(np.abs(force_cN - commanded_cN)[deep]) < 14.0
        assert far.force_N() == 0.0


WORDS: dict[str, dict[str, str]] = {
    "moteus": {"error": "reports fault 38", "mode": "is in mode 12"},
    "odrive": {"error": "reports motor_over_temp", "mode": "is in axis state 1"},
    "simplefoc": {"error": "the board has disabled the motor", "mode": "the board has disabled the motor"},
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", DRIVES)
@pytest.mark.parametrize("fault", ["silent", "garbage", "error", "mode", "unplug", "beyond", "jump"])
def test_a_fault_in_mid_press_ends_in_one_line_and_zero_torque(
    start: Start, kind: str, fault: FaultKind
) -> None:
    far = start(kind)
    if fault == "jump":  # of 4 mm; a cycle of a busy machine may take 10 ms
        limits = "[limits]\nvelocity_mm_s = 150.0"
        far.stage.write_text(far.stage.read_text().replace("[limits]", limits))
    with pressing(far, kind) as device:
        text = fails_in_press(far, device, fault)
        assert is_zero_soon(far)
    expected = {
        "silent": "no answer",
        "garbage": "" if kind == "odrive" else "no answer",
        "unplug": "the line broke",
        "beyond": "fell to zero force, position_",
        "jump": "fell to zero force, position_jump",
        **WORDS[kind],
    }
    assert expected[fault] in text


@pytest.mark.slow
@pytest.mark.parametrize("kind", DRIVES)
def test_a_host_that_is_killed_leaves_a_drive_that_falls_to_zero(start: Start, kind: str) -> None:
    far = start(kind)
    command = [sys.executable, "-c", IN_PRESS, f"{kind}:{far.stage}"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as host:
        assert host.stdout is not None
        assert host.stdout.readline() == "armed\n"
        assert far.force_N() == pytest.approx(0.4, abs=0.05)
        os.kill(host.pid, signal.SIGKILL)
        killed_s = time.monotonic()
        assert is_zero_soon(far)
        # not before the watchdog: nothing else can have ended it
        assert time.monotonic() - killed_s > 0.5 * WATCHDOG_s


@pytest.mark.slow
@pytest.mark.parametrize("kind", DRIVES)
def test_ctrl_c_stops_the_drive_before_its_watchdog_does(start: Start, kind: str) -> None:
    far = start(kind)
    command = [sys.executable, "-c", IN_PRESS, f"{kind}:{far.stage}"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as host:
        assert host.stdout is not None
        assert host.stdout.readline() == "armed\n"
        host.send_signal(signal.SIGINT)
        host.wait(10)
        assert far.force_N() == 0.0


@pytest.mark.slow
@pytest.mark.parametrize("kind", DRIVES)
def test_answers_that_come_late_once_do_not_make_the_loop_lag(start: Start, kind: str) -> None:
    far = start(kind, "--answer-ms", "30", "--late-ms", "900", "--watchdog-ms", "300")
    with pressing(far, kind) as device:
        drive: Any = device.drive
        drive.enable()
        far.fault("delay")
        with pytest.raises(DeviceError, match="no answer"):
            drive.exchange(1e-4)
        far.fault("")
        time.sleep(0.05)
        for torque in (2e-4, 3e-4, 4e-4):
            # the report is that of this command, not of one before
            assert drive.exchange(torque).torque == pytest.approx(torque, abs=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["odrive", "simplefoc"])
def test_a_drive_whose_watchdog_is_off_is_refused(start: Start, kind: str) -> None:
    far = start(kind)
    far.ask(watchdog=None)
    with pytest.raises(DeviceError, match="its watchdog does not end the torque after 600 ms"):
        OPEN[kind](str(far.stage))
    assert far.force_N() == 0.0


@pytest.mark.slow
def test_a_board_without_a_watchdog_keeps_its_torque_when_the_line_breaks(start: Start) -> None:
    far = start("simplefoc")
    far.ask(watchdog=None)
    text = far.stage.read_text()
    far.stage.write_text(text.replace("watchdog_ms = 600.0", "watchdog_ms = 0.0"))
    with pressing(far, "simplefoc") as device:
        assert device.info().name.endswith("no watchdog")
        fails_in_press(far, device, "unplug")
    assert not is_zero_soon(far)


@pytest.mark.slow
@pytest.mark.parametrize("kind", DRIVES)
def test_the_command_presses_a_button_and_records_it(start: Start, kind: str, tmp_path: Path) -> None:
    far = start(kind, *GENEROUS, "--press-every", "1.5")
    command = [sys.executable, "-m", "fdvv", "device", "press", "mx-clear", "--presses", "2"]
    session = tmp_path / "session.jsonl"
    ran = subprocess.run(
        [*command, "--device", f"{kind}:{far.stage}", "--record", str(session), "--json"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (ran.returncode, ran.stderr) == (0, "")
    found = json.loads(ran.stdout)
    assert found["simulated"]
    assert [press["deepest_mm"] > 3.9 for press in found["presses"]] == [True, True]
    replay = open_device(f"replay:{session}")
    assert replay.info().name == found["device"]
    assert far.force_N() == 0.0

"""Sessions as a person runs them: killed, interrupted, out of disk, in the wrong folder, two at once."""

import json
import os
import re
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from fdvv.device.boards import LibraryBoard
from fdvv.device.linked import LockstepPort
from fdvv.device.plant import Inputs
from fdvv.device.remote import PressedDevice
from fdvv.errors import DeviceError
from fdvv.model.press import Press
from fdvv.protocol.messages import CN64_PER_cN
from fdvv.protocol.tables import Settings
from fdvv.rendering.session_log import PRESSES, PressLog
from fdvv.testing.scripted import ScriptedDevice
from tests.cli._terminal import run_on_terminal
from tests.support.command_line import Run
from tests.support.scripted_person import ScriptedPlant

PAPER = ("--method", "paper")
SERIAL = ("--device", "serial:/dev/rig", *PAPER)
VOLTAGE = ("--rig", "voltage")
SHORT = ("--velocity", "50", "--velocity", "100", "--rounds", "1", "--presses", "4", *PAPER)
LONG = ("--velocity", "50", "--velocity", "200", "--rounds", "2", "--presses", "12", *PAPER)
FDVV = (sys.executable, "-m", "fdvv")


def started(*arguments: str, folder: Path, **settings: object) -> subprocess.Popen[str]:
    command = [*FDVV, *arguments]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    return subprocess.Popen(command, cwd=folder, **{**pipes, **settings})  # type: ignore[call-overload, no-any-return]


def wait_for(presses: int, path: Path) -> None:
    until_s = time.monotonic() + 30
    while time.monotonic() < until_s:
        if path.exists() and path.read_bytes().count(b"\n") > presses:
            return
        time.sleep(0.01)
    raise AssertionError(f"no {presses} presses in {path}")


HOWS = [signal.SIGKILL, pytest.param(signal.SIGINT, marks=pytest.mark.slow)]


@pytest.mark.parametrize("how", HOWS, ids=["kill -9", "Ctrl-C"])
def test_a_session_that_was_stopped_loses_no_press_and_ends_in_a_valid_result(
    fdvv: Run, tmp_path: Path, how: signal.Signals
) -> None:
    learn = ("compensate", "mx-clear", *LONG, "--session", "s", "-o", "a.actuation.json")
    path = tmp_path / "s" / PRESSES
    running = started(*learn, folder=tmp_path)
    wait_for(5, path)
    running.send_signal(how)
    _, stderr = running.communicate(timeout=20)
    kept = path.read_bytes()
    _, before, end = PressLog.read(path)
    assert 5 <= len(before) < 48
    if how is signal.SIGINT:
        assert running.returncode == 130
        last = stderr.splitlines()[-1]
        kept_in = f"{len(before)} presses are kept in s; run the same command again to go on"
        assert last == f"fdvv: interrupted; {kept_in}"
    assert not (tmp_path / "a.actuation.json").exists()

    going_on = fdvv(*learn)
    assert going_on.status == 0, going_on.err
    assert f"the session in s, with {len(before)} of 48 presses, goes on" in going_on.err
    # what was kept is there still, byte for byte
    assert path.read_bytes().startswith(kept[:end])
    receipt = json.loads((tmp_path / "a.actuation.json").read_text())["receipt"]
    assert receipt["used"] == 48
    assert receipt["runs"][0]["seed"] != receipt["runs"][1]["seed"]


def test_ctrl_c_ends_in_one_line_that_says_how_to_go_on(fdvv: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    class Stopped(ScriptedDevice):
        """Presses Ctrl-C at the third press, in the first run."""

        left = 3

        def press(self, velocity_mm_s: float) -> Press:
            Stopped.left -= 1
            if Stopped.left == 0:
                raise KeyboardInterrupt
            return super().press(velocity_mm_s)

    monkeypatch.setattr("fdvv.rendering.session.open_device", lambda *_: Stopped())
    ran = fdvv("compensate", "mx-clear", *SHORT, "--session", "s", "--json")
    message = "fdvv: interrupted; 2 presses are kept in s; run the same command again to go on\n"
    assert (ran.status, ran.err) == (130, message)
    assert ran.json["error"]["status"] == 130
    shown = fdvv("show", "s").out.splitlines()
    assert shown[-2:] == ["2 presses used, 0 not", "not finished; run the session's command again to go on"]
    ran = fdvv("probe", "mx-clear", *SHORT[:4], "--session", "p", "--presses", "2")
    assert ran.status == 0
    Stopped.left = 2
    lost = fdvv("probe", "mx-clear", *SHORT[:4], "--presses", "2")
    assert lost.err.endswith(
        "fdvv: interrupted; 1 press is lost; name a folder with --session to keep them\n"
    )


def test_a_session_killed_before_its_first_run_can_be_shown(fdvv: Run, tmp_path: Path) -> None:
    fdvv("compensate", "mx-clear", *SHORT, "--session", "s")
    (tmp_path / "s" / "receipt.json").unlink()
    (tmp_path / "s" / PRESSES).write_bytes(b"")
    shown = fdvv("show", "s")
    assert (shown.status, shown.out.splitlines()[-2]) == (0, "0 presses used, 0 not")


def test_a_full_disk_is_reported_in_one_line_and_the_session_goes_on_once_there_is_room(
    fdvv: Run, tmp_path: Path
) -> None:
    limit = 400_000
    learn = ("compensate", "mx-clear", *SHORT, "--session", "s")

    def small_disk() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    full = started(*learn, folder=tmp_path, preexec_fn=small_disk)
    _, stderr = full.communicate(timeout=30)
    assert full.returncode == 2
    assert stderr.splitlines()[-1].startswith("fdvv: s/presses.jsonl: File too large")
    _, before, end = PressLog.read(tmp_path / "s" / PRESSES)
    assert end == (tmp_path / "s" / PRESSES).stat().st_size <= limit
    assert 0 < len(before) < 8
    again = fdvv(*learn)
    assert (again.status, "goes on" in again.err) == (0, True)
    assert len(PressLog.read(tmp_path / "s" / PRESSES)[1]) == 8


def test_on_a_terminal_the_rows_are_redrawn_in_place(tmp_path: Path) -> None:
    out, shown = run_on_terminal("compensate", "mx-clear", *SHORT, "-v", folder=tmp_path)
    assert "mx-clear on twin (simulated), 8 presses" in out
    assert "best mean" in shown
    assert re.search(r"\x1b\[1A", shown), "nothing was redrawn"


def test_the_same_command_again_gives_the_result_again_and_says_so(fdvv: Run) -> None:
    first = fdvv("compensate", "mx-clear", *SHORT, "--session", "s")
    again = fdvv("compensate", "mx-clear", *SHORT, "--session", "s")
    assert (first.status, again.status) == (0, 0)
    assert again.out == first.out
    assert again.err == (
        "the session in s, with 8 of 8 presses, is finished; "
        "this is its result again, name another folder for a new one\n"
    )


def test_when_json_is_printed_nothing_else_is(fdvv: Run) -> None:
    for _ in range(2):
        ran = fdvv("compensate", "mx-clear", *SHORT, "--session", "s", "--json")
        assert (ran.status, ran.err) == (0, "")
        assert ran.json["receipt"]["used"] == 8


def test_the_folder_of_another_button_is_refused_in_one_line(fdvv: Run) -> None:
    fdvv("compensate", "mx-clear", *SHORT, "--session", "s")
    other = fdvv("compensate", "mx-red", *SHORT, "--session", "s")
    assert other.status == 2
    assert other.err == (
        'fdvv: s: session: is another session: model.name is "mx-clear" there and "mx-red" now (and 1 more); '
        "repeat its options, or name another folder\n"
    )


def test_two_processes_cannot_work_on_one_session(fdvv: Run, tmp_path: Path) -> None:
    fdvv("compensate", "mx-clear", *SHORT, "--session", "s")
    log = PressLog(tmp_path / "s")
    second = fdvv("compensate", "mx-clear", *SHORT, "--session", "s")
    log.close()
    assert second.status == 2
    assert second.err.startswith("fdvv: s: session: another process is at work on this session; wait for it")
    assert second.err.count("\n") == 1


def test_a_folder_that_cannot_be_made_is_refused_before_any_press(fdvv: Run, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    ran = fdvv("compensate", "mx-clear", *SHORT, "--session", "file/s")
    assert ran.status == 2
    assert (
        ran.err == f"fdvv: {tmp_path / 'file'}: output: is a file, a folder is needed; name another place\n"
    )


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_that_cannot_be_written_is_refused_before_any_press(fdvv: Run, tmp_path: Path) -> None:
    (tmp_path / "locked").mkdir(mode=0o500)
    ran = fdvv("compensate", "mx-clear", *SHORT, "--session", "locked/s")
    assert (ran.status, "may not be written to" in ran.err) == (2, True)


def test_a_probe_keeps_its_presses_and_shows_its_receipt(fdvv: Run, tmp_path: Path) -> None:
    probe = ("probe", "mx-clear", *VOLTAGE, "--velocity", "50", "--presses", "3", "--session", "p")
    first = fdvv(*probe)
    assert first.status == 0
    # as many again with the button's vibration
    assert len(PressLog.read(tmp_path / "p" / PRESSES)[1]) == 6
    assert fdvv(*probe).out == first.out
    shown = fdvv("show", "p")
    assert shown.status == 0
    assert "probe mx-clear on twin (simulated)" in shown.out
    assert "6 presses used, 0 not" in shown.out


def test_show_tells_the_receipt_of_an_actuation(fdvv: Run) -> None:
    fdvv("compensate", "mx-clear", *SHORT, "-o", "a.actuation.json")
    shown = fdvv("show", "a.actuation.json")
    assert shown.status == 0
    assert "compensate mx-clear on twin (simulated)" in shown.out
    assert "8 presses used, 0 not" in shown.out
    assert fdvv("show", "a.actuation.json", "--json").json["settings"]["law"]["rounds"] == 1


def test_a_tight_speed_tolerance_is_reported_with_its_remedy(fdvv: Run) -> None:
    ran = fdvv("compensate", "mx-clear", *SHORT, "--pace-tolerance", "0.05", "--session", "s")
    assert re.search(r"not used, \d+ mm/s instead of \d+: press (slower|faster)", ran.err)


def test_the_board_as_a_program_goes_on_where_it_stopped(fdvv: Run, tmp_path: Path) -> None:
    (tmp_path / "rig.toml").write_text('[keycap_sensor]\nkind = "force"\n')
    learn = ("compensate", "mx-clear", *SHORT, "--device", "host", "--rig", "rig.toml", "--session", "s")
    whole = fdvv(*learn, "--json")
    assert (whole.status, whole.err) == (0, "")
    path = tmp_path / "s" / PRESSES
    lines = path.read_bytes().splitlines(keepends=True)
    # as if it had been killed in its sixth press; the first records are the run's begin and the rig's check
    path.write_bytes(b"".join(lines[:7]) + lines[7][:100])
    gone_on = fdvv(*learn, "--json")
    assert gone_on.status == 0
    warning = "the last record is not whole and is left out; presses kept: 5"
    assert gone_on.err == f"warning: s/{PRESSES}: {warning}\n"
    receipt = fdvv("show", "s", "--json").json
    assert (receipt["used"], len(receipt["runs"])) == (8, 2)
    assert receipt["device"]["settings"]["force_gain_q14"] > 0
    other = fdvv(*learn[:-4], "--session", "s", "--device", "twin")
    assert "device." in other.err


FELT = Settings(force_gain_q14=80_000, force_offset_counts=2048)
STOP_cN = 80.0


def pressed_again_and_again() -> PressedDevice:
    """Open a board whose cap goes down and up at 100 mm/s every 0.3 s, felt by a force sensor."""
    corners_s = np.cumsum([0.0, 0.3, 0.04, 0.02, 0.04])
    t_s = np.arange(round(corners_s[-1] / (FELT.tick_us * 1e-6))) * FELT.tick_us * 1e-6
    path = np.tile(np.interp(t_s, corners_s, [0.0, 0.0, 4.0, 4.0, 0.0]), 60)

    def felt(tick: int, inputs: Inputs) -> Inputs:
        depth_mm = path[min(tick, path.size - 1)]
        force_cN = plant._rendered_cN[-1] + STOP_cN * (depth_mm > 3.99) if depth_mm > 0.02 else 0.0
        counts = max(0.0, force_cN) * CN64_PER_cN / (FELT.force_gain_q14 / 2**14)
        return inputs._replace(force_counts=round(2048 + counts + tick % 3))

    plant = ScriptedPlant(path, 100.0, FELT, np.random.default_rng(0), meddle=felt)
    device = PressedDevice(LockstepPort(LibraryBoard(), plant, FELT.tick_us))
    device.configure(FELT)
    return device


def test_a_person_is_asked_and_answered_press_by_press_and_nothing_of_it_is_lost(
    fdvv: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened = list[PressedDevice]()

    def open_device(*_: object) -> PressedDevice:
        opened.append(pressed_again_and_again())
        return opened[-1]

    monkeypatch.setattr("fdvv.rendering.session.open_device", open_device)
    ask = ("compensate", "mx-clear", "--velocity", "100", "--rounds", "1", *SERIAL)
    ran = fdvv(*ask, "--presses", "3", "--json")
    assert ran.status == 0
    check, *lines = ran.err.splitlines()
    assert check == "press 1 of 1: 50 mm/s, 4.0 mm in 80 ms, down to the stop and let go"
    assert len(lines) == 6
    assert lines[0] == "press 1 of 3: 100 mm/s, 4.0 mm in 40 ms, down to the stop and let go"
    assert re.match(r"1 of 3, 100 mm/s: achieved (9\d|10\d) mm/s; moved the press by up to", lines[1])
    # without a name the presses are kept beside
    assert len(PressLog.read(tmp_path / "mx-clear.session" / PRESSES)[1]) == 3
    assert ran.json["receipt"]["device"]["settings"]["force_gain_q14"] == FELT.force_gain_q14
    # another speed than the cap's is not used, ten times, and the session says how to go on
    slow = fdvv(*ask[:3], "40", *ask[4:], "--session", "slow")
    assert slow.status == 1
    assert "instead of 40: press slower; 0 presses are kept in slow; run the same command again" in slow.err
    # the device was let go each time
    with pytest.raises(DeviceError, match="the line is closed"):
        opened[-1].press(100.0)

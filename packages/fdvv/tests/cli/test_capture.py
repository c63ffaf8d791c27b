"""fdvv capture as a person runs it: in a pipe, on a terminal, stopped, killed, with a wrong file."""

from __future__ import annotations

import io
import json
import random
import re
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console
from rich.live import Live

from fdvv.bench.capture import TakeDone, TakeRequest, VelocityProgress
from fdvv.bench.plan import COUNT_IN_s, Step
from fdvv.bench.plan import DWELL_s as TOLD_DWELL_s
from fdvv.bench.take_check import TakeCheck
from fdvv.cli.bench.capture import CaptureTable, beeps, frame
from fdvv.cli.cue import BEATS, BEAT_s, DWELL_s, TONES_Hz, beeper, tone
from fdvv.device.bench import SerialBench
from fdvv.errors import InputError
from fdvv.model.file import load_model
from fdvv.recording.file import load_recording
from fdvv.recording.types import Recording, Stage, Take
from tests.cli._terminal import run_on_terminal
from tests.support.campaign import campaign
from tests.support.command_line import Run
from tests.support.scripted_bench import PressedBoard

FILE = "x.recording.jsonl"
SMALL = ("capture", FILE, "--paces", "50,100", "--presses", "2")
FDVV = (sys.executable, "-m", "fdvv")


def same(a: Recording, b: Recording, takes: int | None = None) -> bool:
    """Return whether the first takes of two recordings are equal to the bit."""
    pairs = list(zip(a.takes[:takes], b.takes[:takes], strict=True))
    return all(
        x.marks == y.marks
        and all(
            np.array_equal(s.t_s, t.t_s) and np.array_equal(s.raw, t.raw, equal_nan=True)
            for s, t in zip(x.streams, y.streams, strict=True)
        )
        for x, y in pairs
    )


def test_on_the_twin_the_session_runs_by_itself_and_tells_of_every_take(fdvv: Run, tmp_path: Path) -> None:
    ran = fdvv(*SMALL, "--participant", "steady")
    assert ran.status == 0
    lines = ran.err.splitlines()
    assert lines[0] == "take 1, 1 of 6, bench at rest: good"
    assert re.fullmatch(r"take 2, 2 of 6, slow probe: good, 4\.0\d mm|.* 3\.9\d mm", lines[1])
    assert re.fullmatch(r"take 3, 3 of 6, 50 mm/s: good, \d\d mm/s, 4\.\d\d mm", lines[2])
    shown = ran.out.splitlines()
    assert shown[0] == f"mx-clear on twin (simulated), {len(lines)} takes"
    assert [line.split()[0] for line in shown[1:4]] == ["pace", "50", "100"]
    assert shown[-1] == f"recorded in {FILE}"
    found = load_recording(tmp_path / FILE)
    assert found.simulated
    assert len(found.takes) == len(lines)


def test_a_bad_press_is_reported_with_its_remedy_and_requested_again(fdvv: Run) -> None:
    ran = fdvv("capture", FILE, "--paces", "100", "--presses", "12", "--participant", "clumsy", "--no-probe")
    bad = [line for line in ran.err.splitlines() if "good" not in line]
    assert bad
    assert all(";" in line for line in bad)
    assert "12  12" in ran.out


def test_only_a_document_is_printed_where_it_is_asked_for(fdvv: Run) -> None:
    ran = fdvv(*SMALL, "--json", "--seed", "3", "--shuffle", "--button", "mx-brown")
    assert ran.err == ""
    document = ran.json
    assert (document["button"], document["simulated"], document["device"]) == ("mx-brown", True, "twin")
    assert [pace["good"] + pace["missed"] for pace in document["paces"]] == [2, 2]
    assert document["takes"] == sum(pace["takes"] for pace in document["paces"]) + 2


def test_a_model_is_made_of_the_recording_where_one_is_asked_for(fdvv: Run, tmp_path: Path) -> None:
    session = ("capture", FILE, "--paces", "100,200", "--presses", "4", "--participant", "steady")
    ran = fdvv(*session, "-o", "x.fdvv.json")
    assert ran.status == 0, ran.err
    assert ran.out.splitlines()[-2:] == [f"recorded in {FILE}", "written to x.fdvv.json"]
    model = load_model(tmp_path / "x.fdvv.json")
    assert model.travel_mm == pytest.approx(4.0, abs=0.03)
    assert model.provenance.simulated
    assert fdvv(*session, "-o", "x.fdvv.json", "--json").json["model"] == "x.fdvv.json"
    refused = fdvv(*session, "-o", "x.csv")
    assert (refused.status, refused.err.count("\n")) == (2, 1)


def test_a_finished_recording_is_not_written_to_again(fdvv: Run, tmp_path: Path) -> None:
    first = fdvv(*SMALL)
    size = (tmp_path / FILE).stat().st_size
    again = fdvv(*SMALL)
    assert (again.status, again.out) == (0, first.out)
    assert again.err == f"{FILE}, with 6 of 6 steps, is finished; name another file for a new one\n"
    assert (tmp_path / FILE).stat().st_size == size


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("x.json",), "x.json: output: its name has another ending than what is written; end it in .record"),
        (("x.csv",), "end it in .recording.jsonl"),
        ((FILE, "--paces", "50,fast"), "numbers with commas between them"),
        ((FILE, "--paces", "50,50"), "must differ, got 50.0"),
        ((FILE, "--paces", "5"), "must be 20 to 500 mm/s, got 5.0"),
        ((FILE, "--paces", ""), "numbers with commas between them"),
        ((FILE, "--device", "rig"), "--device: rig: names no capture bench; use one of twin"),
        ((FILE, "--button", "no-such"), "no-such"),
        ((FILE, "--participant", "sleepy"), "sleepy"),
        (("nowhere.recording.jsonl/x.recording.jsonl", "--presses", "0"), "0 is not in the range"),
    ],
)
def test_a_mistake_is_reported_in_one_line(
    fdvv: Run, tmp_path: Path, arguments: tuple[str, ...], message: str
) -> None:
    ran = fdvv("capture", *arguments)
    assert (ran.status, ran.out) == (2, "")
    assert message in ran.err
    assert ran.err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_a_file_of_another_button_or_seed_or_a_damaged_one_is_refused(fdvv: Run, tmp_path: Path) -> None:
    fdvv(*SMALL)
    before = (tmp_path / FILE).read_bytes()
    for other in (("--seed", "5"), ("--button", "mx-red")):
        ran = fdvv(*SMALL, *other)
        assert ran.status == 2
        assert "is another recording" in ran.err
    assert (tmp_path / FILE).read_bytes() == before
    lines = before.split(b"\n")
    lines[2] = lines[2].replace(b"force", b"farce")
    (tmp_path / FILE).write_bytes(b"\n".join(lines))
    ran = fdvv(*SMALL)
    assert (ran.status, ran.err.count("\n")) == (2, 1)
    assert "line 3: the record is damaged" in ran.err


def test_on_a_terminal_rows_and_bad_presses_are_shown(tmp_path: Path) -> None:
    clumsy = ("--paces", "100", "--presses", "8", "--participant", "clumsy", "--seed", "11")
    out, shown = run_on_terminal("capture", FILE, *clumsy, folder=tmp_path)
    assert "100 mm/s     8   8" in out
    assert "median mm/s" in shown
    assert "; press" in shown


# -- the cue --

ASK = TakeRequest(Step(Stage.PRESS, 50.0), 3, 62, 4.0)


def test_the_shown_cue_keeps_the_times_that_the_marks_tell() -> None:
    assert BEAT_s * len(BEATS) == COUNT_IN_s
    assert DWELL_s == TOLD_DWELL_s
    assert frame(ASK, 0.0).startswith("3  ·")
    assert frame(ASK, 1.49).startswith("1  ·")
    assert "·" in frame(ASK, COUNT_IN_s + 0.05)
    assert "·" not in frame(ASK, COUNT_IN_s + 0.08 + DWELL_s / 2)
    assert frame(TakeRequest(Step(Stage.REST), 1, 62, 4.0), 0.5) == "hands off"


def test_it_beeps_once_at_contact_and_once_at_the_bottom() -> None:
    heard = list[tuple[float, str]]()
    now = [0.0]
    show = beeps(ASK, lambda event: heard.append((now[0], event)))
    for tick in range(500):
        now[0] = 0.004 * tick
        show(now[0])
    assert [event for _, event in heard] == list(TONES_Hz)
    assert [t for t, _ in heard] == pytest.approx([1.5, 1.58], abs=0.004)


def test_on_a_terminal_the_bar_goes_down_and_up_and_the_last_press_stays_in_sight() -> None:
    screen, heard = io.StringIO(), list[str]()
    console = Console(file=screen, force_terminal=True, width=100, color_system=None)
    with Live(console=console, auto_refresh=False) as live:
        view = CaptureTable(True, live, heard.append)
        show = view.cue(ASK)
        for tick in range(500):
            show(0.004 * tick)
        take = Take(3, (), (), Stage.PRESS, 50.0)
        bad, pace = TakeCheck(False, reason="too slow; press faster"), VelocityProgress(50.0, 0, 15, 1, 0)
        view.done(TakeDone(take, bad, 2, 62, False, (pace,)))
        view.notice("x.recording.jsonl goes on")
    shown = screen.getvalue()
    assert heard == list(TONES_Hz)
    depths = [line.count("█") for line in shown.splitlines() if "·" in line or "█" in line]
    assert max(depths) == 40
    assert depths.index(max(depths)) > 10
    assert "take 3, 2 of 62, 50 mm/s: too slow; press faster" in shown
    assert "50 mm/s     0  15      1" in shown
    assert "goes on" in shown


def test_a_player_is_given_a_sound_file_for_each_beep(tmp_path: Path) -> None:
    copied = tmp_path / "heard.wav"
    script = tmp_path / "player"
    script.write_text(f'#!/bin/sh\ncat "$1" >> {copied}\n')
    script.chmod(0o755)
    with beeper(str(script), lambda: None) as beep:
        beep("cue contact")
    assert copied.read_bytes() == tone(880.0)
    assert tone(880.0)[:4] == b"RIFF"
    with pytest.raises(InputError, match="cannot be started"), beeper("no-such-player", lambda: None) as beep:
        beep("cue contact")


# -- stopped and killed --

LONG = ("capture", FILE, "--paces", "100,200", "--presses", "30", "--seed", "11", "--participant", "clumsy")
TAKE_LINE = re.compile(r"^take (\d+),", re.MULTILINE)


def test_ctrl_c_ends_in_one_line_that_says_how_to_go_on(fdvv: Run, tmp_path: Path) -> None:
    with subprocess.Popen([*FDVV, *LONG], cwd=tmp_path, stderr=subprocess.PIPE, text=True) as running:
        assert running.stderr is not None
        for _ in range(2):
            running.stderr.readline()
        running.send_signal(signal.SIGINT)
        last = running.stderr.read().splitlines()[-1]
    assert running.returncode == 130
    kept = len(load_recording(tmp_path / FILE).takes)
    assert kept >= 2
    assert last == f"fdvv: interrupted; {kept} takes are kept in {FILE}; run the same command again to go on"
    again = fdvv(*LONG)
    assert again.status == 0
    assert f"{FILE}, with " in again.err.splitlines()[0]
    assert "goes on" in again.err.splitlines()[0]


def test_a_full_disk_is_reported_in_one_line_and_the_session_goes_on_once_there_is_room(
    fdvv: Run, tmp_path: Path
) -> None:
    limit = 200_000

    def small_disk() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    command = [*FDVV, *LONG]
    full = subprocess.run(command, cwd=tmp_path, preexec_fn=small_disk, stderr=subprocess.PIPE, text=True)
    lines = full.stderr.splitlines()
    assert full.returncode == 2
    assert lines[-1].startswith(f"fdvv: {FILE}: File too large")
    kept = load_recording(tmp_path / FILE)
    assert kept.warnings == ()
    assert len(kept.takes) == len(lines) - 1 > 3
    assert fdvv(*LONG).status == 0


def killed(folder: Path, draw: random.Random) -> tuple[int, bool]:
    """Run the command and kill it at random; return the last take it reported, and if it had ended."""
    silent = subprocess.DEVNULL
    with subprocess.Popen(
        [*FDVV, *LONG], cwd=folder, stdout=silent, stderr=subprocess.PIPE, text=True
    ) as running:
        assert running.stderr is not None
        # one in five while it starts, the others while it records
        first_line = "" if draw.random() < 0.2 else running.stderr.readline()
        time.sleep(draw.uniform(0.0, 0.25))
        running.kill()
        numbers = TAKE_LINE.findall(first_line + running.stderr.read())
    return int(numbers[-1]) if numbers else 0, running.returncode == 0


def takes_in(path: Path) -> Recording:
    """Read what a killed process left; nothing if it was killed before the first record was whole."""
    if path.exists() and b"\n" in path.read_bytes():
        return load_recording(path)
    return Recording("nothing")


@campaign("seed", range(100), part=1)
def test_a_capture_killed_at_any_moment_loses_no_take_and_goes_on_to_the_same_recording(
    fdvv: Run, tmp_path: Path, seed: int
) -> None:
    draw = random.Random(seed)
    assert fdvv(*LONG).status == 0
    whole = load_recording(tmp_path / FILE)
    left, folder = 2, tmp_path
    while left:
        folder = tmp_path / str(left)
        folder.mkdir()
        ended = False
        while left and not ended:
            reported, ended = killed(folder, draw)
            left -= not ended
            found = takes_in(folder / FILE)
            assert reported <= len(found.takes) <= len(whole.takes)
            assert same(found, whole, len(found.takes))
        last = subprocess.run(
            [*FDVV, *LONG, "--json"], cwd=folder, capture_output=True, text=True, check=True
        )
        assert json.loads(last.stdout)["takes"] == len(whole.takes)
        assert same(load_recording(folder / FILE), whole)


# -- a person at a bench --

AT_BENCH = ("capture", FILE, "--device", "serial:/dev/bench", "--button", "door bell", "--paces", "100")


def at(board: PressedBoard, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fdvv.device.bench.open_bench", lambda *_: SerialBench(board))


def test_a_person_at_a_bench_is_prompted_informed_and_prompted_again(
    fdvv: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    at(PressedBoard([0.0, 0.5, 100.0, 50.0, 110.0]), monkeypatch)
    ran = fdvv(*AT_BENCH, "--presses", "2")
    assert ran.status == 0, ran.err
    assert ran.err.splitlines() == [
        "1 of 4: take the finger off the button and wait",
        "take 1, 1 of 4, bench at rest: good",
        "2 of 4: press, 0.5 mm/s, 4.0 mm in 8 s, slowly, down to the stop and let go as slowly",
        "take 2, 2 of 4, slow probe: good, 4.00 mm",
        "3 of 4: press, 100 mm/s, 4.0 mm in 40 ms, down to the stop and let go",
        "take 3, 3 of 4, 100 mm/s: good, 100 mm/s, 4.00 mm",
        "4 of 4: press, 100 mm/s, 4.0 mm in 40 ms, down to the stop and let go",
        "take 4, 3 of 4, 100 mm/s: too slow, 50 instead of 100 mm/s; press faster",
        "4 of 4: press once more, 100 mm/s, 4.0 mm in 40 ms, down to the stop and let go",
        "take 5, 4 of 4, 100 mm/s: good, 110 mm/s, 4.00 mm",
    ]
    assert ran.out.splitlines()[0] == "door bell on /dev/bench, 5 takes"
    found = load_recording(tmp_path / FILE)
    assert not found.simulated
    assert found.bench.tip_mass_g == 2.0
    assert all(take.made for take in found.takes)


def test_a_bench_that_is_unplugged_ends_the_session_in_one_line_and_it_goes_on_later(
    fdvv: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    board = PressedBoard([0.0, 100.0, 100.0])
    board.gone_s = 7.0
    at(board, monkeypatch)
    ran = fdvv(*AT_BENCH, "--presses", "3", "--no-probe")
    last = ran.err.splitlines()[-1]
    assert ran.status == 1
    assert last == (
        "fdvv: /dev/bench: the device is gone (EIO); plug it in again; 2 takes are kept in "
        f"{FILE}; run the same command again to go on"
    )
    assert not board.open
    at(PressedBoard([100.0, 100.0]), monkeypatch)
    again = fdvv(*AT_BENCH, "--presses", "3", "--no-probe")
    assert again.status == 0
    assert "goes on" in again.err
    takes = load_recording(tmp_path / FILE).takes
    assert [take.streams[0].clock for take in takes] == ["board"] * 2 + ["board from take 3"] * 2

"""The table of commands, help, and the process itself: pipes, terminals, interruptions, kills."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import click
import pytest

from fdvv.cli.main import GROUPS, cli, command_helps
from fdvv.model.file import load_model
from tests.cli._terminal import run_on_terminal
from tests.support.command_line import Run, tactile_csv

HELPS = command_helps()
FDVV = (sys.executable, "-m", "fdvv")


@pytest.fixture
def many(tmp_path: Path) -> Path:
    """Return a folder that takes a while to fit."""
    below = tmp_path / "many"
    below.mkdir()
    text = tactile_csv(below / "00.csv").read_text()
    for i in range(1, 40):
        (below / f"{i:02}.csv").write_text(text)
    return below


def wait_until_started(process: subprocess.Popen[bytes], sign: Path) -> None:
    """Wait until a running command has done its first work."""
    for _ in range(400):
        if sign.exists() or process.poll() is not None:
            break
        time.sleep(0.05)
    assert process.poll() is None, "the command ended before it could be disturbed"


@pytest.mark.parametrize("name", HELPS)
def test_every_command_has_help_that_exits_0(fdvv: Run, name: str) -> None:
    ran = fdvv(name, "--help")
    assert (ran.status, ran.err) == (0, "")
    assert ran.out.startswith(f"Usage: fdvv {name} ")


@pytest.mark.parametrize("name", HELPS)
def test_the_line_in_the_table_is_the_first_of_the_commands_own_help(name: str) -> None:
    command = cli.get_command(click.Context(cli), name)
    assert command is not None
    assert (command.help or "").split("\n\n")[0].replace("\n", " ").strip() == HELPS[name]


def test_help_lists_every_command_in_one_group() -> None:
    listed = [name for names in GROUPS.values() for name in names]
    assert len(set(listed)) == len(listed)
    assert HELPS.keys() - set(listed) <= {"hardware", "mechanism"}
    assert len(GROUPS["Every day"]) == 10


@pytest.mark.parametrize("name", HELPS)
def test_every_option_has_a_help_text(name: str) -> None:
    command = cli.get_command(click.Context(cli), name)
    assert command is not None
    assert [p.name for p in command.params if isinstance(p, click.Option) and not p.help] == []


def test_the_command_alone_prints_help_and_exits_2(fdvv: Run) -> None:
    ran = fdvv()
    assert (ran.status, ran.out) == (2, "")
    assert all(f"  {name} " in ran.err for name in HELPS)


def test_the_version_is_that_of_the_package(fdvv: Run) -> None:
    import fdvv as package

    assert fdvv("--version").out == f"fdvv, version {package.__version__}\n"


def test_a_pipe_that_closes_early_makes_no_noise(tmp_path: Path) -> None:
    process = subprocess.Popen(
        [*FDVV, "device", "list", "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=tmp_path
    )
    assert process.stdout is not None
    process.stdout.close()
    assert process.stderr is not None
    assert process.stderr.read() == b""
    assert process.wait() == 1
    process.stderr.close()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full here")
def test_a_full_disk_is_reported_in_one_line() -> None:
    with Path("/dev/full").open("wb") as full:
        ran = subprocess.run([*FDVV, "--version"], stdout=full, stderr=subprocess.PIPE, check=False)
    assert ran.returncode == 2
    assert ran.stderr == b"fdvv: No space left on device; make room on the disk\n"


def test_progress_is_shown_on_a_terminal_only_and_never_on_standard_output(folder: Path) -> None:
    fit = ("fit", str(folder), "--json")
    quiet = subprocess.run([*FDVV, *fit], capture_output=True, check=True)
    assert b"fitting" not in quiet.stderr
    out, shown = run_on_terminal(*fit)
    assert "fitting" in shown
    assert {r["file"] for r in json.loads(out)["results"]} == {
        r["file"] for r in json.loads(quiet.stdout)["results"]
    }


def test_ctrl_c_ends_with_130_one_line_and_whole_files(many: Path, tmp_path: Path) -> None:
    models = tmp_path / "models"
    process = subprocess.Popen(
        [*FDVV, "fit", str(many), "-o", str(models)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        # a shell's background job ignores Ctrl-C, and so would what it starts
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    wait_until_started(process, models / "00.csv.fdvv.json")
    process.send_signal(signal.SIGINT)
    out, err = process.communicate()
    assert (process.returncode, out, err) == (130, b"", b"fdvv: interrupted\n")
    # a worker may still be at a temporary file, which becomes a model whole or not at all
    written = list(models.glob("*.fdvv.json"))
    assert 0 < len(written) < 40
    assert all(load_model(path).name for path in written)


def test_a_killed_command_leaves_no_half_written_model(many: Path, tmp_path: Path) -> None:
    models = tmp_path / "models"
    process = subprocess.Popen([*FDVV, "fit", str(many), "-o", str(models)], stderr=subprocess.DEVNULL)
    wait_until_started(process, models / "00.csv.fdvv.json")
    process.kill()
    process.wait()
    written = list(models.glob("*.fdvv.json"))
    assert len(written) < 40
    assert all(load_model(path).name for path in written)


def test_a_fit_that_is_not_kept_says_so_and_how_to_keep_it(fdvv: Run, switch: Path, folder: Path) -> None:
    assert "nothing was saved; add -o NAME.fdvv.json" in fdvv("fit", switch).out
    assert "nothing was saved; add -o FOLDER" in fdvv("fit", folder).out
    assert "nothing was saved" not in fdvv("fit", switch, "-o", "a.fdvv.json").out

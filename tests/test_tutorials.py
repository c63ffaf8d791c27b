"""What tutorials and the README show is what runs, on real files, in an empty folder."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[1]
TUTORIAL = REPOSITORY / "docs" / "tutorials" / "first-button.md"
NOT_RUN = ("make", ".")
"""Setting up and the whole demo have their own runs."""
NOT_COMPARED = ("compensate", "probe")
"""Their figures belong to docs/explanation/compensation.md."""
MILLISECONDS = re.compile(r"\s+\d+\.\d$")


def blocks(page: Path) -> list[tuple[str, str]]:
    """Give (language, text) of the fenced blocks of a page."""
    return re.findall(r"^```(\w*)\n(.*?)^```$", page.read_text(), flags=re.MULTILINE | re.DOTALL)


def steps(text: str) -> list[tuple[list[str], list[str]]]:
    """Split a console block into commands, each with the lines shown for it."""
    found: list[tuple[list[str], list[str]]] = []
    for line in text.splitlines():
        if line.startswith("$ "):
            found.append((shlex.split(line[2:]), []))
        else:
            found[-1][1].append(line)
    return found


def run(command: list[str], folder: Path, environment: Mapping[str, str]) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, encoding="utf-8", check=False
    )


@pytest.fixture
def environment() -> dict[str, str]:
    return {**os.environ, "PYTHONUTF8": "1"}


def test_the_first_button_goes_as_the_tutorial_shows(tmp_path: Path, environment: dict[str, str]) -> None:
    pytest.importorskip("matplotlib")
    (tmp_path / "src").symlink_to(REPOSITORY / "src")
    printed = ""
    for language, text in blocks(TUTORIAL):
        if language == "python":
            ran = run([sys.executable, "-c", text], tmp_path, environment)
            assert (ran.returncode, ran.stderr) == (0, "")
            printed = ran.stdout
        elif language == "console":
            for command, shown in steps(text):
                check(command, shown, tmp_path, environment)
        else:
            assert text == printed, "the block after a program shows what it prints"
    assert (tmp_path / "first" / "brown.svg").read_text().startswith("<?xml")


def plain(line: str) -> str:
    """Drop milliseconds, and the column widths that they set."""
    return " ".join(MILLISECONDS.sub("", line).split())


def check(
    command: list[str],
    shown: list[str],
    folder: Path,
    environment: dict[str, str],
    compared: bool = False,
) -> None:
    if command[0] in NOT_RUN:
        return
    assert command[0] == "fdvv"
    ran = run([sys.executable, "-m", *command], folder, environment)
    expected = 2 if shown and shown[0].startswith("fdvv: ") else 0
    assert ran.returncode == expected, f"{shlex.join(command)}: {ran.stderr}"
    if command[1] in NOT_COMPARED and not compared:
        return
    printed = [plain(line) for line in (ran.stdout + ran.stderr).splitlines()]
    for line in shown:
        assert plain(line) in printed, f"{shlex.join(command)} does not print {line!r}"


def test_every_command_of_the_tutorial_is_run_and_most_are_compared() -> None:
    commands = [step for language, text in blocks(TUTORIAL) if language == "console" for step in steps(text)]
    run_here = [command[1] for command, _ in commands if command[0] == "fdvv"]
    assert set(run_here) == {"library", "fit", "show", "compare", "merge", "compensate", "probe"}
    assert all(shown for command, shown in commands if command[0] == "fdvv" and command[1] != "compensate")


def test_the_readmes_program_runs(tmp_path: Path, environment: dict[str, str]) -> None:
    programs = [text for language, text in blocks(REPOSITORY / "README.md") if language == "python"]
    assert programs
    for program in programs:
        ran = run([sys.executable, "-W", "error", "-c", program], tmp_path, environment)
        assert (ran.returncode, ran.stderr) == (0, "")
        assert len(ran.stdout.splitlines()) == program.count("print(")


NEW_PROGRAM = REPOSITORY / "docs" / "tutorials" / "new-program.md"


def test_a_new_program_goes_as_the_tutorial_shows(tmp_path: Path, environment: dict[str, str]) -> None:
    printed, ran_here = "", set()
    for language, text in blocks(NEW_PROGRAM):
        if language == "python":
            ran = run([sys.executable, "-W", "error", "-c", text], tmp_path, environment)
            assert (ran.returncode, ran.stderr) == (0, "")
            printed = ran.stdout
        elif language == "console":
            for command, shown in steps(text):
                check(command, shown, tmp_path, environment)
                ran_here.add(" ".join(command[1:3]))
        else:
            assert text == printed, "the block after a program shows what it prints"
    assert (tmp_path / "shutter.fdvv-image").read_bytes().startswith(b"FDVP")
    assert ran_here >= {f"program {name}" for name in ("list", "make", "check", "show", "compile")}


RIG = REPOSITORY / "docs" / "tutorials" / "compensate-a-rig.md"


@pytest.mark.slow
def test_compensating_a_rig_goes_as_the_tutorial_shows(tmp_path: Path, environment: dict[str, str]) -> None:
    printed, ran_here = "", list[str]()
    for language, text in blocks(RIG):
        if language == "python":
            ran = run([sys.executable, "-W", "error", "-c", text], tmp_path, environment)
            assert (ran.returncode, ran.stderr) == (0, "")
            printed = ran.stdout
        elif language == "console":
            for command, shown in steps(text):
                assert shown, "what is shown here holds no figures of learning, so all of it is compared"
                check(command, shown, tmp_path, environment, compared=True)
                ran_here.append(command[1])
        elif language == "":
            assert text == printed, "the block after a program shows what it prints"
    assert ran_here == ["compensate", "compensate", "compensate", "probe", "compensate", "show"]
    assert {p.name for p in (tmp_path / "clear.session").iterdir()} == set(
        re.findall(r"^\| `(.*?\.jsonl?)` \|", RIG.read_text(), flags=re.MULTILINE)
    )


CAPTURE = REPOSITORY / "docs" / "tutorials" / "capture-a-button.md"


def test_capturing_a_button_goes_as_the_tutorial_shows(tmp_path: Path, environment: dict[str, str]) -> None:
    printed, ran_here = "", list[str]()
    for language, text in blocks(CAPTURE):
        if language == "python":
            ran = run([sys.executable, "-W", "error", "-c", text], tmp_path, environment)
            assert (ran.returncode, ran.stderr) == (0, "")
            printed = ran.stdout
        elif language == "console":
            for command, shown in steps(text):
                assert shown
                check(command, shown, tmp_path, environment)
                ran_here.append(command[1])
        elif language == "":
            assert text == printed, "the block after a program shows what it prints"
    assert ran_here == ["capture"] * 3
    assert [path.name for path in tmp_path.iterdir()] == ["clear.recording.jsonl"]


STUDY = REPOSITORY / "docs" / "tutorials" / "run-a-study.md"


@pytest.mark.slow
@pytest.mark.timeout(300)
def test_a_study_goes_as_the_tutorial_shows(tmp_path: Path, environment: dict[str, str]) -> None:
    (tmp_path / "passphrase.txt").write_text("four words of one keeper\n")
    ran_here = list[str]()
    for language, text in blocks(STUDY):
        if language == "console":
            for command, shown in steps(text):
                check(command, shown, tmp_path, environment)
                ran_here.append(command[2])
    dry = ["new", "freeze", "simulate", "unseal", "analyse"]
    assert ran_here == ["new", "check", "power", *dry, "freeze", "verify"]
    assert "simulated" in (tmp_path / "dry-run.html").read_text().lower()


OPTIMISE = REPOSITORY / "docs" / "tutorials" / "optimise.md"
CUT = {"population": ("--people", "2", "--grid", "4"), "experiment": ("--people", "3", "--trials", "2")}
"""What takes minutes is run with fewer people and designs; of an option given twice the last counts."""


@pytest.mark.slow
@pytest.mark.timeout(300)
def test_optimising_goes_as_the_tutorial_shows(tmp_path: Path, environment: dict[str, str]) -> None:
    ran_here = list[str]()
    for language, text in blocks(OPTIMISE):
        if language == "console":
            for command, shown in steps(text):
                check([*command, *CUT.get(command[2], ())], shown, tmp_path, environment)
                ran_here.append(command[2])
    begun = ["run", "report", "replay", "resume"]
    others = ["population", "run", "run", "experiment", "population", "experiment"]
    assert ran_here == [*begun, "run", *others]
    assert "simulated" in (tmp_path / "warm-experiment" / "report.html").read_text().lower()

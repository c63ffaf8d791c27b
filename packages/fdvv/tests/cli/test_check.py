"""fdvv check: verdicts as lines, as JSON and as the exit status."""

from __future__ import annotations

from importlib import resources
from pathlib import Path

import pytest

from fdvv.recording.log import RecordingLog
from tests.recording.takes import ABOUT, take
from tests.support.command_line import Run

BUILTIN = Path(str(resources.files("fdvv.model") / "builtin" / "mx-blue.fdvv.json"))


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    with RecordingLog(tmp_path / "a.recording.jsonl", ABOUT) as log:
        log.add(take(1))
        log.add(take(2))
    return tmp_path / "a.recording.jsonl"


def test_whole_files_are_summarized_with_status_0(fdvv: Run, recording: Path) -> None:
    ran = fdvv("check", recording.name, BUILTIN)
    assert (ran.status, ran.err) == (0, "")
    assert ran.out.startswith("a.recording.jsonl: a recording, whole\n")
    assert "version 1, " in ran.out
    assert "force   force, cN   board   int16" in ran.out
    assert "mx-blue.fdvv.json: an FDVV model, whole" in " ".join(ran.out.split())


def test_a_file_with_a_problem_has_status_1_and_tells_what_to_do(fdvv: Run, recording: Path) -> None:
    recording.write_bytes(recording.read_bytes()[:-1])
    ran = fdvv("check", recording.name)
    assert (ran.status, ran.err) == (1, "")
    assert "a recording, can be read, with 1 problem" in ran.out
    assert "problem: end of file: the last record is not whole and is left out; go on with it" in ran.out


def test_an_unusable_file_has_one_line_and_status_2_beside_whole_ones(fdvv: Run, recording: Path) -> None:
    damaged = recording.with_name("b.recording.jsonl")
    damaged.write_bytes(recording.read_bytes().replace(b"press", b"prass", 1))
    ran = fdvv("check", damaged.name, recording.name)
    assert ran.status == 2
    assert ran.err.count("\n") == 1
    assert ran.err.startswith("fdvv: b.recording.jsonl: line 2: the record is damaged; ")
    assert ran.out.startswith("a.recording.jsonl: a recording, whole\n")


@pytest.mark.parametrize("name", ["gone", "a.txt", "."])
def test_what_is_no_file_of_fdvv_has_one_line_and_status_2(fdvv: Run, tmp_path: Path, name: str) -> None:
    (tmp_path / "a.txt").write_text("Dear Sir or Madam,\n")
    ran = fdvv("check", name)
    assert (ran.status, ran.out, ran.err.count("\n")) == (2, "", 1)
    assert ran.err.startswith(f"fdvv: {name}: ")


def test_json_holds_every_file_in_order(fdvv: Run, recording: Path) -> None:
    ran = fdvv("check", recording.name, "gone", "--json")
    assert (ran.status, ran.err.count("\n")) == (2, 1)
    first, second = ran.json["files"]
    assert (first["file"], first["verdict"], first["kind"]) == ("a.recording.jsonl", "whole", "a recording")
    assert first["facts"]["streams"][0]["rate_Hz"] == pytest.approx(1000)
    assert (second["verdict"], second["problems"][0]["reason"]) == ("unusable", "No such file or directory")

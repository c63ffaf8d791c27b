"""fdvv study with a timing study: from its file to the report beside the paper's."""

from __future__ import annotations

import json
import os
import time
from pathlib import Path

import pytest

from fdvv_people.study.timing.participant import TimingParticipant
from fdvv_people.study.timing.plan import DAY_s
from tests.support.command_line import Run
from tests.support.timing import SMALL, Clock, attended, do_all


@pytest.fixture(autouse=True)
def inside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(os, "fsync", lambda _file: None)
    Path("pw").write_text("four words of no sense\n")
    Path("small").mkdir()
    Path("small/study.toml").write_text(SMALL.replace("rounds = 1", "rounds = 2"))


def freeze(fdvv: Run) -> None:
    assert fdvv("study", "freeze", "small", "--passphrase-file", "pw").status == 0


def test_a_check_says_what_the_study_comes_to(fdvv: Run) -> None:
    found = fdvv("study", "check", "small")
    assert found.status == 0
    assert "16 trials of validation a person" in found.out
    assert "7 days after 4 of training" in " ".join(found.out.split())


def test_a_study_is_simulated_unsealed_analysed_and_exported(fdvv: Run) -> None:
    freeze(fdvv)
    simulated = fdvv("study", "simulate", "small", "--people", "3")
    assert simulated.status == 0, simulated.err
    assert "3 simulated participants done" in simulated.out
    assert fdvv("study", "verify", "small", "--passphrase-file", "pw").status == 0
    status = fdvv("study", "status", "small", "--json").json
    assert [one["phase"] for one in status["people"]] == ["done"] * 3
    unsealed = fdvv("study", "unseal", "small", "--who", "me", "--why", "a test", "--passphrase-file", "pw")
    assert "48 trials of validation (simulated), 48 count" in unsealed.out
    found = fdvv("study", "analyse", "small", "--report", "report.html")
    assert found.status == 0, found.err
    assert "Simulated: the claim" in found.out
    assert "Beside the paper" in Path("report.html").read_text()
    exported = fdvv("study", "export", "small", "--folder", "out")
    assert exported.status == 0
    names = sorted(path.name for path in Path("out").iterdir())
    assert names == ["analysis.json", "scores.csv", "training.csv"]
    assert json.loads(Path("out/analysis.json").read_text())["simulated"] is True


def test_the_status_says_who_is_due_and_what_to_write_to_them(fdvv: Run) -> None:
    freeze(fdvv)
    clock = Clock()
    clock.now_s = time.time() - 8 * DAY_s
    one, _ = TimingParticipant.enrol(attended(Path("small")), clock=clock)
    list(do_all(one, clock, until="wait"))
    one.close()
    assert "due: P01: P01, come from " in " ".join(fdvv("study", "status", "small").out.split())
    (person,) = fdvv("study", "status", "small", "--json").json["people"]
    assert (person["phase"], person["done"]) == ("due", 4)


def test_what_timing_studies_have_no_use_for_is_refused_in_one_line(fdvv: Run) -> None:
    for command in ("preview", "power"):
        refused = fdvv("study", command, "small")
        assert (refused.status, refused.err.count("\n")) == (2, 1)
        assert "studies that ask about what is rendered" in refused.err


def test_before_it_is_unsealed_nothing_is_analysed(fdvv: Run) -> None:
    freeze(fdvv)
    refused = fdvv("study", "analyse", "small")
    assert (refused.status, refused.err.count("\n")) == (2, 1)
    assert "is not unsealed" in refused.err

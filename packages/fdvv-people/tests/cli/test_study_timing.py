"""fdvv study with a timing study: from its file to the report beside the paper's."""

from __future__ import annotations

import json
import os
import time
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from fdvv.cli.main import cli
from fdvv.errors import InputError
from fdvv_people.study.timing.participant import TimingParticipant
from fdvv_people.study.timing.plan import DAY_s
from tests.support.timing import SMALL, Clock, attended, do_all


@pytest.fixture(autouse=True)
def inside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(os, "fsync", lambda _file: None)
    Path("pw").write_text("four words of no sense\n")
    Path("small").mkdir()
    Path("small/study.toml").write_text(SMALL.replace("rounds = 1", "rounds = 2"))


def invoke(*arguments: str) -> Result:
    return CliRunner().invoke(cli, ["study", *arguments])


def freeze() -> None:
    assert invoke("freeze", "small", "--passphrase-file", "pw").exit_code == 0


def test_a_check_says_what_the_study_comes_to() -> None:
    found = invoke("check", "small")
    assert found.exit_code == 0
    assert "16 trials of validation a person" in found.stdout
    assert "7 days after 4 of training" in " ".join(found.stdout.split())


def test_a_study_is_simulated_unsealed_analysed_and_exported() -> None:
    freeze()
    simulated = invoke("simulate", "small", "--people", "3")
    assert simulated.exit_code == 0, simulated.output
    assert "3 simulated participants done" in simulated.stdout
    assert invoke("verify", "small", "--passphrase-file", "pw").exit_code == 0
    status = json.loads(invoke("status", "small", "--json").stdout)
    assert [one["phase"] for one in status["people"]] == ["done"] * 3
    unsealed = invoke("unseal", "small", "--who", "me", "--why", "a test", "--passphrase-file", "pw")
    assert "48 trials of validation (simulated), 48 count" in unsealed.stdout
    found = invoke("analyse", "small", "--report", "report.html")
    assert found.exit_code == 0, found.output
    assert "Simulated: the claim" in found.stdout
    assert "Beside the paper" in Path("report.html").read_text()
    exported = invoke("export", "small", "--folder", "out")
    assert exported.exit_code == 0
    names = sorted(path.name for path in Path("out").iterdir())
    assert names == ["analysis.json", "scores.csv", "training.csv"]
    assert json.loads(Path("out/analysis.json").read_text())["simulated"] is True


def test_the_status_says_who_is_due_and_what_to_write_to_them() -> None:
    freeze()
    clock = Clock()
    clock.now_s = time.time() - 8 * DAY_s
    one, _ = TimingParticipant.enrol(attended(Path("small")), clock=clock)
    list(do_all(one, clock, until="wait"))
    one.close()
    assert "due: P01: P01, come from " in " ".join(invoke("status", "small").stdout.split())
    (person,) = json.loads(invoke("status", "small", "--json").stdout)["people"]
    assert (person["phase"], person["done"]) == ("due", 4)


def test_what_timing_studies_have_no_use_for_is_refused_in_one_line() -> None:
    for command in ("preview", "power"):
        refused = invoke(command, "small")
        assert isinstance(refused.exception, InputError)
        assert "studies that ask about what is rendered" in str(refused.exception)


def test_before_it_is_unsealed_nothing_is_analysed() -> None:
    freeze()
    refused = invoke("analyse", "small")
    assert isinstance(refused.exception, InputError)
    assert "is not unsealed" in str(refused.exception)

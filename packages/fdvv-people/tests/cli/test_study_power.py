"""fdvv study power and simulate."""

from __future__ import annotations

from pathlib import Path

import pytest

from fdvv_people.study.plan.plan_file import write_template
from tests.support.command_line import Run
from tests.support.study_people import frozen_study


@pytest.fixture
def study(tmp_path: Path) -> Path:
    return write_template("abx", tmp_path / "abx")


def test_a_table_says_simulated_and_has_false_claims_beside_power(fdvv: Run, study: Path) -> None:
    ran = fdvv("study", "power", study, "--people", "6-8", "--studies", "100")
    assert ran.status == 0, ran.err
    assert ran.out.startswith("simulated: ")
    assert "prove nothing" in ran.out
    assert "false: alike" in ran.out
    assert [line.split()[0] for line in ran.out.splitlines() if line[:1].isdigit()][-3:] == ["6", "7", "8"]


def test_json_is_one_document_with_intervals_and_the_proxys_constants(fdvv: Run, study: Path) -> None:
    ran = fdvv(
        "study", "power", study, "--people", "12", "--studies", "100", "--set", "weber_ratio=0.15", "--json"
    )
    assert ran.status == 0, ran.err
    assert ran.json["simulated"] is True
    assert ran.json["proxy"]["senses"]["weber_ratio"] == 0.15
    (row,) = ran.json["rows"]
    assert row["power"]["low"] < row["power"]["high"]


@pytest.mark.parametrize(
    "wrong",
    [
        ("--people", "40-6"),
        ("--people", "1"),
        ("--people", "many"),
        ("--set", "weber_ratio"),
        ("--set", "patience=1"),
        ("--set", "weber_ratio=-1"),
        ("--difference", "nan"),
    ],
)
def test_what_makes_no_sense_is_refused_in_one_line(fdvv: Run, study: Path, wrong: tuple[str, str]) -> None:
    ran = fdvv("study", "power", study, *wrong)
    assert ran.status == 2
    assert ran.out == ""
    assert wrong[0] in ran.err


def test_for_a_study_without_a_claim_the_missing_entry_is_named(fdvv: Run, tmp_path: Path) -> None:
    path = write_template("staircase", tmp_path / "stairs")
    ran = fdvv("study", "power", path)
    assert ran.status == 2
    assert "claims nothing" in ran.err


def test_a_study_is_run_and_what_it_says_is_simulated(fdvv: Run, tmp_path: Path) -> None:
    study = frozen_study(tmp_path / "s", rounds=1).folder
    ran = fdvv("study", "simulate", study, "--people", "1", "--fast")
    assert ran.status == 0, ran.err
    assert ran.out.startswith("simulated: demo, 1 simulated participant done")
    assert "Nothing was pressed" in ran.out
    assert "P01" in ran.out
    again = fdvv("study", "simulate", study, "--people", "1", "--fast", "--json")
    assert again.json["simulated"] is True
    assert again.json["sessions"] == []
    assert again.json["finished"] == ["P01"]

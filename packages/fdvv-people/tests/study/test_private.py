"""What people gave, only the account that runs the study reads; and a spreadsheet calculates none of it."""

from __future__ import annotations

import csv
import io
import os
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv_people.study.analysis.code_book import answers_csv, csv_text, unescaped, write_answers
from fdvv_people.study.analysis.read_answers import read_answers
from tests.support.studies import CHEAP, PASSPHRASE, answered, chosen, small_study

POSIX = pytest.mark.skipif(os.name != "posix", reason="Windows knows no such permissions")


def open_to_others(folder: Path) -> list[str]:
    return [path.name for path in (folder, *folder.rglob("*")) if path.stat().st_mode & 0o077]


@POSIX
def test_others_on_the_machine_read_nothing_of_people(tmp_path: Path) -> None:
    study = small_study(tmp_path)
    person, code = study.enrol(cost=CHEAP)
    answered(study, person, code, chosen("FDVV"))
    study.unseal(PASSPHRASE, "me", "test")
    for name in ("people", "unsealed"):
        assert open_to_others(study.folder / name) == []
    for name in ("keeper.json", "study.jsonl", "study.head", "counts.json"):
        assert (study.folder / name).stat().st_mode & 0o777 == 0o600


@POSIX
def test_people_of_an_earlier_fdvv_are_private_once_the_sessions_are_opened(tmp_path: Path) -> None:
    study = small_study(tmp_path)
    study.enrol(cost=CHEAP)
    (study.folder / "people").chmod(0o755)
    (study.folder / "people" / "P01" / "session.jsonl").chmod(0o644)
    study.open_sessions(PASSPHRASE)
    assert open_to_others(study.folder / "people") == []


@pytest.mark.parametrize(
    ("cell", "written"),
    [
        ("=1+1", "'=1+1"),
        ("+cmd|' /C calc'!A0", "'+cmd|' /C calc'!A0"),
        ("-", "'-"),
        ("@SUM(A1)", "'@SUM(A1)"),
        ("\t=1", "'\t=1"),
        ("'=1", "''=1"),
        ("-1.5", "-1.5"),
        ("+1e-7", "+1e-7"),
        ("-1.250 nan 3.000", "-1.250 nan 3.000"),
        (-3, "-3"),
        (-0.25, "-0.25"),
        ("left", "left"),
        ("'tis", "'tis"),
        ("", ""),
    ],
)
def test_a_cell_that_a_spreadsheet_would_calculate_is_escaped(cell: object, written: str) -> None:
    ((found,),) = list(csv.reader(io.StringIO(csv_text([cell], []))))  # type: ignore[list-item]
    assert found == written


@given(st.text(max_size=12).filter(lambda text: text == text.strip() and "\r" not in text))
def test_every_text_comes_back(text: str) -> None:
    ((_,), (found,)) = list(csv.reader(io.StringIO(csv_text(["heading"], [[text or "x"]]), newline="")))
    assert unescaped(found) == (text or "x")


def test_answers_about_buttons_with_such_names_are_read_as_they_were_written(tmp_path: Path) -> None:
    study = small_study(tmp_path / "one")
    person, code = study.enrol(cost=CHEAP)
    answered(study, person, code, chosen("FDVV"))
    found = study.unseal(PASSPHRASE, "me", "test")
    items = found.item.astype(object)
    items[found.item == "clear"] = "=clear"
    from dataclasses import replace

    formula = replace(found, item=items.astype(str))
    assert "'=clear" in answers_csv(formula)
    write_answers(tmp_path, formula)
    assert set(read_answers(tmp_path / "answers.csv").item.tolist()) == {"=clear", "red"}

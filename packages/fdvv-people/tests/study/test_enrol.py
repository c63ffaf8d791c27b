"""Who withdraws is deleted wholly, and the study stays whole."""

from __future__ import annotations

import contextlib
import shutil
from pathlib import Path

import pytest

from fdvv.errors import InputError
from fdvv_people.study.admin.study import Study
from tests.support.kill import Killed, kill_at
from tests.support.studies import CHEAP, PASSPHRASE, all_files, answered, chosen, in_haste, small_study

AGE = 87.5
TRACES = (b"87.5", b"Oulu")


@pytest.fixture(scope="module")
def started_study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a study with two people, the first of an age that nothing else says."""
    with in_haste():
        study = small_study(tmp_path_factory.mktemp("begun"))
        for age, place in ((AGE, "Oulu"), (40.0, "Tampere")):
            person, code = study.enrol(consent=f"on paper in {place}", cost=CHEAP)
            answered(study, person, code, chosen("FDVV"), trials=2, age=age)
    return study.folder


@pytest.fixture
def study(started_study: Path, tmp_path: Path) -> Study:
    return Study.open(shutil.copytree(started_study, tmp_path / "study"))


def residue(study: Study, *words: bytes) -> list[Path]:
    return [path for path in all_files(study.folder) if any(word in path.read_bytes() for word in words)]


def test_no_file_keeps_anything_of_who_withdrew(study: Study) -> None:
    assert residue(study, b"87.5")
    kept = {path.read_bytes() for path in (study.folder / "people" / "P01").iterdir()}
    study.withdraw("P01")
    assert residue(study, *TRACES) == []
    assert not kept & {path.read_bytes() for path in all_files(study.folder)}
    assert not (study.folder / "people" / "P01").exists()
    assert not any("P01" in path.name for path in study.folder.rglob("*"))


def test_that_they_were_there_stays_on_record_and_the_study_whole(study: Study) -> None:
    study.withdraw("P01")
    assert study.person("P01").state == "deleted"
    assert study.history()[-1]["withdrawn"]["person"] == "P01"
    assert study.verify(study.fingerprint, PASSPHRASE) == ()
    assert set(study.unseal(PASSPHRASE, "me", "test").person) == {"P02"}


def test_what_was_unsealed_is_deleted_with_them(study: Study) -> None:
    study.unseal(PASSPHRASE, "me", "test")
    assert residue(study, b"P01,about,age,87.5")
    study.withdraw("P01")
    assert residue(study, *TRACES) == []
    assert not (study.folder / "unsealed").exists()
    study.unseal(PASSPHRASE, "me", "again")
    assert b"P01" not in (study.folder / "unsealed" / "answers.csv").read_bytes()


def test_who_only_ends_it_keeps_what_they_gave(study: Study) -> None:
    study.withdraw("P01", delete=False)
    assert study.person("P01").state == "withdrawn"
    assert residue(study, b"87.5")
    answers = study.unseal(PASSPHRASE, "me", "test")
    assert (answers.choice[answers.person == "P01"] != "").sum() == 1


def test_who_only_ended_it_may_have_all_deleted_later(study: Study) -> None:
    study.withdraw("P01", delete=False)
    study.withdraw("P01")
    assert residue(study, *TRACES) == []
    assert study.person("P01").state == "deleted"


def test_a_second_time_does_nothing(study: Study) -> None:
    study.withdraw("P01")
    before = study.history()
    study.withdraw("P01")
    assert study.history() == before


def test_who_is_at_it_at_this_moment_is_not_deleted(tmp_path: Path) -> None:
    study = small_study(tmp_path)
    person, code = study.enrol(cost=CHEAP)
    with (
        study.session_log(study.schedule(person, code)),
        pytest.raises(InputError, match="is in the study at this moment"),
    ):
        study.withdraw(person)
    assert study.person(person).state == "enrolled"
    assert study.verify() == ()


def test_somebody_unknown_cannot_withdraw(study: Study) -> None:
    with pytest.raises(InputError, match="name one of: P01, P02"):
        study.withdraw("../P01")


@pytest.mark.parametrize("step", range(1, 12, 4))
def test_a_deletion_that_is_killed_is_reported_and_completed_the_next_time(
    study: Study, step: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    with contextlib.suppress(Killed), kill_at(step, monkeypatch):
        study.withdraw("P01")
    if study.person("P01").state == "deleted" and (study.folder / "people" / "P01").exists():
        assert study.verify() == ("people/P01: was deleted, and files are still there; withdraw again",)
    study.withdraw("P01")
    assert residue(study, *TRACES) == []
    assert study.verify(study.fingerprint, PASSPHRASE) == ()

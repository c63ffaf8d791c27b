"""A frozen study that was changed in any byte of any file says so, and is not run."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from fdvv.errors import InputError
from fdvv_people.study.admin.study import Study
from fdvv_people.study.files.people import open_schedule
from tests.support.campaign import campaign
from tests.support.studies import (
    CHEAP,
    PASSPHRASE,
    all_files,
    answered,
    attended,
    chosen,
    in_haste,
    small_study,
)

CODES: dict[str, str] = {}


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a study with one person who is done and one who is not; it is not changed."""
    with in_haste():
        study = small_study(tmp_path_factory.mktemp("done"))
        for trials in (None, 2):
            person, CODES[person] = study.enrol(cost=CHEAP)
            answered(study, person, CODES[person], chosen("FDVV"), trials=trials)
    return study.folder


@pytest.fixture
def study(done: Path, tmp_path: Path) -> Study:
    shutil.copytree(done, tmp_path / "study")
    return attended(tmp_path / "study")


def test_a_study_that_nobody_changed_is_whole(study: Study) -> None:
    assert study.verify() == ()
    assert study.verify(study.fingerprint, PASSPHRASE) == ()
    assert study.verify(study.fingerprint.upper().replace("-", " ")) == ()
    study.require_whole()


@campaign("start", range(75), part=1)
def test_a_changed_byte_of_any_file_is_noticed(study: Study, start: int) -> None:
    files = all_files(study.folder)
    assert len(files) == 17
    for path in files:
        whole = path.read_bytes()
        for i in range(start, min(150, len(whole)), 75):
            changed = bytearray(whole)
            changed[(i * len(whole)) // 150 + i % 7 - len(whole)] ^= 1 + i % 200
            path.write_bytes(changed)
            assert study.verify(), (path.name, i)
        path.write_bytes(whole)
    assert study.verify(study.fingerprint, PASSPHRASE) == ()


def test_a_missing_file_is_noticed_unless_it_is_the_keepers(study: Study) -> None:
    for path in all_files(study.folder):
        whole = path.read_bytes()
        path.unlink()
        assert bool(study.verify()) == (path.name != "keeper.json"), path.name
        path.write_bytes(whole)


LINES: list[Callable[[list[bytes]], list[bytes]]] = [
    lambda lines: lines[:-1],
    lambda lines: [*lines, lines[-1]],
    lambda lines: [lines[0], lines[2], lines[1], *lines[3:]],
    lambda lines: [*lines[:1], *lines[2:]],
    lambda lines: [*lines, b'{"crc32": 0, "record": {}}\n'],
    lambda lines: [],
]


@pytest.mark.parametrize("name", ["study.jsonl", "people/P01/session.jsonl", "people/P02/sealed.jsonl"])
@pytest.mark.parametrize("change", LINES, ids=["cut", "repeated", "moved", "left out", "added", "emptied"])
def test_lines_of_a_log_that_were_tampered_with_are_noticed(
    study: Study, name: str, change: Callable[[list[bytes]], list[bytes]]
) -> None:
    path = study.folder / name
    path.write_bytes(b"".join(change(path.read_bytes().splitlines(keepends=True))))
    (problem,) = study.verify()
    assert problem.startswith(name)


@pytest.mark.parametrize(
    "name", ["study.toml", "buttons/own.fdvv.json", "frozen.json", "study.jsonl", "study.head"]
)
def test_a_study_that_was_changed_is_not_run(study: Study, name: str) -> None:
    path = study.folder / name
    path.write_bytes(path.read_bytes().replace(b"e", b"o", 1))
    with pytest.raises(InputError):
        study.enrol(cost=CHEAP)
    with pytest.raises(InputError):
        study.schedule("P02", CODES["P02"])


@pytest.mark.parametrize("name", ["schedule.json", "session.jsonl", "sealed.jsonl", "session.head"])
def test_somebodys_changed_files_stop_them_and_nobody_else(study: Study, name: str) -> None:
    path = study.folder / "people" / "P02" / name
    path.write_bytes(path.read_bytes().replace(b"a", b"b", 1))
    with pytest.raises(InputError, match="people/P02"):
        study.schedule("P02", CODES["P02"])
    assert study.enrol(cost=CHEAP)[0] == "P03"


def test_the_fingerprint_catches_a_whole_new_freezing(study: Study, tmp_path: Path) -> None:
    """Somebody changes the plan, freezes it anew and has a study that is whole; but not the one that was."""
    written_down = study.fingerprint
    text = (study.folder / "study.toml").read_text().replace("rounds = 2", "rounds = 4")
    other = Study.declare_text(tmp_path / "other", text, study.folder)
    other.freeze(PASSPHRASE, CHEAP)
    assert other.verify() == ()
    assert "not the one that was written down" in other.verify(written_down)[0]


def test_a_frozen_file_in_the_place_of_another_is_noticed(study: Study, tmp_path: Path) -> None:
    other = small_study(tmp_path / "elsewhere")
    for name in ("frozen.json", "keeper.json"):
        shutil.copy(other.folder / name, study.folder / name)
    assert "frozen.json: is not the one that study.jsonl began with" in study.verify()


def test_a_record_that_no_study_writes_is_reported(study: Study) -> None:
    """The study's log has no marks: a line can be added to it with this program's own log."""
    from fdvv_people.study.files.chained_log import ChainedLog

    with ChainedLog(study.folder / "study.jsonl") as log:
        log.write({"enrolled": {"person": 3}})
        reason = f"record {len(log.records)} is none of a study"
    assert study.verify() == (f"study.jsonl: {reason}",)
    with pytest.raises(InputError, match=reason):
        study.enrol(cost=CHEAP)


def test_somebody_elses_log_is_noticed(study: Study) -> None:
    one, other = (study.folder / "people" / name for name in ("P01", "P02"))
    for name in ("session.jsonl", "session.head"):
        shutil.copy(other / name, one / name)
    assert study.verify()[0] == "people/P01/session.jsonl: belongs to another person or study"


def test_an_older_copy_of_somebodys_files_is_noticed_once_they_are_done(tmp_path: Path) -> None:
    study = small_study(tmp_path)
    person, code = study.enrol(cost=CHEAP)
    older = shutil.copytree(study.person_folder(person), tmp_path / "older")
    answered(study, person, code, chosen("FD"))
    shutil.rmtree(study.person_folder(person))
    shutil.copytree(older, study.person_folder(person))
    assert "people/P01/session.jsonl: is not as it was when the person was done" in study.verify()


def test_who_wrote_down_the_end_of_the_record_notices_that_an_act_was_taken_out(tmp_path: Path) -> None:
    """The study's log has no marks: it can be written anew without the unsealing, and looks whole."""
    study = small_study(tmp_path)
    older = shutil.copytree(study.folder, tmp_path / "older")
    study.unseal(PASSPHRASE, "me", "to peek")
    record = study.record_end
    assert study.verify(record=record) == ()
    for name in ("study.jsonl", "study.head"):
        shutil.copy(older / name, study.folder / name)
    shutil.rmtree(study.folder / "unsealed")
    assert study.verify() == ()
    assert study.verify(record=record) == (f"study.jsonl: never ended in {record}, which was written down",)


def test_lines_that_were_forged_without_the_code_are_noticed_with_the_keepers_key(study: Study) -> None:
    """The forger is this program's own log, with another key: everything but the marks is right."""
    from fdvv_people.study.files.chained_log import ChainedLog, read_chained

    path = study.folder / "people" / "P02" / "session.jsonl"
    found = read_chained(path)
    for name in ("session.jsonl", "session.head"):
        (path.with_name(name)).unlink()
    with ChainedLog.create(path, found.about, bytes(32)) as log:
        for record in found.records:
            log.write(record)
    assert study.verify() == ("people/P02/session.jsonl: is not the one that was counted",)
    (problem,) = study.verify(passphrase=PASSPHRASE)
    assert problem == "people/P02/session.jsonl: line 2 was changed, moved or added"
    with pytest.raises(InputError, match="line 2 was changed"):
        study.session_log(
            open_schedule(study.folder / "people/P02/schedule.json", CODES["P02"], study.run_key)
        )

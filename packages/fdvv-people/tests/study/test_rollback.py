"""Lines that are cut from a session, however well, are missed: when it goes on, in checks, at unsealing."""

from __future__ import annotations

import random
import shutil
from functools import partial
from pathlib import Path
from typing import Any

import msgspec
import pytest

from fdvv.errors import InputError
from fdvv_people.study.admin.study import Study
from fdvv_people.study.files.chained_log import read_chained
from fdvv_people.study.files.counts import read_counts
from fdvv_people.study.files.layout import Frozen
from fdvv_people.study.files.log_head import LogHead, head_path
from fdvv_people.study.files.run_key import RunKey
from fdvv_people.study.session.log import OpenedSession
from fdvv_people.study.session.participant import Participant
from tests.support.studies import all_files, attended, in_haste
from tests.support.study_people import PASSPHRASE, StillStage, do_all, enrolled, frozen_study

LOGS = ("session.jsonl", "sealed.jsonl")
CODES: dict[str, str] = {}


@pytest.fixture(scope="module")
def left_study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a study: one person is done, another left after 14 of 17 trials."""
    folder = tmp_path_factory.mktemp("left") / "study"
    with in_haste():
        study = frozen_study(folder, rounds=8)
        for trials in (10_000, 14):
            one, CODES[one.person] = enrolled(study, StillStage())
            do_all(one, trials)
            one.close()
    return folder


@pytest.fixture
def study(left_study: Path, tmp_path: Path) -> Study:
    return attended(shutil.copytree(left_study, tmp_path / "study"), PASSPHRASE)


def cut(path: Path, lines: int) -> None:
    """Cut lines from the end of a log and write a head that fits, as anybody can who knows the format."""
    kept = path.read_bytes().splitlines(keepends=True)[:-lines]
    path.write_bytes(b"".join(kept))
    head = LogHead(len(kept), read_chained(path).chains[-1])
    marked = b'"head": "marked"' in kept[0]
    head_path(path).write_text((head.marked(bytes(32)) if marked else head).text)


def cut_session(study: Study, person: str, lines: int) -> None:
    cut(study.folder / "people" / person / "session.jsonl", lines)


def noticed(study: Study, person: str) -> bool:
    """Whether a check without and with the key holder notices it, and the session does not go on."""
    seen = [Study.open(study.folder).verify(), study.verify(passphrase=PASSPHRASE)]
    with pytest.raises(InputError):
        Participant.resume(study, person, CODES[person], StillStage())
    return all(any(f"people/{person}/" in line for line in problems) for problems in seen)


@pytest.mark.parametrize("lines", range(1, 21))
def test_lines_that_are_cut_with_the_head_rewritten_are_noticed(study: Study, lines: int) -> None:
    cut_session(study, "P02", lines)
    assert noticed(study, "P02")


def test_a_hundred_of_a_hundred_rollbacks_by_1_to_20_lines_to_earlier_files_are_noticed(
    study: Study, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every file of the person is put back as it once was, its head and marks with it."""
    own, draw, write = study.folder / "people" / "P03", random.Random(1), OpenedSession._write
    once: list[dict[Path, bytes]] = []

    def note(opened: OpenedSession, *event: Any) -> None:
        write(opened, *event)
        once.append({path: path.read_bytes() for path in own.iterdir()})

    monkeypatch.setattr(OpenedSession, "_write", note)
    with enrolled(study, StillStage())[0] as one:
        do_all(one, 14)
        seen = 0
        for _ in range(100):
            for path, data in once[-1 - draw.randint(1, 20)].items():
                path.write_bytes(data)
            seen += any("people/P03/" in line for line in Study.open(study.folder).verify())
        for path, data in once[-1].items():
            path.write_bytes(data)
        assert seen == 100
    assert study.verify(passphrase=PASSPHRASE) == ()


def test_who_puts_the_counts_back_too_is_noticed_by_the_record(study: Study) -> None:
    own, counts = study.folder / "people" / "P02", study.folder / "counts.json"
    saved = {path: path.read_bytes() for path in (counts, *own.iterdir())}
    with Participant.resume(study, "P02", CODES["P02"], StillStage()) as one:
        do_all(one, 15)
    for path, data in saved.items():
        path.write_bytes(data)
    assert "an older one lies in its place" in Study.open(study.folder).verify()[0]


def test_a_whole_folder_put_back_is_noticed_while_the_studio_runs(study: Study) -> None:
    """Behind a new start only what somebody wrote down, `record`, can show it."""
    saved = {path: path.read_bytes() for path in all_files(study.folder)}
    with Participant.resume(study, "P02", CODES["P02"], StillStage()) as one:
        do_all(one, 15)
    record = study.record_end
    for path, data in saved.items():
        path.write_bytes(data)
    assert "an older one lies in its place" in study.verify()[0]
    with pytest.raises(InputError, match="an older one"):
        Participant.resume(study, "P02", CODES["P02"], StillStage())
    later = Study.open(study.folder)
    assert later.verify(passphrase=PASSPHRASE) == ()
    assert "which was written down" in later.verify(record=record)[0]


@pytest.mark.parametrize("change", ["lower", "drop", "delete", "other key"])
def test_counts_that_were_changed_are_noticed_and_nothing_is_counted_on(study: Study, change: str) -> None:
    path, found = study.folder / "counts.json", read_counts(study.folder)
    assert found is not None
    people = {name: one for name, one in found.people.items() if name != "P02" or change != "drop"}
    cut_session(study, "P02", 2)
    if change == "delete":
        path.unlink()
    else:
        forged = msgspec.structs.replace(found, people=people, mark=found.mark if change == "drop" else "")
        key = RunKey(bytes(32), study.seal.text)
        path.write_text((forged.marked(key) if change == "other key" else forged.summed()).text)
    assert Study.open(study.folder).verify(passphrase=PASSPHRASE)
    with pytest.raises(InputError):
        Participant.resume(study, "P02", CODES["P02"], StillStage())


def test_an_enrolment_that_is_cut_from_the_record_is_noticed(study: Study) -> None:
    log = study.folder / "study.jsonl"
    while any("P02" in str(record) for record in read_chained(log).records):
        cut(log, 1)
    assert "study.jsonl: P02 was counted, and is not in it" in Study.open(study.folder).verify()


def test_unsealing_counts_nothing_of_a_session_that_lacks_lines(study: Study) -> None:
    whole = Study.open(shutil.copytree(study.folder, study.folder.with_name("whole")))
    answered = int((whole.unseal(PASSPHRASE, "me", "test").choice != "").sum())
    for name in LOGS:
        cut(study.folder / "people" / "P02" / name, 4)
    with pytest.raises(InputError, match="was changed"):
        study.unseal(PASSPHRASE, "me", "test")
    left = study.unseal(PASSPHRASE, "me", "test", despite=True)
    assert left.excluded is not None
    counted = left.person[(left.choice != "") & (left.excluded == "")]
    assert set(counted) == {"P01"}
    assert answered == 16 + 13


def test_a_finished_session_of_an_earlier_fdvv_that_lacks_answers_is_noticed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its logs have no counts and its record no key: somebody cut answers and what ends them from both."""
    monkeypatch.setattr("fdvv_people.study.admin.planned.Frozen", partial(Frozen, version=1))
    study = Study.open(frozen_study(tmp_path / "study").folder)
    one, _ = enrolled(study, StillStage())
    do_all(one, 3)
    one.close()
    study.finished("P01")
    (problem,) = study.verify(passphrase=PASSPHRASE)
    assert problem.endswith("session.jsonl: lacks the answers of 2 trials, and the person was done")

"""fdvv study as its keeper runs it: frozen, verified, looked at, unsealed, withdrawn from."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from fdvv_people.study.admin.study import Study
from tests.support.command_line import Run
from tests.support.studies import CHEAP, PASSPHRASE, answered, attended, chosen, in_haste, plan_file

WORDS = ("--passphrase-file", "words.txt")


@pytest.fixture(scope="module")
def started_study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a frozen study that one person has completed; to be copied."""
    folder = tmp_path_factory.mktemp("begun")
    with in_haste():
        study = Study.declare(folder / "s", plan_file(folder / "desk"))
        study.freeze(PASSPHRASE, CHEAP)
        person, code = study.enrol(cost=CHEAP)
        answered(study, person, code, chosen("FDVV"))
    return study.folder


@pytest.fixture
def study(started_study: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Study:
    """Return that study in s, with the passphrase in words.txt."""
    monkeypatch.setattr("os.fsync", lambda _file: None)
    study = attended(shutil.copytree(started_study, tmp_path / "s"))
    (tmp_path / "words.txt").write_text(PASSPHRASE + "\n")
    (tmp_path / "wrong.txt").write_text("other words of no sense")
    return study


def test_freezing_prints_the_fingerprint_and_nothing_of_the_passphrase(fdvv: Run, tmp_path: Path) -> None:
    study = Study.declare(tmp_path / "s", plan_file(tmp_path / "desk"))
    (tmp_path / "words.txt").write_text(PASSPHRASE)
    ran = fdvv("study", "freeze", "s", *WORDS)
    assert ran.status == 0, ran.err
    assert f"fingerprint: {study.fingerprint}\n" in ran.out
    assert PASSPHRASE not in ran.out + ran.err
    again = fdvv("study", "freeze", "s", *WORDS)
    assert (again.status, again.err.count("\n")) == (2, 1)
    assert "was frozen before" in again.err


def test_a_passphrase_is_asked_for_and_is_no_option(
    fdvv: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    Study.declare(tmp_path / "s", plan_file(tmp_path / "desk"))
    typed = iter([PASSPHRASE, "something else", PASSPHRASE, PASSPHRASE])
    monkeypatch.setattr("click.termui.hidden_prompt_func", lambda _text: next(typed))
    ran = fdvv("study", "freeze", "s", "--json")
    assert ran.status == 0, ran.err
    assert ran.json["fingerprint"] == Study.open(tmp_path / "s").fingerprint
    assert fdvv("study", "freeze", "s", "--passphrase", PASSPHRASE).status == 2


def test_a_short_passphrase_freezes_nothing(fdvv: Run, tmp_path: Path) -> None:
    study = Study.declare(tmp_path / "s", plan_file(tmp_path / "desk"))
    (tmp_path / "words.txt").write_text("short")
    ran = fdvv("study", "freeze", "s", *WORDS)
    assert (ran.status, ran.err.count("\n")) == (2, 1)
    assert study.frozen is None


def test_a_whole_study_verifies(fdvv: Run, study: Study) -> None:
    ran = fdvv("study", "verify", "s", "--fingerprint", study.fingerprint, *WORDS)
    assert (ran.status, ran.err) == (0, "")
    assert ran.out.splitlines() == [
        "whole; people: 1",
        f"fingerprint: {study.fingerprint}",
        f"the record ends in: {study.record_end}",
        "blind: no code opens it without the key holder",
    ]
    assert fdvv("study", "verify", "s", "--json").json == {
        "folder": "s",
        "whole": True,
        "problems": [],
        "marks": False,
        "simulated": False,
        "code_alone": [],
    }


def test_a_changed_study_ends_with_status_one_and_says_where(fdvv: Run, study: Study) -> None:
    plan = study.folder / "study.toml"
    plan.write_text(plan.read_text().replace("rounds = 2", "rounds = 3"))
    ran = fdvv("study", "verify", "s")
    assert (ran.status, ran.out) == (1, "study.toml: was changed since the study was frozen\n")
    assert ran.err == "fdvv: s: 1 problem\n"
    assert fdvv("study", "status", "s").status == 2


def test_another_fingerprint_than_the_one_written_down_is_a_problem(fdvv: Run, study: Study) -> None:
    ran = fdvv("study", "verify", "s", "--fingerprint", "0000-1111-2222-3333", "--json")
    assert ran.status == 1
    assert "not the one that was written down" in ran.json["problems"][0]
    assert study.verify() == ()


def test_an_end_of_the_record_that_was_written_down_is_found_again(fdvv: Run, study: Study) -> None:
    record = fdvv("study", "status", "s", "--json").json["record"]
    study.enrol(cost=CHEAP)
    assert fdvv("study", "verify", "s", "--record", record).status == 0
    ran = fdvv("study", "verify", "s", "--record", "0000-1111-2222-3333")
    assert (ran.status, ran.out) == (
        1,
        "study.jsonl: never ended in 0000-1111-2222-3333, which was written down\n",
    )


def test_status_tells_how_far_everybody_is_and_nothing_that_is_hidden(fdvv: Run, study: Study) -> None:
    study.enrol(cost=CHEAP)
    ran = fdvv("study", "status", "s")
    assert ran.status == 0, ran.err
    assert "P01     en        finished    4 of 4        0\n" in ran.out
    assert "P02     en        enrolled    0 of 0        0\n" in ran.out
    assert "people: 2 of 4 planned\n" in ran.out
    document = fdvv("study", "status", "s", "--json")
    assert document.json["state"] == "frozen"
    assert "FDVV" not in ran.out + document.out


def test_simulated_people_are_marked_wherever_people_are(fdvv: Run, study: Study, tmp_path: Path) -> None:
    assert "simulated" not in fdvv("study", "status", "s").out + fdvv("study", "verify", "s").out
    assert not fdvv("study", "status", "s", "--json").json["simulated"]
    other = Study.declare(tmp_path / "t", study.folder / "study.toml")
    other.freeze(PASSPHRASE, CHEAP)
    person, code = other.enrol(simulated=True, cost=CHEAP)
    answered(other, person, code, chosen("FDVV"))
    said = "1 of 4 planned, all simulated: a proxy, no evidence\n"
    assert said in fdvv("study", "status", "t").out
    assert fdvv("study", "status", "t", "--json").json["simulated"]
    assert "whole; people: 1, all simulated: a proxy, no evidence\n" in fdvv("study", "verify", "t").out
    assert fdvv("study", "verify", "t", "--json").json["simulated"]
    assert "(simulated)" in fdvv("study", "unseal", "t", "--who", "A", "--why", "done", *WORDS).out


def test_status_tells_who_is_paused(fdvv: Run, study: Study) -> None:
    assert fdvv("study", "status", "s", "--json").json["paused"] == []
    study.pause("P01")
    study.pause()
    assert "paused: P01, everybody\n" in fdvv("study", "status", "s").out
    study.pause(on=False)
    assert fdvv("study", "status", "s", "--json").json["paused"] == ["P01"]


def test_unsealing_says_what_counts_and_stays_on_record(fdvv: Run, study: Study) -> None:
    ran = fdvv("study", "unseal", "s", "--who", "A. Keeper", "--why", "all done", *WORDS)
    assert ran.status == 0, ran.err
    assert ran.out == f"4 trials, 4 count\nwritten to {Path('s') / 'unsealed'}\n"
    assert "by A. Keeper: all done" in fdvv("study", "status", "s").out
    again = fdvv("study", "unseal", "s", "--who", "B", "--why", "once more", "--json", *WORDS)
    assert (again.json["rows"], again.json["counted"], again.json["excluded"]) == (4, 4, {})
    assert len(fdvv("study", "status", "s", "--json").json["unsealed"]) == 2
    assert study.verify() == ()


def test_a_wrong_passphrase_is_one_clear_line(fdvv: Run, study: Study) -> None:
    ran = fdvv("study", "unseal", "s", "--who", "A", "--why", "B", "--passphrase-file", "wrong.txt")
    assert (ran.status, ran.out, ran.err.count("\n")) == (2, "", 1)
    assert "passphrase: does not open it" in ran.err
    assert not (study.folder / "unsealed").exists()


def test_a_keepers_file_that_was_moved_is_named(fdvv: Run, study: Study) -> None:
    (study.folder / "keeper.json").rename("moved.json")
    asked = ("study", "unseal", "s", "--who", "A", "--why", "B", *WORDS)
    assert fdvv(*asked).status == 2
    assert fdvv(*asked, "--keeper", "moved.json").status == 0


def test_who_withdraws_is_gone_and_on_record(fdvv: Run, study: Study) -> None:
    ran = fdvv("study", "withdraw", "s", "P01", "--yes")
    assert (ran.status, ran.out) == (0, "P01 has withdrawn; all is deleted\n")
    assert not (study.folder / "people" / "P01").exists()
    assert "deleted" in fdvv("study", "status", "s").out
    assert fdvv("study", "verify", "s", *WORDS).status == 0


def test_withdrawing_asks_before_it_deletes(fdvv: Run, study: Study, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("click.termui.visible_prompt_func", lambda _text: "n")
    assert fdvv("study", "withdraw", "s", "P01").status == 130
    assert study.person("P01").state == "finished"
    ran = fdvv("study", "withdraw", "s", "P01", "--keep", "--json")
    assert ran.json == {"person": "P01", "deleted": False}
    assert study.person("P01").state == "withdrawn"


@pytest.mark.parametrize("command", ["verify", "status", "freeze", "simulate"])
def test_a_folder_without_a_study_is_one_clear_line(fdvv: Run, tmp_path: Path, command: str) -> None:
    (tmp_path / "empty").mkdir()
    ran = fdvv("study", command, "empty")
    assert (ran.status, ran.err.count("\n")) == (2, 1)
    assert "holds no study" in ran.err

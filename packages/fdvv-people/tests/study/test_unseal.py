"""Unsealing is recorded before anything can be read, and the frozen rules say what does not count."""

from __future__ import annotations

import csv
from pathlib import Path

import msgspec
import numpy as np
import pytest

from fdvv.errors import InputError
from fdvv_people.study.admin.study import Study
from fdvv_people.study.analysis.unseal import exclude_people, trial_reason
from fdvv_people.study.plan.answers import Answers
from fdvv_people.study.plan.plan import Exclusion
from fdvv_people.study.plan.trial import EQUAL, Rendered, StudyTrial, TrialAnswer
from tests.support.kill import Killed, kill_at
from tests.support.studies import (
    CHEAP,
    PASSPHRASE,
    all_files,
    answered,
    chosen,
    in_haste,
    rendered,
    small_study,
)


def table(study: Study, name: str) -> list[dict[str, str]]:
    with (study.folder / "unsealed" / name).open(newline="") as stream:
        return list(csv.DictReader(stream))


@pytest.fixture(scope="module")
def unsealed(tmp_path_factory: pytest.TempPathFactory) -> tuple[Study, Answers]:
    """Return a study with one person who prefers FDVV and is done, and one who stopped early."""
    with in_haste():
        study = small_study(tmp_path_factory.mktemp("unsealed"))
        for name, trials in (("FDVV", None), ("FD", 3)):
            person, code = study.enrol(cost=CHEAP)
            answered(study, person, code, chosen(name), trials=trials)
        return study, study.unseal(PASSPHRASE, "  The   keeper ", "all are done")


def test_answers_by_label_become_answers_by_what_was_felt(unsealed: tuple[Study, Answers]) -> None:
    study, answers = unsealed
    one = answers.person == "P01"
    assert answers.stimuli == ("FD", "FDVV")
    assert answers.choice[one].tolist() == ["FDVV"] * 4
    assert answers.ratings["realism"][one].tolist() == [[3.0, 5.0]] * 4
    assert sorted(zip(answers.item[one], answers.round[one], strict=True)) == [
        ("clear", 0), ("clear", 1), ("red", 0), ("red", 1),
    ]  # fmt: skip
    assert answers.counts[one].all()
    assert not answers.simulated
    assert study.fingerprint


def test_what_was_not_answered_is_missing_and_not_left_out(unsealed: tuple[Study, Answers]) -> None:
    _, answers = unsealed
    two = answers.person == "P02"
    assert answers.choice[two].tolist() == ["FD", "FD", "", ""]
    assert np.isnan(answers.ratings["realism"][two][2:]).all()
    assert not answers.counts[two].any()


def test_it_is_on_record_who_did_it_why_and_when(unsealed: tuple[Study, Answers]) -> None:
    study, _ = unsealed
    (record,) = [one["unsealed"] for one in study.history() if "unsealed" in one]
    assert (record["who"], record["why"], record["problems"]) == ("The keeper", "all are done", [])
    assert record["when"].startswith("20")


def test_trials_that_are_still_to_come_are_not_shown(unsealed: tuple[Study, Answers]) -> None:
    study, _ = unsealed
    rows = [row for row in table(study, "rendered.csv") if row["person"] == "P02"]
    assert {row["trial"] for row in rows} == {"0", "1", "2"}
    for row in table(study, "answers.csv"):
        assert bool(row["choice"]) == bool(row["time_s"])


def test_the_tables_tell_what_was_rendered_and_what_pages_asked(unsealed: tuple[Study, Answers]) -> None:
    study, _ = unsealed
    first = table(study, "rendered.csv")[0]
    assert (first["person"], first["practice"], first["presses"], first["switches"]) == ("P01", "1", "2", "1")
    assert (first["largest_error_cN"], first["errors_cN"]) == ("2.000", "2.000 1.000")
    assert table(study, "pages.csv")[0] == {
        "person": "P01",
        "page": "about",
        "question": "age",
        "answer": "33.0",
    }
    assert (study.folder / "unsealed" / "codebook.json").is_file()


@pytest.mark.parametrize(
    ("words", "who", "why", "reason"),
    [
        ("four words of no sensE", "me", "why", "passphrase: does not open it"),
        (PASSPHRASE, "", "why", "who: whole: is empty"),
        (PASSPHRASE, "me", " \n ", "why: whole: is empty"),
    ],
)
def test_a_refused_unsealing_leaves_no_trace(
    tmp_path: Path, words: str, who: str, why: str, reason: str
) -> None:
    study = small_study(tmp_path)
    before = {path: path.read_bytes() for path in all_files(study.folder)}
    with pytest.raises(InputError, match=reason) as caught:
        study.unseal(words, who, why)
    assert "\n" not in str(caught.value)
    assert {path: path.read_bytes() for path in all_files(study.folder)} == before


@pytest.mark.parametrize("step", range(1, 30, 7))
def test_nothing_is_readable_before_the_record_is_on_the_disk(
    tmp_path: Path, step: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    study = small_study(tmp_path)
    person, code = study.enrol(cost=CHEAP)
    answered(study, person, code, chosen("FDVV"), trials=2)
    try:
        with kill_at(step, monkeypatch):
            study.unseal(PASSPHRASE, "me", "to see")
    except Killed:
        recorded = any("unsealed" in record for record in study.history())
        assert recorded or not (study.folder / "unsealed").exists()
    assert study.verify(study.fingerprint, PASSPHRASE) == ()
    assert len(study.unseal(PASSPHRASE, "me", "again").person) == 4


def test_a_changed_study_is_unsealed_only_despite_it_and_that_is_on_record(tmp_path: Path) -> None:
    study = small_study(tmp_path)
    for _ in range(2):
        person, code = study.enrol(cost=CHEAP)
        answered(study, person, code, chosen("FDVV"))
    path = study.person_folder("P02") / "session.jsonl"
    path.write_bytes(path.read_bytes().replace(b'"choice": "A"', b'"choice": "B"', 1))
    with pytest.raises(InputError, match=r"people/P02/session\.jsonl: line"):
        study.unseal(PASSPHRASE, "me", "done")
    answers = study.unseal(PASSPHRASE, "me", "done", despite=True)
    assert answers.counts[answers.person == "P01"].all()
    assert not answers.counts[answers.person == "P02"].any()
    (record,) = [one["unsealed"] for one in study.history() if "unsealed" in one]
    assert record["problems"][0].startswith("people/P02/session.jsonl")


def test_abx_answers_are_right_or_wrong(tmp_path: Path) -> None:
    study = small_study(tmp_path, kind="abx")

    def judge(trial: StudyTrial) -> TrialAnswer:
        right = trial.labels["A"] == trial.labels["X"]
        assert trial.correct == ("A" if right else "B")
        answer = chosen("FD")(trial)
        return msgspec.structs.replace(answer, choice="A")

    person, code = study.enrol(cost=CHEAP)
    answered(study, person, code, judge)
    answers = study.unseal(PASSPHRASE, "me", "done")
    rows = table(study, "rendered.csv")
    for item, round_, correct in zip(answers.item, answers.round, answers.correct, strict=True):
        hidden = {
            row["label"]: row["stimulus"]
            for row in rows
            if (row["item"], row["round"], row["practice"]) == (item, str(round_), "0")
        }
        assert correct == float(hidden["A"] == hidden["X"])
    # who gives one label always is out by rule
    assert set(answers.excluded.tolist()) == {"the person gave one label in 100 % of the trials"}


SOUND = Rendered("A", "FD", 2, (3.0, 4.0), (100.0, None), 2)
WORSE = msgspec.structs.replace(SOUND, error_cN=(20.0, 20.2))


@pytest.mark.parametrize(
    ("rendered", "reason"),
    [
        ((SOUND,), ""),
        ((), "no record of what was rendered"),
        ((SOUND, WORSE), "missed its force by 20.1"),
        ((msgspec.structs.replace(SOUND, error_cN=(None, 1.0, 9.9, 99.0)),), ""),
        ((SOUND, msgspec.structs.replace(SOUND, presses=0, error_cN=())), "pressed 0 times, fewer than 1"),
        ((msgspec.structs.replace(SOUND, faults=("overheated",)), SOUND), "device fault: overheated"),
    ],
)  # fmt: skip
def test_a_trial_counts_by_what_was_rendered_in_it(rendered: tuple[Rendered, ...], reason: str) -> None:
    found = trial_reason(Exclusion(), rendered)
    assert reason in found
    assert bool(reason) == bool(found)


def test_a_fault_counts_where_the_rule_says_so() -> None:
    faulty = msgspec.structs.replace(SOUND, faults=("overheated",))
    assert trial_reason(Exclusion(fault=False), (faulty,)) == ""


def test_a_failed_rendering_takes_its_trial_out_and_no_other(tmp_path: Path) -> None:
    study = small_study(tmp_path, rounds=4)
    person, code = study.enrol(cost=CHEAP)

    def render(trial: StudyTrial) -> tuple[Rendered, ...]:
        return rendered(trial, error_cN=30.0 if trial.number == 4 else 1.0)

    answered(study, person, code, chosen("FDVV"), render)
    answers = study.unseal(PASSPHRASE, "me", "done")
    assert answers.excluded is not None
    assert answers.excluded.tolist().count("") == 7
    assert answers.excluded[3] == "half the presses of a rendering missed its force by 22.5 cN, more than 20"


def columns(choices: list[str]) -> Answers:
    n = len(choices)
    return Answers(
        "realism", ("FD", "FDVV"), np.array(["P01"] * n), np.array(["one"] * n), np.arange(n),
        np.array(choices), np.full(n, np.nan), excluded=np.array([""] * n, "<U80"),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("labels", "out"),
    [
        (["A"] * 10, True),
        (["A"] * 10 + ["B"], True),
        (["A"] * 9 + ["B"], False),
        ([EQUAL] * 10, False),
        (["A", "B"] * 5, False),
    ],
)
def test_who_gives_one_label_too_often_is_out_but_not_who_finds_all_equal(
    labels: list[str], out: bool
) -> None:
    found = exclude_people(columns(["FD"] * len(labels)), labels, Exclusion())
    assert found.counts.tolist() == [not out] * len(labels)


def test_the_claim_says_which_of_two_a_preference_counts_for(tmp_path: Path) -> None:
    from fdvv_people.study.analysis.unseal import stimuli_in_order

    study = small_study(tmp_path)
    plan = study.plan
    assert stimuli_in_order(plan) == ("FD", "FDVV")
    from fdvv_people.study.plan.plan import Claim

    turned = msgspec.structs.replace(plan, claim=Claim(more="FD", less="FDVV"))
    assert stimuli_in_order(turned) == ("FDVV", "FD")

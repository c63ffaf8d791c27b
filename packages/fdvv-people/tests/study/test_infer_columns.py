"""Foreign tables are understood by their headings and cells; a trial that stands twice is refused."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import InputError
from fdvv_people.study.analysis.columns import ColumnMap
from fdvv_people.study.analysis.read_answers import AnswersTable, read_table
from fdvv_people.study.plan.answers import Answers
from fdvv_people.study.plan.trial import EQUAL
from tests.support.study_answers import realism

HEAD = "participant,button,trial,model,rating,preferred\n"


def written(path: Path, answers: Answers, trial: str = "round", preferred: str = "name") -> AnswersTable:
    """Write a row for each rating, as somebody else would, and read it without any help."""
    rows, number = [], 0
    for i, person in enumerate(answers.person):
        for k, stimulus in enumerate(answers.stimuli):
            number += 1
            choice = answers.choice[i]
            chosen = choice == stimulus
            flag = {"name": choice or "NA", "1": int(chosen), "yes": "yes" if chosen else "no"}
            value = answers.ratings["realism"][i, k]
            rating = "" if np.isnan(value) else value
            count = 1 + answers.round[i] if trial == "round" else number
            cells = (person, answers.item[i], count, stimulus, rating, flag[preferred])
            rows.append(",".join(map(str, cells)))
    path.write_text(HEAD + "\n".join(rows) + "\n")
    return read_table(path)


@pytest.mark.parametrize("trial", ["round", "row"])
@pytest.mark.parametrize("preferred", ["name", "1", "yes"])
def test_a_row_a_rating_is_understood_without_any_flag(trial: str, preferred: str, tmp_path: Path) -> None:
    answers = realism(5, 3, ("Clear", "Red"))
    answers.ratings["realism"][4, 1] = np.nan
    found = written(tmp_path / "a.csv", answers, trial, preferred)
    assert found.answers.choice.tolist() == answers.choice.tolist()
    assert found.answers.person.tolist() == answers.person.tolist()
    np.testing.assert_array_equal(found.answers.ratings["rating"], answers.ratings["realism"])
    assert (found.answers.kind, found.answers.stimuli) == ("realism", ("FD", "FDVV"))
    assert found.columns["person"] == "participant"
    assert ("round" in found.columns) == (trial == "round")
    assert found.unused == (() if trial == "round" else ("trial",))


@pytest.mark.parametrize(
    ("text", "roles"),
    [
        (
            "Subject ID,Switch,Block,Preference,realism_FD,realism_FDVV\ns1,A,1,FD,3,6\ns1,A,2,tie,4,4\n",
            {"person": "Subject ID", "item": "Switch", "round": "Block", "choice": "Preference",
             "realism:FD": "realism_FD", "realism:FDVV": "realism_FDVV"},
        ),
        (
            "observer;key;preferred;FD;FDVV\no1;A;FD;3,5;6\no2;A;FDVV;4;4,5\n",
            {"person": "observer", "item": "key", "choice": "preferred",
             "rating:FD": "FD", "rating:FDVV": "FDVV"},
        ),
        (
            "participant,model,points\np1,A,3\np1,B,6\n",
            {"person": "participant", "stimulus": "model", "points": "points"},
        ),
    ],
)  # fmt: skip
def test_other_layouts_are_understood_too(text: str, roles: dict[str, str], tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text(text)
    found = read_table(tmp_path / "a.csv")
    assert dict(found.columns) == roles
    assert found.guessed == set(roles)
    if "tie" in text:
        assert found.answers.choice.tolist() == ["FD", EQUAL]


def test_what_a_map_says_is_not_inferred(tmp_path: Path) -> None:
    text = "participant,user,model,rating,score\np1,u1,A,3,7\np1,u1,B,6,8\n"
    (tmp_path / "a.csv").write_text(text)
    asked = ColumnMap(columns={"person": "user", "score": "score"})
    found = read_table(tmp_path / "a.csv", asked)
    assert found.answers.person.tolist() == ["u1"]
    np.testing.assert_array_equal(found.answers.ratings["score"], [[7, 8]])
    assert found.unused == ("participant", "rating")


def test_choices_alone_are_a_preference_and_with_ties_a_2ac(tmp_path: Path) -> None:
    for words, kind in ((("A", "B"), "preference"), (("A", "same", "B"), "2ac")):
        rows = [f"p{i},A1,{word}\n" for i, word in enumerate(words)]
        (tmp_path / "a.csv").write_text("participant,button,preferred\n" + "".join(rows))
        assert read_table(tmp_path / "a.csv").answers.kind == kind


def test_a_trial_with_two_choices_is_refused(tmp_path: Path) -> None:
    text = HEAD + "p1,A,1,FD,3,FD\np1,A,1,FDVV,4,FDVV\n"
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(
        InputError, match="line 3, column 'preferred': 'FD' and 'FDVV' are chosen in one trial"
    ):
        read_table(tmp_path / "a.csv")


PEOPLE, BUTTONS, TRIALS = ("P1", "P2", "P3"), ("Clear", "Red"), (1, 2, 3)
FREE, TIMED = ColumnMap(), ColumnMap(kind="timing")

# what a kind of table holds: its headings, the cells of a trial's rows, cells of another answer
CHOICES = ("preferred", ["FD", "FDVV"], "FDVV")
WIDE = ("realism_FD,realism_FDVV,preferred", ["3,6,FDVV", "4,4,equal"], "5,2,FD")
LONG = ("model,rating", ["FD,3", "FDVV,6"], "FDVV,1")
TIMES = ("condition,asynchrony_ms", ["easy,30.5", "hard,41"], "hard,12")
KINDS = [(CHOICES, FREE), (WIDE, FREE), (LONG, FREE), (TIMES, TIMED)]


def table(path: Path, head: str, rows: Sequence[str], asked: ColumnMap = FREE) -> AnswersTable:
    path.write_text("\n".join([head, *rows]) + "\n")
    return read_table(path, asked)


def trials(cells: Sequence[str], long: bool = False, before: str = "") -> list[str]:
    """Write a row of every person, button and trial, with the cells in turn; long : with all of them."""
    rows = []
    for number, (person, button, trial) in enumerate(product(PEOPLE, BUTTONS, TRIALS)):
        answers = cells if long else [cells[number % len(cells)]]
        rows += [f"{before}{person},{button},{trial},{answer}" for answer in answers]
    return rows


@pytest.mark.parametrize("trial", ["trial", "Trial_Number", "block", "repetition"])
@pytest.mark.parametrize(("kind", "asked"), KINDS, ids=["choices", "wide", "long", "timing"])
def test_a_trial_that_stands_twice_is_refused_with_both_lines(
    kind: tuple[str, list[str], str], asked: ColumnMap, trial: str, tmp_path: Path
) -> None:
    heads, cells, other = kind
    head, rows = f"participant,button,{trial},{heads}", trials(cells, long=kind in (LONG, TIMES))
    assert table(tmp_path / "a.csv", head, rows, asked).columns["round"] == trial
    for place, row in enumerate(rows):
        named = row.split(",")
        again = [*named[:3], *(other.split(",") if kind in (CHOICES, WIDE) else [named[3], "7"])]
        for repeat, how in ((row, "word for word"), (",".join(again), "with another")):
            if how == "with another" and repeat == row:
                continue
            with pytest.raises(InputError) as refused:
                table(tmp_path / "a.csv", head, [*rows, repeat], asked)
            said = str(refused.value)
            assert f"line {len(rows) + 2}: is the trial of line {place + 2} once more, {how}" in said
            assert f": {trial} {named[2]}, participant {named[0]}, button {named[1]}" in said


def test_a_column_that_is_mapped_as_the_round_is_refused_alike(tmp_path: Path) -> None:
    for (heads, cells, _), asked in KINDS:
        head, rows = f"participant,button,pass,{heads}", trials(cells, long="equal" not in cells[1])
        mapped = ColumnMap(kind=asked.kind, columns={"round": "pass"})
        if heads == CHOICES[0]:
            rows = trials(cells)
        table(tmp_path / "a.csv", head, rows, mapped)
        with pytest.raises(
            InputError, match=r"line \d+: P1 has a second row of Clear.*, round 1, after line 2;"
        ):
            table(tmp_path / "a.csv", head, [*rows, rows[0]], mapped)


def test_of_a_rendering_that_was_not_rated_a_second_row_is_seen_too(tmp_path: Path) -> None:
    rows = ["p1,Clear,1,FD,1", "p1,Clear,1,FDVV,0", "p1,Clear,1,FD,1"]
    with pytest.raises(InputError, match="line 4: p1 has a second row of Clear, FD, round 1, after line 2"):
        table(tmp_path / "a.csv", "person,item,round,stimulus,is_chosen", rows)


PART_HEADS = ["block", "Block Nr", "session_id", "day", "phase", "lighting"]


@pytest.mark.parametrize("part", PART_HEADS)
def test_trials_that_are_numbered_anew_in_each_part_are_no_repeats(part: str, tmp_path: Path) -> None:
    parts = ("1", "2") if part != "lighting" else ("dim", "bright")
    rows = [row for name in parts for row in trials(WIDE[1], before=f"{name},")]
    found = table(tmp_path / "a.csv", f"{part},participant,button,trial,{WIDE[0]}", rows)
    assert len(found.answers.person) == len(rows)
    with pytest.raises(InputError, match=f"line {len(rows) + 2}: is the trial of line 5 once more"):
        table(tmp_path / "a.csv", f"{part},participant,button,trial,{WIDE[0]}", [*rows, rows[3]])


def test_a_number_that_holds_several_rows_is_none_of_a_trial(tmp_path: Path) -> None:
    for head in ("block", "run", "repeat", "trial"):
        rows = [
            f"{p},{b},{k},{word}" for p, b, k in product(PEOPLE, BUTTONS, (0, 1)) for word in ("FD", "FDVV")
        ]
        found = table(tmp_path / "a.csv", f"participant,button,{head},preferred", rows)
        assert len(found.answers.person) == len(rows)
        assert "round" not in found.columns


@pytest.mark.shared
def test_a_log_of_taps_has_many_in_each_trial(shared_data: Path) -> None:
    taps = shared_data / "baath-sync-tapping" / "tapping_data_baath_madison_2012.subjects01-15.csv"
    asked = ColumnMap(kind="timing", columns={"stimulus": "isi", "asynchrony_ms": "asynch"})
    read = read_table(taps, asked)
    assert len(read.answers.person) > 1000
    assert read.unused == ("trial",)


def test_what_is_left_out_or_not_numbered_is_no_repeat(tmp_path: Path) -> None:
    head = "participant,button,trial,preferred,excluded"
    rows = [f"{row},no" for row in trials(["FD", "FDVV"])]
    redone = ["P1,Clear,2,FD,slipped", "P1,Red,,FD,practice", "P1,Red,,FD,practice"]
    found = table(tmp_path / "a.csv", head, [*rows, *redone])
    assert len(found.answers.person) == len(rows) + 3
    assert found.answers.excluded is not None
    assert np.count_nonzero(found.answers.excluded != "") == 3

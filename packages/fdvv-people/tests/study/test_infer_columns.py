"""Foreign tables are understood by their headings and by what stands in them."""

from __future__ import annotations

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

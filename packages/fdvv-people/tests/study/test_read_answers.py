from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import InputError
from fdvv_people.study.analysis.code_book import write_answers
from fdvv_people.study.analysis.columns import ColumnMap
from fdvv_people.study.analysis.read_answers import read_answers
from fdvv_people.study.plan.answers import Answers
from fdvv_people.study.plan.trial import EQUAL
from tests.support.study_answers import realism

NAMES = st.text(st.characters(codec="utf-8", exclude_categories=("C", "Z")), min_size=1, max_size=8)


def is_word(name: str) -> bool:
    return name.lower() not in ("na", "n/a", "nan", "null", "none", ".", EQUAL)


@st.composite
def answered(draw: st.DrawFn) -> Answers:
    """Return answers with names of any kind, ties and gaps."""
    stimuli = tuple(draw(st.lists(NAMES.filter(is_word), min_size=2, max_size=3, unique=True)))
    people = draw(st.lists(NAMES, min_size=1, max_size=3, unique=True))
    items = draw(st.lists(NAMES, min_size=1, max_size=2, unique=True))
    rows = [(p, i, r) for p in people for i in items for r in range(2)]
    n = len(rows)
    number = st.one_of(st.just(np.nan), st.floats(-1e6, 1e6))
    column = st.lists(number, min_size=n, max_size=n).map(np.array)
    ratings = {"realism": np.column_stack([draw(column) for _ in stimuli])}
    return Answers(
        draw(st.sampled_from(["realism", "2ac", "mushra"])),
        stimuli,
        person=np.array([one[0] for one in rows]),
        item=np.array([one[1] for one in rows]),
        round=np.array([one[2] for one in rows]),
        choice=np.array([draw(st.sampled_from([*stimuli, EQUAL, ""])) for _ in rows]),
        correct=np.array([draw(st.sampled_from([0.0, 1.0, np.nan])) for _ in rows]),
        ratings=ratings,
        time_s=draw(column),
        excluded=np.array([draw(st.sampled_from(["", "fault: jam, twice", 'said "no"'])) for _ in rows]),
        simulated=draw(st.booleans()),
    )


def assert_same(found: Answers, wanted: Answers) -> None:
    assert (found.kind, found.stimuli, found.simulated) == (wanted.kind, wanted.stimuli, wanted.simulated)
    for name in ("person", "item", "round", "choice", "excluded"):
        assert getattr(found, name).tolist() == getattr(wanted, name).tolist()
    np.testing.assert_array_equal(found.correct, wanted.correct)
    assert list(found.ratings) == list(wanted.ratings)
    for name, column in wanted.ratings.items():
        np.testing.assert_array_equal(found.ratings[name], column)
    if wanted.time_s is not None and np.isfinite(wanted.time_s).any():
        assert found.time_s is not None
        np.testing.assert_array_equal(found.time_s, wanted.time_s)


@settings(max_examples=12, deadline=None)
@given(answered())
def test_answers_that_were_written_are_read_back_alike(answers: Answers) -> None:
    import tempfile

    with tempfile.TemporaryDirectory() as name:
        write_answers(Path(name), answers)
        assert_same(read_answers(Path(name)), answers)


def foreign(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "table.csv"
    path.write_text(text, encoding="utf-8")
    return path


MAPPED = ColumnMap(
    kind="realism",
    stimuli=("FD", "FDVV"),
    columns={
        "person": "subject", "item": "button", "choice": "answer", "round": "block",
        "realism:FD": "fd", "realism:FDVV": "fdvv",
    },
    codes={"1": "FDVV", "2": "FD", "0": EQUAL},
    missing=frozenset({"-99"}),
)  # fmt: skip


def test_a_foreign_table_with_a_row_a_trial_is_read_as_it_is_mapped(tmp_path: Path) -> None:
    text = "subject,button,block,answer,fd,fdvv\ns1,Clear,1,1,3,6\ns1,Clear,2,0,4,4\ns1,Red,1,-99,NA,5\n"
    answers = read_answers(foreign(tmp_path, text), MAPPED)
    assert answers.choice.tolist() == ["FDVV", EQUAL, ""]
    np.testing.assert_array_equal(answers.ratings["realism"], [[3, 6], [4, 4], [np.nan, 5]])
    assert answers.round.tolist() == [1, 2, 1]


def test_a_row_a_person_and_button_with_two_ratings_needs_no_choice_and_no_round(tmp_path: Path) -> None:
    text = '"id";"switch";"m_fd";"m_fdvv"\n"1";"Clear";"3,5";"5,17"\n"2";"Clear";"4";"4,0"\n'
    columns = {"person": "id", "item": "switch", "realism:FD": "m_fd", "realism:FDVV": "m_fdvv"}
    answers = read_answers(foreign(tmp_path, text), ColumnMap(columns=columns))
    assert (answers.kind, answers.stimuli) == ("realism", ("FD", "FDVV"))
    np.testing.assert_array_equal(answers.ratings["realism"], [[3.5, 5.17], [4, 4]])


def test_a_row_a_rating_becomes_a_row_a_trial(tmp_path: Path) -> None:
    text = "person,item,model,score\n" + "".join(
        f"p{p},Clear,{m},{s}\n" for p in (1, 2) for m, s in (("FDVV", 6), ("FD", 2), ("FDVV", 5), ("FD", 3))
    )
    asked = ColumnMap(columns={"stimulus": "model", "realism": "score"})
    answers = read_answers(foreign(tmp_path, text), asked)
    assert answers.stimuli == ("FD", "FDVV")
    np.testing.assert_array_equal(answers.ratings["realism"], [[2, 6], [3, 5]] * 2)
    assert answers.round.tolist() == [0, 1, 0, 1]


def test_a_table_that_fdvv_wrote_is_known_by_its_headings_without_its_code_book(tmp_path: Path) -> None:
    text = "person,item,round,choice,realism_FD,realism_FDVV,simulated\nP01,Clear,0,FDVV,3,6,1\n"
    answers = read_answers(foreign(tmp_path, text), ColumnMap(stimuli=("FD", "FDVV")))
    assert answers.simulated
    np.testing.assert_array_equal(answers.ratings["realism"], [[3, 6]])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "it is empty"),
        ("subject,button,block,answer,fd,fdvv\n", "holds headings and no answer"),
        ("subject,button,answer,fd,fdvv\ns1,Clear,1,3,6\n", "no column 'block'"),
        ("subject,button,block,answer,fd,fd\n", "two columns are called 'fd'"),
        ("subject,button,block,answer,fd,fdvv\ns1,Clear,1,1,3\n", "line 2: 5 cells under 6 headings"),
        ("subject,button,block,answer,fd,fdvv\ns1,Clear,1,7,3,6\n", "'7' is none of FD, FDVV"),
        ("subject,button,block,answer,fd,fdvv\ns1,Clear,1,1,3,six\n", "column 'fdvv': 'six' is not a number"),
        ("subject,button,block,answer,fd,fdvv\n,Clear,1,1,3,6\n", "nobody is named"),
        (
            "subject,button,block,answer,fd,fdvv\ns1,Clear,1,1,3,6\ns1,Clear,1,2,3,6\n",
            "line 3: s1 has a second row of Clear, round 1",
        ),
    ],
)
def test_what_cannot_be_read_is_refused_in_one_line_with_its_place(
    tmp_path: Path, text: str, said: str
) -> None:
    with pytest.raises(InputError) as refused:
        read_answers(foreign(tmp_path, text), MAPPED)
    assert said in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_table_without_people_or_answers_says_which_columns_there_are(tmp_path: Path) -> None:
    path = foreign(tmp_path, "who,what\na,b\n")
    with pytest.raises(InputError) as refused:
        read_answers(path, ColumnMap(columns={"item": "what"}))
    assert refused.value.reason == "no column holds an answer"
    assert refused.value.details == {"missing": ["answer"], "columns": ["who", "what"]}
    path = foreign(tmp_path, "a,b\n1,2\n")
    with pytest.raises(InputError, match=r"says who answered and no column holds .*there are 'a', 'b'"):
        read_answers(path)
    with pytest.raises(InputError, match=r"there is none of .x., .y. among 'a', 'b'"):
        read_answers(path, ColumnMap(columns={"person": "x", "choice": "y"}))


def test_the_documents_lines_for_pandas_read_what_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("pandas")
    write_answers(tmp_path, realism(4, 2, ("Clear", "Red")))
    page = Path(__file__).parents[4] / "docs" / "reference" / "answers-file.md"
    code = page.read_text().split("```python\n")[1].split("```")[0]
    monkeypatch.chdir(tmp_path)
    found: dict[str, Any] = {}
    exec(code, found)
    assert found["means"].shape == (8, 2)
    np.testing.assert_allclose(found["shares"].sum(axis=1), 1.0)

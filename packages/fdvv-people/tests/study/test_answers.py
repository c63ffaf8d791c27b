from __future__ import annotations

from dataclasses import replace

import numpy as np

from fdvv_people.study.plan.answers import Answers, screen
from fdvv_people.study.plan.plan import Exclusion
from tests.support.study_answers import mushra, realism


def lacking(part: float) -> Answers:
    """Return a study in which the first person lacks that part of the trials."""
    answers = realism(4, 6)
    rows = np.flatnonzero(answers.person == "P01")
    gone = rows[: round(part * rows.size)]
    choice, ratings = answers.choice.copy(), answers.ratings["realism"].copy()
    choice[gone], ratings[gone] = "", np.nan
    return replace(answers, choice=choice, ratings={"realism": ratings})


def test_whole_answers_are_left_as_they_are() -> None:
    found = screen(realism(12, 6))
    assert (found.planned, found.answered, found.counted, found.people_counted) == (432, 432, 432, 12)
    assert found.reasons == {}
    assert found.left_out == {}
    assert found.answers.counts.all()


def test_who_lacks_more_than_the_rule_allows_is_left_out_with_every_trial() -> None:
    assert screen(lacking(0.25)).left_out == {}
    found = screen(lacking(0.3))
    assert list(found.left_out) == ["P01"]
    assert not found.answers.counts[found.answers.person == "P01"].any()
    assert found.counted == 3 * 36
    assert found.reasons == {"more than 25 % of the person's trials are missing": 25}
    assert screen(lacking(0.3), Exclusion(share_missing=0.5)).left_out == {}


def test_trials_that_do_not_count_are_missing_too() -> None:
    answers = realism(4, 6)
    fault = (answers.person == "P02") & (answers.round < 2)
    found = screen(replace(answers, excluded=np.where(fault, "device fault", "")))
    assert list(found.left_out) == ["P02"]
    assert found.reasons["device fault"] == 12


def test_screening_twice_changes_nothing() -> None:
    first = screen(lacking(0.5))
    again = screen(first.answers)
    assert again.answers.excluded is not None
    assert first.answers.excluded is not None
    assert again.answers.excluded.tolist() == first.answers.excluded.tolist()
    assert again.left_out == first.left_out


def test_who_was_left_out_beforehand_keeps_the_reason() -> None:
    answers = realism(4, 6)
    why = "the person gave one label in 97 % of the trials"
    found = screen(replace(answers, excluded=np.where(answers.person == "P03", why, "")))
    assert found.left_out == {"P03": why}


def test_who_does_not_find_the_hidden_reference_is_left_out() -> None:
    answers = mushra()
    low = answers.ratings["quality"].copy()
    low[answers.person == "P02", 0] = 70.0
    found = screen(replace(answers, ratings={"quality": low}))
    assert list(found.left_out) == ["P02"]


def test_on_a_scale_of_seven_the_rule_about_the_reference_says_nothing() -> None:
    answers = mushra()
    assert screen(replace(answers, ratings={"quality": answers.ratings["quality"] / 100 * 7})).left_out == {}

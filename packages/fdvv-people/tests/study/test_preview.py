"""What a plan comes to, against counts made by hand."""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from fdvv_people.study.admin.preview import summarise_plan
from fdvv_people.study.plan.plan import StudyPlan
from fdvv_people.study.plan.plan_file import read_plan_text, template_text


def shipped(name: str) -> StudyPlan:
    return read_plan_text(template_text(name), name)


def test_the_papers_study_takes_about_its_hour_with_two_breaks() -> None:
    account = summarise_plan(shipped("realism"))
    # 38 trials of 75 s are 47.5 min; breaks after 16 and 32 of them; three pages with 4 questions
    assert (account.trials, account.practice, account.breaks) == (36, 2, 2)
    assert account.minutes == pytest.approx(47.5 + 6 + 3 + 4 / 6)
    assert account.places == account.follows == (12, 12)
    assert account.notes == ()


@pytest.mark.parametrize(
    ("every_min", "breaks"), [(0.0, 0), (1.0, 37), (1.25, 37), (1.26, 18), (47.4, 0), (100.0, 0)]
)
def test_breaks_stand_between_trials_only(every_min: float, breaks: int) -> None:
    assert summarise_plan(replace(shipped("realism"), break_every_min=every_min)).breaks == breaks


def test_what_may_not_be_meant_is_remarked_on() -> None:
    plan = replace(
        shipped("realism"), people=7, rounds=2, pages=(), claim=None, practice=0, switch_s=0.0, ties=False
    )
    notes = " ".join(summarise_plan(plan).notes)
    for note in (
        "multiple of 6, 7 times 2 is 14",
        "consent",
        "claim",
        "two rounds",
        "practice",
        "switch_s",
        "2-AFC",
    ):
        assert note in notes
    assert summarise_plan(plan).places == (2, 3)


def test_one_button_and_random_orders_have_no_balance_to_tell() -> None:
    plan = shipped("realism")
    assert summarise_plan(replace(plan, order="random")).places is None
    assert summarise_plan(replace(plan, items=plan.items[:1])).follows is None

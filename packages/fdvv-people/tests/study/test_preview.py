"""What a plan comes to, against counts made by hand, and how far a study is, in a sentence."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from msgspec.structs import replace

from fdvv_people.stats.share import binomial_p
from fdvv_people.study.admin.preview import ALIKE, SHARE, planned_power, summarise_plan
from fdvv_people.study.admin.progress import draft_sentence, standing
from fdvv_people.study.labels import KIND
from fdvv_people.study.plan.plan_file import read_plan_text, template_text
from tests.browser.study_screens import frozen_study, plan_text

PLAN = read_plan_text(template_text("realism"), "realism")


def test_the_papers_study_takes_about_its_hour_with_two_breaks() -> None:
    account = summarise_plan(PLAN)
    # 38 trials of 75 s are 47.5 min; breaks after 16 and 32 of them; three pages with 4 questions
    assert (account.trials, account.practice, account.breaks) == (36, 2, 2)
    assert account.minutes == pytest.approx(47.5 + 6 + 3 + 4 / 6)
    assert account.places == account.follows == (12, 12)
    assert account.notes == ()


@pytest.mark.parametrize(
    ("every_min", "breaks"), [(0.0, 0), (1.0, 37), (1.25, 37), (1.26, 18), (47.4, 0), (100.0, 0)]
)
def test_breaks_stand_between_trials_only(every_min: float, breaks: int) -> None:
    assert summarise_plan(replace(PLAN, break_every_min=every_min)).breaks == breaks


def test_what_may_not_be_meant_is_remarked_on() -> None:
    plan = replace(PLAN, people=7, rounds=2, pages=(), claim=None, practice=0, switch_s=0.0, ties=False)
    notes = " ".join(summarise_plan(plan).notes)
    for note in ("multiple of 6, 7 times 2 is 14", "consent", "claim", "two rounds", "practice", "2-AFC"):
        assert note in notes
    assert "switch_s" in notes
    assert summarise_plan(plan).places == (2, 3)


def test_one_button_and_random_orders_have_no_balance_to_tell() -> None:
    assert summarise_plan(replace(PLAN, order="random")).places is None
    assert summarise_plan(replace(PLAN, items=PLAN.items[:1])).follows is None


def test_the_power_of_a_plan_is_how_often_simulated_answers_are_found() -> None:
    few = replace(PLAN, people=4, rounds=1)
    n = round(few.people * few.trials / (1 + (few.trials - 1) * ALIKE))
    answers = np.random.default_rng(1).binomial(n, SHARE, 20_000)
    found = (binomial_p(answers, np.full_like(answers, n)) <= 0.05) & (answers > n / 2)
    assert planned_power(few) == pytest.approx(found.mean(), abs=0.01)


def test_more_people_have_more_power_and_what_claims_no_choice_has_none() -> None:
    powers = [planned_power(replace(PLAN, people=people)) for people in (2, 6, 12, 24)]
    assert powers == sorted(powers)  # type: ignore[type-var]
    assert planned_power(read_plan_text(template_text("staircase"), "staircase")) is None
    assert planned_power(replace(PLAN, claim=None)) is None


def test_a_draft_says_what_it_comes_to_or_what_is_missing() -> None:
    sentence, kind = draft_sentence(PLAN, (), KIND.promise(PLAN))
    assert sentence.startswith("Ready to freeze: 12 participants × 36 trials, power 0.")
    assert kind == "good"
    missing = draft_sentence(PLAN, ("rounds: too few", "people: none"))
    assert missing == ("Not ready to freeze: rounds: too few (and 1 more).", "warning")


def test_a_frozen_study_counts_who_is_there_and_who_is_done(tmp_path: Path) -> None:
    study = frozen_study(tmp_path, plan_text())
    assert standing(study) == ("0 of 2 participants done.", "")
    study.enrol("en")
    assert standing(study) == ("0 of 2 participants done; 1 at it.", "")

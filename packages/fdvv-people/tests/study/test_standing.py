"""How far a study is, in a sentence."""

from __future__ import annotations

from pathlib import Path

import msgspec
import numpy as np
import pytest

from fdvv_people.stats.share import binomial_p
from fdvv_people.study.admin.preview import ALIKE, SHARE, planned_power
from fdvv_people.study.admin.progress import draft_sentence, standing
from fdvv_people.study.labels import KIND
from fdvv_people.study.plan.plan_file import read_plan_text, template_text
from tests.browser.study_screens import frozen_study, plan_text

PLAN = read_plan_text(template_text("realism"), "realism")


def test_the_power_of_a_plan_is_how_often_simulated_answers_are_found() -> None:
    few = msgspec.structs.replace(PLAN, people=4, rounds=1)
    n = round(few.people * few.trials / (1 + (few.trials - 1) * ALIKE))
    answers = np.random.default_rng(1).binomial(n, SHARE, 20_000)
    found = (binomial_p(answers, np.full_like(answers, n)) <= 0.05) & (answers > n / 2)
    assert planned_power(few) == pytest.approx(found.mean(), abs=0.01)


def test_more_people_have_more_power_and_what_claims_no_choice_has_none() -> None:
    powers = [planned_power(msgspec.structs.replace(PLAN, people=people)) for people in (2, 6, 12, 24)]
    assert powers == sorted(powers)  # type: ignore[type-var]
    assert planned_power(read_plan_text(template_text("staircase"), "staircase")) is None
    assert planned_power(msgspec.structs.replace(PLAN, claim=None)) is None


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

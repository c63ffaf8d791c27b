"""Words of participants, in every language that is shipped."""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from fdvv_people.study.plan.plan_file import read_plan_text, template_names, template_text
from fdvv_people.study.plan.plan_words import (
    asks_choice,
    equal_text,
    offers_equal,
    question_text,
    word_languages,
)


@pytest.mark.parametrize("kind", template_names())
def test_every_kind_has_its_question_in_every_language(kind: str) -> None:
    plan = replace(read_plan_text(template_text(kind), kind), question={}, ties=True)
    asked = {question_text(plan, language) for language in word_languages()}
    assert len(asked) == len(word_languages()) >= 5
    if offers_equal(plan):
        assert len({equal_text(plan, language) for language in word_languages()}) >= 4
    assert asks_choice(plan) == (kind != "mushra")


def test_equal_is_offered_where_the_kind_knows_it_and_the_plan_wants_it() -> None:
    offered = {}
    for kind in template_names():
        plan = read_plan_text(template_text(kind), kind)
        offered[kind] = (offers_equal(replace(plan, ties=True)), offers_equal(replace(plan, ties=False)))
    tied = {kind for kind, (with_ties, _) in offered.items() if with_ties}
    assert tied == {"realism", "2ac", "preference"}
    assert [kind for kind, (_, without) in offered.items() if without] == ["2ac"]
    realism = read_plan_text(template_text("realism"), "realism")
    assert equal_text(realism, "de") == "Gleich"
    assert equal_text(replace(realism, ties=False), "de") == ""


def test_a_plans_own_words_go_first() -> None:
    plan = read_plan_text(template_text("2afc"), "2afc")
    assert question_text(plan, "en") == "Which one is heavier to press?"

"""Plans that read well and make no sense: each is refused, with its place."""

from __future__ import annotations

from typing import Any

import pytest
from msgspec.structs import replace

from fdvv_people.study.plan.plan import Claim, Item, Page, Question, Rating, Staircase, Stimulus, StudyPlan
from fdvv_people.study.plan.plan_check import plan_problems
from fdvv_people.study.plan.plan_file import read_plan_text, template_text

FD, FDVV = (Stimulus(name=n, button="mx-clear", rendered=n) for n in ("FD", "FDVV"))
BOTH = (FD, FDVV)
RATING = Rating(name="close", question={"en": "How close?"})
PLAN = StudyPlan(
    name="study",
    title={"en": "Study"},
    kind="realism",
    items=(Item(name="Clear", stimuli=(FD, FDVV)),),
    ratings=(RATING,),
)


def item(*stimuli: Stimulus, **about: Any) -> Item:
    return Item(name="Clear", stimuli=stimuli, **about)


def page(*questions: Question, **about: Any) -> Page:
    return Page(name="you", when="before", title={"en": "You"}, questions=questions, **about)


def question(**about: Any) -> Question:
    return Question(**{"name": "age", "question": {"en": "Age?"}, **about})


def file(name: str) -> Item:
    return item(FD, Stimulus(name="FDVV", button=name))


def test_the_plan_that_is_changed_below_has_no_problem() -> None:
    assert plan_problems(PLAN) == ()


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"items": ()}, "items: there is none"),
        ({"name": " study"}, "without spaces at its ends"),
        ({"name": "stu\ndy"}, "must be printable"),
        ({"items": (item(FD, FDVV), item(FD, FDVV))}, "'Clear' and 'Clear' are the same name"),
        ({"items": (item(FD, replace(FD, name="fd")),)}, "'fd' and 'FD' are the same name"),
        ({"items": (item(FD, replace(FD, name="FDVV")),)}, "one and the same rendering"),
        ({"items": (item(FD),)}, "exactly 2 stimuli, got 1"),
        ({"items": (item(FD, FDVV), Item(name="Red", stimuli=(FDVV, FD)))}, "the order of the first item's"),
        ({"items": (item(FD, replace(FDVV, name="Equal")),)}, "may not be called 'Equal'"),
        ({"items": (item(FD, replace(FDVV, name="a")),)}, "may not be called 'a'"),
        ({"items": (item(FD, replace(FDVV, name="X")),)}, "may not be called 'X'"),
        ({"items": (file("mx-pink"),)}, "'mx-pink' is neither built in"),
        ({"items": (file("../mx.fdvv.json"),)}, "must lie beside the study"),
        ({"items": (file("/mx.fdvv.json"),)}, "must lie beside the study"),
        ({"items": (file("c:\\mx.fdvv.json"),)}, "must lie beside the study"),
        ({"items": (file("buttons/mx.json"),)}, "does not end in .fdvv.json"),
        ({"items": (item(FD, replace(FDVV, actuation="a.json")),)}, "does not end in .actuation.json"),
        (
            {"items": (item(replace(FD, button="a.fdvv.json"), file("buttons/a.fdvv.json").stimuli[1]),)},
            "would be kept under one name",
        ),
        ({"languages": ()}, "languages: there is none"),
        ({"languages": ("en", "English")}, "'English' is not a code"),
        ({"languages": ("en", "de")}, "title: there is no text in 'de'"),
        ({"languages": ("en", "de")}, "ratings ('close'), question: there is no text in 'de'"),
        ({"languages": ("en", "nl")}, "fdvv has no words in 'nl'"),
        ({"title": {"en": "Study", "de": "Studie"}}, "'de' is not one of the study's languages"),
        ({"title": {"en": "  "}}, "title: there is no text in 'en'"),
        ({"question": {"de": "?"}}, "question: there is no text in 'en'"),
        ({"ratings": (replace(RATING, low={"de": "gar nicht"}),)}, "low: there is no text in 'en'"),
        ({"ratings": (RATING, RATING)}, "the same name"),
        ({"ratings": (replace(RATING, name="how close"),)}, "letters, digits and _"),
        ({"ratings": (replace(RATING, name="choice"),)}, "that every file of answers has"),
        ({"pages": (page(), page())}, "pages: 'you' and 'you' are the same name"),
        ({"pages": (page(question(name="close")),)}, "ratings and questions: 'close' and 'close'"),
        ({"pages": (page(question(low=9.0, high=9.0)),)}, "low 9 is not below high 9"),
        ({"pages": (page(question(choices={"en": ("a",)})),)}, "at least two"),
        ({"pages": (page(question(choices={"en": ("a", "a")})),)}, "choices: 'a' and 'a'"),
        ({"pages": (page(question(choices={"en": ("a", " ")})),)}, "choices: there is no text in 'en'"),
        ({"pages": (page(question(choices={"en": ("a", "b")}, low=1.0)),)}, "choices and a range"),
        ({"claim": Claim(more="FDVV", less="best")}, "'best' is not one of the stimuli"),
        ({"claim": Claim(more="FD", less="FD")}, "are the same stimulus"),
        ({"claim": Claim(more="FDVV", less="FD", measure="joy")}, "measure 'joy' is not asked"),
        ({"rounds": 100, "items": tuple(Item(name=f"{i}", stimuli=BOTH) for i in range(21))}, "2102 trials"),
        ({"break_min": 0.0}, "a break of no length"),
        ({"break_every_min": float("inf")}, "break_every_min: inf is not a finite number"),
        ({"kind": "2ac", "ties": False}, "2ac asks"),
        ({"kind": "abx", "items": (item(FD, FDVV, reference=FDVV),)}, "X is one of the two stimuli"),
        ({"kind": "mushra"}, "3 to 23, the reference among them"),
        ({"kind": "mushra", "ratings": ()}, "mushra only rates"),
        ({"kind": "staircase"}, "staircase: there is none"),
        ({"kind": "staircase", "staircase": Staircase()}, "must be the same rendering"),
        ({"kind": "staircase", "staircase": Staircase()}, "asks which one is stronger and nothing else"),
        ({"staircase": Staircase()}, "realism has none"),
    ],
)  # fmt: skip
def test_a_plan_that_cannot_be_run_or_analysed_is_refused_with_the_place(
    change: dict[str, Any], reason: str
) -> None:
    problems = plan_problems(replace(PLAN, **change))
    assert any(reason in problem for problem in problems), problems
    assert all(": " in problem and "\n" not in problem for problem in problems)


def test_staircases_compare_a_rendering_with_itself_and_claim_nothing() -> None:
    plan = read_plan_text(template_text("staircase"), "staircase")
    claim = Claim(more="comparison", less="standard")
    assert any("decides nothing" in problem for problem in plan_problems(replace(plan, claim=claim)))
    short = replace(Staircase(), reversals=3, dropped=2)
    assert any("at least 2" in problem for problem in plan_problems(replace(plan, staircase=short)))
    stronger = tuple(replace(s, force_ratio=1.1) for s in plan.items[0].stimuli)
    problems = plan_problems(replace(plan, items=(replace(plan.items[0], stimuli=stronger),)))
    assert any("same rendering" in one for one in problems)


def test_mushra_is_not_claimed_by_a_choice() -> None:
    plan = read_plan_text(template_text("mushra"), "mushra")
    problems = plan_problems(replace(plan, claim=Claim(more="reference", less="FD")))
    assert any("measure 'choice' is not asked (asked is closeness)" in one for one in problems)


def test_own_words_do_for_a_language_that_fdvv_does_not_know() -> None:
    dutch = replace(PLAN, languages=("nl",), title={"nl": "Studie"}, question={"nl": "Welke?"}, ratings=())
    assert plan_problems(dutch) == ()

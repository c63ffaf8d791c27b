"""What a participant is asked, in their language."""

from __future__ import annotations

import functools
import tomllib
from importlib import resources

from fdvv.study._plan import StudyPlan

KINDS_WITH_TIES = ("realism", "2ac", "preference")
"""In which "equal" may be answered; in the others one must be named, or only ratings are given."""


@functools.cache
def _words() -> dict[str, dict[str, dict[str, str]]]:
    text = resources.files("fdvv.study").joinpath("words.toml").read_text(encoding="utf-8")
    found: dict[str, dict[str, dict[str, str]]] = tomllib.loads(text)
    return found


def word_languages() -> tuple[str, ...]:
    """Give the languages that have words for every kind."""
    return tuple(sorted(_words()["question"]["realism"]))


def question_text(plan: StudyPlan, language: str) -> str:
    """Give what is asked in a trial: the plan's own words, or those of its kind.

    A plan without words of its own in a language that has none gets them in English; `plan_problems` tells.
    """
    return plan.question.get(language) or _said("question", plan.kind, language)


def equal_text(plan: StudyPlan, language: str) -> str:
    """Give the words on the answer "equal"; "" where it is not offered."""
    return _said("equal", plan.kind, language) if offers_equal(plan) else ""


def offers_equal(plan: StudyPlan) -> bool:
    """Tell whether "equal" may be answered."""
    return plan.kind == "2ac" or (plan.ties and plan.kind in KINDS_WITH_TIES)


def asks_choice(plan: StudyPlan) -> bool:
    """Tell whether a label is chosen in a trial; MUSHRA only rates."""
    return plan.kind != "mushra"


def _said(part: str, kind: str, language: str) -> str:
    words = _words()[part].get(kind, _words()[part].get("realism", {}))
    return words.get(language) or words["en"]

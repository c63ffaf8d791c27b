"""Texts of a plan: each must be there in every language of the study."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from fdvv.study._plan import StudyPlan
from fdvv.study._words import word_languages

LANGUAGE = re.compile(r"[a-z]{2,3}(-[A-Za-z0-9]{2,8})*")


def language_problems(plan: StudyPlan) -> Iterator[str]:
    """List text that is missing in a language, or there in one that is not declared, as "place: reason"."""
    if not plan.languages:
        yield 'languages: there is none; write languages = ["en"]'
    for language in plan.languages:
        if not LANGUAGE.fullmatch(language):
            yield f'languages: {language!r} is not a code as "en" or "pt-BR"'
        elif language not in word_languages() and language not in plan.question:
            known = ", ".join(word_languages())
            yield f"question: fdvv has no words in {language!r} (it has {known}); write question.{language}"
    for place, said, needed in plan_texts(plan):
        if said or needed:
            yield from _missing(place, said, plan.languages)


def plan_texts(plan: StudyPlan) -> Iterator[tuple[str, Mapping[str, object], bool]]:
    """Give every text of a plan: its place, its words by language, and whether it must be there at all."""
    yield "title", plan.title, True
    yield "question", plan.question, False
    for rating in plan.ratings:
        place = f"ratings ({rating.name!r})"
        yield f"{place}, question", rating.question, True
        yield f"{place}, low", rating.low, False
        yield f"{place}, high", rating.high, False
    for page in plan.pages:
        place = f"pages ({page.name!r})"
        yield f"{place}, title", page.title, True
        yield f"{place}, text", page.text, False
        for question in page.questions:
            yield f"{place}, questions ({question.name!r})", question.question, True
            yield f"{place}, questions ({question.name!r}), choices", question.choices, False


def _missing(place: str, said: Mapping[str, object], languages: tuple[str, ...]) -> Iterator[str]:
    for language in languages:
        words = said.get(language)
        texts = [words] if isinstance(words, str) else list(words) if isinstance(words, tuple) else []
        if not texts or not all(text.strip() for text in texts):
            yield f"{place}: there is no text in {language!r}"
    for language in said:
        if language not in languages:
            yield f"{place}: {language!r} is not one of the study's languages ({', '.join(languages)})"

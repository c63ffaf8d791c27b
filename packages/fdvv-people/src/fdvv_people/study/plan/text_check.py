"""What is wrong with names, texts and questions, in the plan of any study."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence

import msgspec

from fdvv_people.study.plan.plan import Page, Question

LANGUAGE = re.compile(r"[a-z]{2,3}(-[A-Za-z0-9]{2,8})*")
COLUMN = re.compile(r"[^\W\d]\w{0,39}")
TAKEN = {
    *("choice", "correct", "excluded", "item", "kind", "number", "person", "ratio", "round", "time_s"),
    *("force_ratio", "snap_ratio", "vibration_ratio"),
}
"""Columns that every file of answers has."""
Text = tuple[str, Mapping[str, object], bool]


def number_problems(part: object, place: str) -> Iterator[str]:
    """Refuse inf and nan, which TOML knows and no bound stops."""
    if isinstance(part, float) and not math.isfinite(part):
        yield f"{place}: {part} is not a finite number"
    if isinstance(part, msgspec.Struct):
        for field in part.__struct_fields__:
            yield from number_problems(getattr(part, field), f"{place}.{field}".lstrip("."))
    if isinstance(part, tuple):
        for i, one in enumerate(part, start=1):
            yield from number_problems(one, f"{place}[{i}]")


def name_problems(place: str, name: str) -> Iterator[str]:
    """Refuse a name that cannot be read in a list."""
    if not name.isprintable() or name != name.strip() or not name:
        yield f"{place}: {name!r:.70} must be printable, without spaces at its ends"


def names_problems(groups: Mapping[str, Iterable[str]]) -> Iterator[str]:
    """List names that may not be, or are given twice. groups : names by their place."""
    for place, names in groups.items():
        for name in names:
            yield from name_problems(place, name)
        yield from twice_problems(place, names)


def twice_problems(place: str, names: Iterable[str]) -> Iterator[str]:
    """List names that are there twice, whatever their case."""
    seen: dict[str, str] = {}
    for name in names:
        if name.casefold() in seen:
            yield f"{place}: {name!r} and {seen[name.casefold()]!r} are the same name"
        seen[name.casefold()] = name


def question_problems(place: str, question: Question) -> Iterator[str]:
    """List what is wrong with the answers that a question allows."""
    low, high = question.low, question.high
    if question.choices and (low is not None or high is not None):
        yield f"{place}: it has choices and a range; leave out one"
    if low is not None and high is not None and low >= high:
        yield f"{place}: low {low:g} is not below high {high:g}"
    lengths = {len(choices) for choices in question.choices.values()}
    if lengths and (len(lengths) > 1 or min(lengths) < 2):
        yield f"{place}: choices must be at least two, and as many in every language"
    for choices in question.choices.values():
        yield from twice_problems(f"{place}, choices", choices)


def page_problems(pages: Iterable[Page], columns: Sequence[tuple[str, str]] = ()) -> Iterator[str]:
    """List what is wrong with questions of pages. columns : of answers beside theirs, with their places."""
    questions = [(f"pages ({page.name!r}), questions", one) for page in pages for one in page.questions]
    for place, one in questions:
        yield from question_problems(f"{place} ({one.name!r})", one)
    yield from column_problems([*columns, *((place, one.name) for place, one in questions)])


def page_texts(pages: Iterable[Page]) -> Iterator[Text]:
    """Yield every text of pages: its place, its words by language, and whether it must be there at all."""
    for page in pages:
        place = f"pages ({page.name!r})"
        yield f"{place}, title", page.title, True
        yield f"{place}, text", page.text, False
        for question in page.questions:
            yield f"{place}, questions ({question.name!r})", question.question, True
            yield f"{place}, questions ({question.name!r}), choices", question.choices, False


def text_problems(texts: Iterable[Text], languages: Sequence[str]) -> Iterator[str]:
    """List text that is missing in a language, or there in one that is not declared."""
    for place, said, needed in texts:
        if said or needed:
            yield from _missing(place, said, languages)


def language_problems(languages: Sequence[str]) -> Iterator[str]:
    """List languages that are no codes; and that there is none."""
    if not languages:
        yield 'languages: there is none; write languages = ["en"]'
    for language in languages:
        if not LANGUAGE.fullmatch(language):
            yield f'languages: {language!r} is not a code as "en" or "pt-BR"'


def column_problems(named: Sequence[tuple[str, str]]) -> Iterator[str]:
    """List names of columns, by place, that a table of answers cannot have."""
    for place, name in named:
        if not COLUMN.fullmatch(name):
            yield f"{place}: {name!r:.50} names a column: at most 40 letters, digits and _"
        if name.casefold() in TAKEN:
            yield f"{place}: {name!r} is a column that every file of answers has"
    yield from twice_problems("ratings and questions", [name for _, name in named])


def _missing(place: str, said: Mapping[str, object], languages: Sequence[str]) -> Iterator[str]:
    for language in languages:
        words = said.get(language)
        texts = [words] if isinstance(words, str) else list(words) if isinstance(words, tuple) else []
        if not texts or not all(text.strip() for text in texts):
            yield f"{place}: there is no text in {language!r}"
    for language in said:
        if language not in languages:
            yield f"{place}: {language!r} is not one of the study's languages ({', '.join(languages)})"

"""The page of the study file tells of every field, with its default."""

from __future__ import annotations

import re
from pathlib import Path

import msgspec
import pytest

from fdvv_people.study.plan.plan import (
    Claim,
    Exclusion,
    Item,
    Page,
    Question,
    Rating,
    Staircase,
    Stimulus,
    StudyPlan,
    Thresholds,
)
from fdvv_people.study.plan.plan_file import template_names
from fdvv_people.study.plan.plan_words import word_languages

PAGE = Path(__file__).parents[4] / "docs" / "reference" / "study-file.md"
PARTS: dict[str, type[msgspec.Struct]] = {
    "Study": StudyPlan,
    "Item": Item,
    "Stimulus": Stimulus,
    "Rating": Rating,
    "Page": Page,
    "Question": Question,
    "Staircase": Staircase,
    "Thresholds": Thresholds,
    "Exclusion": Exclusion,
    "Claim": Claim,
}


def rows_of(heading: str) -> dict[str, tuple[str, str]]:
    """Return default and meaning of each field in the table below a heading."""
    section = re.split(r"^## ", PAGE.read_text(), flags=re.MULTILINE)
    (text,) = [part for part in section if part.startswith(f"{heading}\n")]
    rows = re.findall(r"^\| `(\w+)` \| (.*?) \| ?(.*?) \|$", text.replace("| | ", "|  | "), re.MULTILINE)
    return {name: (default.strip(), meaning) for name, default, meaning in rows}


def written(field: msgspec.structs.FieldInfo) -> str:
    """Write a default as the page does."""
    if field.default is None:
        return "none"
    if isinstance(field.default, Exclusion):
        return "as below"
    if field.default_factory is not msgspec.NODEFAULT:
        return f"`{msgspec.json.encode(field.default_factory()).decode()}`"
    if field.default is msgspec.NODEFAULT:
        return ""
    return f"`{msgspec.json.encode(field.default).decode().replace(',', ', ')}`"


@pytest.mark.parametrize("heading", PARTS)
def test_every_field_has_its_meaning_and_its_true_default_on_the_page(heading: str) -> None:
    rows = rows_of(heading)
    fields = msgspec.structs.fields(PARTS[heading])
    assert list(rows) == [field.name for field in fields]
    for field in fields:
        default, meaning = rows[field.name]
        assert default == written(field), field.name
        assert len(meaning) > 8, field.name


def test_every_part_of_a_plan_is_on_the_page() -> None:
    def below(part: type[msgspec.Struct]) -> set[type[msgspec.Struct]]:
        found = {part}
        for field in msgspec.structs.fields(part):
            for inner in PARTS.values():
                if inner.__name__ in str(field.type) and inner not in found:
                    found |= below(inner)
        return found

    assert below(StudyPlan) == set(PARTS.values())


def test_every_kind_and_language_is_on_the_page() -> None:
    text = PAGE.read_text()
    assert [kind for kind in template_names() if f"| `{kind}` |" not in text] == []
    *first, last = word_languages()
    assert f"{', '.join(first)} and {last}" in text

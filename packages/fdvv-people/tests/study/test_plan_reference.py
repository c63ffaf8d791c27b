"""The pages of both files of studies tell of every field, with its default."""

from __future__ import annotations

import re
from typing import get_args

import msgspec
import pytest

from fdvv_people.study.plan import plan
from fdvv_people.study.plan.plan_file import template_names
from fdvv_people.study.plan.plan_words import word_languages
from fdvv_people.study.timing import plan as timing
from tests.support.checkout import REPOSITORY

REFERENCE = REPOSITORY / "docs" / "reference"
STUDY: dict[str, type[msgspec.Struct]] = {
    "Study": plan.StudyPlan,
    "Item": plan.Item,
    "Stimulus": plan.Stimulus,
    "Rating": plan.Rating,
    "Page": plan.Page,
    "Question": plan.Question,
    "Staircase": plan.Staircase,
    "Thresholds": plan.Thresholds,
    "Exclusion": plan.Exclusion,
    "Claim": plan.Claim,
}
TIMING: dict[str, type[msgspec.Struct]] = {
    "Timing study": timing.TimingPlan,
    "Condition": timing.Condition,
    "Training": timing.TrainingPlan,
    "Claim": timing.TimingClaim,
}


def rows_of(page: str, heading: str) -> dict[str, tuple[str, str]]:
    """Return default and meaning of each field in the table below a heading."""
    section = re.split(r"^## ", (REFERENCE / page).read_text(), flags=re.MULTILINE)
    (text,) = [part for part in section if part.startswith(f"{heading}\n")]
    fields = text.partition("| kind | what it is")[0].replace("| | ", "|  | ")
    rows = re.findall(r"^\| `(\w+)` \| (.*?) \| ?(.*?) \|$", fields, re.MULTILINE)
    return {name: (default.strip(), meaning) for name, default, meaning in rows}


def written(field: msgspec.structs.FieldInfo) -> str:
    """Write a default as the page does."""
    if field.default is None:
        return "none"
    if isinstance(field.default, plan.Exclusion):
        return "as below"
    if field.default_factory is not msgspec.NODEFAULT:
        return f"`{msgspec.json.encode(field.default_factory()).decode()}`"
    if field.default is msgspec.NODEFAULT:
        return ""
    return f"`{msgspec.json.encode(field.default).decode().replace(',', ', ')}`"


@pytest.mark.parametrize(
    ("page", "heading", "part"),
    [
        (page, *one)
        for page, parts in (("study-file.md", STUDY), ("timing-file.md", TIMING))
        for one in parts.items()
    ],
)
def test_every_field_has_its_meaning_and_its_true_default_on_the_page(
    page: str, heading: str, part: type[msgspec.Struct]
) -> None:
    rows, fields = rows_of(page, heading), msgspec.structs.fields(part)
    assert list(rows) == [field.name for field in fields]
    for field in fields:
        default, meaning = rows[field.name]
        assert default == written(field), field.name
        assert len(meaning) > 8, field.name


def test_every_part_of_a_plan_is_on_the_page() -> None:
    def below(part: type[msgspec.Struct]) -> set[type[msgspec.Struct]]:
        found = {part}
        for field in msgspec.structs.fields(part):
            for inner in STUDY.values():
                if inner.__name__ in str(field.type) and inner not in found:
                    found |= below(inner)
        return found

    assert below(plan.StudyPlan) == set(STUDY.values())


def test_every_kind_and_language_is_on_the_page() -> None:
    text = (REFERENCE / "study-file.md").read_text()
    assert [kind for kind in template_names() if f"| `{kind}` |" not in text] == []
    *first, last = word_languages()
    assert f"{', '.join(first)} and {last}" in text


def test_every_kind_of_condition_is_on_the_page() -> None:
    text = (REFERENCE / "timing-file.md").read_text()
    assert all(f"| `{kind}` |" in text for kind in get_args(timing.ConditionKind))

"""The page of the timing study file tells of every field, with its default."""

from __future__ import annotations

import re
from pathlib import Path
from typing import get_args

import msgspec
import pytest

from fdvv_people.study.plan.plan import Page, Question
from fdvv_people.study.timing.plan import Condition, ConditionKind, TimingClaim, TimingPlan, TrainingPlan

PAGE = Path(__file__).parents[5] / "docs" / "reference" / "timing-file.md"
PARTS: dict[str, type[msgspec.Struct]] = {
    "Timing study": TimingPlan,
    "Condition": Condition,
    "Training": TrainingPlan,
    "Claim": TimingClaim,
    "Page": Page,
    "Question": Question,
}


def rows_of(heading: str) -> dict[str, str]:
    """Return the default of each field in the table below a heading."""
    section = re.split(r"^## ", PAGE.read_text(), flags=re.MULTILINE)
    (text,) = [part for part in section if part.startswith(f"{heading}\n")]
    fields = text.partition("| kind | what it is")[0]
    rows = re.findall(r"^\| `(\w+)` \| (.*?)\| ?.{8,} \|$", fields.replace("| | ", "|  | "), re.MULTILINE)
    return {name: default.strip() for name, default in rows}


def written(field: msgspec.structs.FieldInfo) -> str:
    """Write a default as the page does."""
    if field.default is None:
        return "none"
    if field.default_factory is not msgspec.NODEFAULT:
        return f"`{msgspec.json.encode(field.default_factory()).decode()}`"
    if field.default is msgspec.NODEFAULT:
        return ""
    return f"`{msgspec.json.encode(field.default).decode()}`"


@pytest.mark.parametrize("heading", PARTS)
def test_every_field_has_its_meaning_and_its_true_default_on_the_page(heading: str) -> None:
    rows = rows_of(heading)
    fields = msgspec.structs.fields(PARTS[heading])
    assert list(rows) == [field.name for field in fields]
    assert {field.name: written(field) for field in fields} == rows


def test_every_kind_of_condition_is_on_the_page() -> None:
    text = PAGE.read_text()
    assert all(f"| `{kind}` |" in text for kind in get_args(ConditionKind))

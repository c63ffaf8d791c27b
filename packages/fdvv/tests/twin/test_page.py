"""The twin's page names every parameter of rig and finger, so that a solver can be written from it."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path

import pytest

from fdvv.twin.finger import Finger
from fdvv.twin.rig import Rig

PAGE = Path(__file__).parents[4] / "docs" / "explanation" / "twin.md"
SECTIONS = [
    (f.name, getattr(record, f.name)) for record in (Rig(), Finger()) for f in dataclasses.fields(record)
]


def rows() -> dict[str, set[str]]:
    """Return the names in backticks in each row of the page's table of parameters, by section."""
    _, _, table = PAGE.read_text("utf-8").partition("| section | parameters and their symbols |")
    lines = [line.split("|") for line in table.partition("\n\n")[0].splitlines()[2:]]
    cells = [(names.strip(), set(re.findall(r"`([^`]+)`", text))) for _, names, text, _ in lines]
    return {name: found for names, found in cells for name in names.split(", ")}


@pytest.mark.parametrize(("section", "record"), SECTIONS, ids=[name for name, _ in SECTIONS])
def test_every_parameter_stands_in_its_row(section: str, record: object) -> None:
    known = {f.name for f in dataclasses.fields(record)}  # type: ignore[arg-type]
    assert known <= rows()[section]


def test_no_row_names_a_parameter_that_is_gone() -> None:
    known = {f.name for _, record in SECTIONS for f in dataclasses.fields(record)}
    assert set().union(*rows().values()) == known

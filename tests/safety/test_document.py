"""docs/explanation/safety.md tells the tables that the C code has."""

from __future__ import annotations

import re

from fdvv.protocol.tables import Fault, Mode
from tests.safety._build import CORE, REPOSITORY
from tests.safety._equivalents import EQUIVALENT
from tests.safety._mutants import mutants

TEXT = (REPOSITORY / "docs" / "explanation" / "safety.md").read_text()
SOURCE = (CORE / "supervisor.c").read_text()


def rows_below(heading: str) -> list[list[str]]:
    """Return the cells of the first table below a heading, without its head."""
    part = TEXT[TEXT.index(f"## {heading}") :]
    lines = re.findall(r"^\|(.*)\|$", part[: part.index("\n## ", 1)], re.MULTILINE)
    return [[cell.strip() for cell in line.split("|")] for line in lines[2:]]


def test_the_documented_modes_are_those_of_the_table() -> None:
    table = re.findall(r"/\* (\w+) \*/ +\{(.*)\},", SOURCE)
    assert rows_below("Modes") == [[mode, *cells.lower().split(", ")] for mode, cells in _plain(table)]
    assert [mode for mode, _ in table] == [mode.name.lower() for mode in Mode]


def _plain(table: list[tuple[str, str]]) -> list[tuple[str, str]]:
    return [(mode, ", ".join(cell.strip() for cell in cells.split(","))) for mode, cells in table]


def _documented(cell: str) -> str:
    """Return the word of the document for a cell of the fault table."""
    return {"EXTERNAL": "elsewhere", "INACTIVE": "gone", "ANYTIME": "any"}.get(cell, cell.lower())


def test_the_documented_faults_are_those_of_the_table() -> None:
    table = re.findall(r"X\((\w+), (\w+), (\w+), (\w+), (\w+),", SOURCE)
    numbers = {fault.name: str(fault.value) for fault in Fault}
    expected = [
        [numbers[name], name.lower(), _documented(when), _documented(clear), _documented(effect), unit]
        for name, when, clear, effect, unit in table
    ]
    assert rows_below("Faults") == expected
    assert [name for name, *_ in table] == [fault.name for fault in Fault if fault]


def test_the_documented_counts_are_those_of_the_tests() -> None:
    planted = {
        name: len(mutants((CORE / f"{name}.c").read_text())) - len(EQUIVALENT[name]) for name in EQUIVALENT
    }
    said = ", ".join(f"{count} in `{name}.c`" for name, count in planted.items())
    assert said in TEXT.replace("\n  ", " ")
    assert f"{sum(map(len, EQUIVALENT.values()))} equivalent" in TEXT

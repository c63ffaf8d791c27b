"""How far the people of a study are, as fdvv study status shows it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class PeopleTable:
    """The people of a study.

    Attributes
    ----------
    people : as --json prints them. columns, rows, left : of the table, see `ui.print_table`.
    lines : that are printed below it.
    """

    people: list[dict[str, Any]]
    columns: list[str]
    rows: list[list[Any]]
    left: int
    lines: list[str] = field(default_factory=list)

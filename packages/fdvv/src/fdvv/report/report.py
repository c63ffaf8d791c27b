"""One report as one HTML file: style, figures and tables inside it, nothing fetched, nothing run."""

from __future__ import annotations

import base64
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from markupsafe import Markup

from fdvv.errors import ModelError
from fdvv.io.files import write_atomic
from fdvv.report.templates import environment

_NUMBER = re.compile(
    r"(< ?)?[+\-−]?(\d+(\.\d*)?|\.\d+|∞)(e[+-]?\d+)?\s?(%|[A-Za-zµ/²]{1,6})?(\s?\[[^\[\]]+\])?"
)
"""A cell that reads as a number, with a unit and an interval or not, is set to the right, in one line."""

_NOTHING = {"", "-", "–", "—"}
"""What a cell says where there is no number."""


MOST_CHOICES = 8
"""The style sheet counts that far."""


@dataclass(frozen=True)
class Headline:
    """A result in a few characters, such as "14 → 0.8 cN", and what it is of."""

    value: str
    label: str


@dataclass(frozen=True)
class Table:
    """A table of text.

    Attributes
    ----------
    columns : headings, units in them.
    rows : cells as text, one per column; the first is the heading of its row.
    caption : one sentence that says what the table shows.

    Raises ModelError if a row has another length than the headings.
    """

    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    caption: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "columns", tuple(str(c) for c in self.columns))
        object.__setattr__(self, "rows", tuple(tuple(str(c) for c in row) for row in self.rows))
        for i, row in enumerate(self.rows):
            if len(row) != len(self.columns):
                raise ModelError(f"row {i} has {len(row)} cells, the table {len(self.columns)} columns")

    def kinds(self) -> list[Markup]:
        """Return an attribute per column: numbers are set to the right, in one line."""
        columns = list(zip(*self.rows, strict=True)) or [()] * len(self.columns)
        return [Markup(' class="number"' if _is_numeric(column) else "") for column in columns]


@dataclass(frozen=True)
class Section:
    """A part of a report: text, then figures, then tables.

    Attributes
    ----------
    title : its heading.
    paragraphs : plain text, no markup.
    choices : figures of which one is shown, each with the label that chooses it; the first is shown first.
    figures : svg elements as figure_svg gives them.
    tables : see Table.
    folded : shown by its title until the reader opens it.
    """

    title: str
    paragraphs: tuple[str, ...] = ()
    figures: tuple[str, ...] = ()
    tables: tuple[Table, ...] = ()
    choices: tuple[tuple[str, str], ...] = ()
    folded: bool = False

    def __post_init__(self) -> None:
        for name in ("paragraphs", "figures", "tables", "choices"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        if len(self.choices) > MOST_CHOICES:
            raise ModelError(
                f"a section has at most {MOST_CHOICES} figures to choose, got {len(self.choices)}"
            )
        for svg in (*self.figures, *(svg for _, svg in self.choices)):
            if not svg.lstrip().startswith("<svg"):
                raise ModelError(f"a figure must be an svg element as figure_svg gives it, got {svg[:40]!r}")


@dataclass(frozen=True)
class Download:
    """A file inside a report, which its reader can save. name : of the file."""

    name: str
    text: str

    @property
    def address(self) -> str:
        """The content as the address of a link."""
        return f"data:application/json;base64,{base64.b64encode(self.text.encode()).decode()}"


def render_html(
    title: str,
    summary: str,
    sections: Sequence[Section],
    footer: str = "",
    simulated: str | None = None,
    downloads: Sequence[Download] = (),
    headlines: Sequence[Headline] = (),
) -> str:
    """Return a report as one self-contained HTML document; every text is escaped.

    simulated : where the numbers come from if no hardware made them ("the twin, seed 1"); shown in a
        banner at the top as "Simulated: ...". None for measured data.
    downloads : files that the reader can save from the document.
    headlines : the results, shown large before everything else.
    """
    page = environment().get_template("report.html")
    return page.render(
        title=title,
        summary=summary,
        sections=sections,
        footer=footer,
        simulated=simulated,
        downloads=downloads,
        headlines=headlines,
    )


def write_report(path: Path, html: str) -> None:
    """Write a report to a file, whole or not at all. Raises OSError."""
    write_atomic(path, html)


def _is_numeric(column: Sequence[str]) -> bool:
    texts = [text.strip() for text in column if text.strip() not in _NOTHING]
    return bool(texts) and all(_NUMBER.fullmatch(text) for text in texts)

"""One report as one HTML file: style, figures and tables inside it, nothing fetched, nothing run."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path

from fdvv.errors import ModelError
from fdvv.files import write_atomic
from fdvv.plot._svg import prefix_ids

_NUMBER = re.compile(
    r"(< ?)?[+\-−]?(\d+(\.\d*)?|\.\d+|∞)(e[+-]?\d+)?\s?(%|[A-Za-zµ/²]{1,6})?(\s?\[[^\[\]]+\])?"
)
"""A cell that reads as a number, with a unit and an interval or not, is set to the right, in one line."""

_NOTHING = {"", "-", "–", "—"}
"""What a cell says where there is no number."""


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


@dataclass(frozen=True)
class Section:
    """A part of a report: text, then figures, then tables.

    Attributes
    ----------
    title : its heading.
    paragraphs : plain text, no markup.
    figures : svg elements as figure_svg gives them.
    tables : see Table.
    """

    title: str
    paragraphs: tuple[str, ...] = ()
    figures: tuple[str, ...] = ()
    tables: tuple[Table, ...] = ()

    def __post_init__(self) -> None:
        for name in ("paragraphs", "figures", "tables"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        for svg in self.figures:
            if not svg.lstrip().startswith("<svg"):
                raise ModelError(f"a figure must be an svg element as figure_svg gives it, got {svg[:40]!r}")


def render_html(
    title: str,
    summary: str,
    sections: Sequence[Section],
    footer: str = "",
    simulated: str | None = None,
) -> str:
    """Write a report as one self-contained HTML document.

    Every text is escaped. Figures get their own ids, stand on white and are named for screen readers.

    simulated : where the numbers come from if no hardware made them ("the twin, seed 1"); shown in a
        banner at the top as "Simulated: ...". None for measured data.
    """
    body = "".join(_section(section, number) for number, section in enumerate(sections, start=1))
    note = f'<p class="banner" role="note"><strong>Simulated:</strong> {escape(simulated or "")}</p>\n'
    return _PAGE.format(
        title=escape(title),
        css=_CSS,
        banner="" if simulated is None else note,
        summary=f"<p>{escape(summary)}</p>\n" if summary else "",
        body=body,
        footer=f"<footer><p>{escape(footer)}</p></footer>\n" if footer else "",
    )


def write_report(path: Path, html: str) -> None:
    """Write a report to a file, whole or not at all. Raises OSError."""
    write_atomic(path, html)


def _section(section: Section, number: int) -> str:
    """Write one section; its number keeps ids apart."""
    heading = f"section-{number}"
    parts = [f'<section aria-labelledby="{heading}">\n<h2 id="{heading}">{escape(section.title)}</h2>\n']
    parts += [f"<p>{escape(text)}</p>\n" for text in section.paragraphs]
    for count, svg in enumerate(section.figures, start=1):
        parts.append(f"<figure>\n{prefix_ids(svg, f'figure-{number}-{count}-')}</figure>\n")
    parts += [_table(table) for table in section.tables]
    return "".join([*parts, "</section>\n"])


def _table(table: Table) -> str:
    """Write one table in a box that scrolls sideways where the page is narrow."""
    caption = f"<caption>{escape(table.caption)}</caption>\n" if table.caption else ""
    columns = list(zip(*table.rows, strict=True)) or [()] * len(table.columns)
    kinds = [' class="number"' if _is_numeric(column) else "" for column in columns]
    heads = "".join(f'<th scope="col"{k}>{escape(c)}</th>' for c, k in zip(table.columns, kinds, strict=True))
    rows = "".join(f"<tr>{_cells(row, kinds)}</tr>\n" for row in table.rows)
    inner = f"<table>\n{caption}<thead><tr>{heads}</tr></thead>\n<tbody>\n{rows}</tbody>\n</table>"
    return f'<div class="wide" tabindex="0">\n{inner}\n</div>\n'


def _is_numeric(column: Sequence[str]) -> bool:
    """Tell whether a column holds numbers and nothing else."""
    said = [text.strip() for text in column if text.strip() not in _NOTHING]
    return bool(said) and all(_NUMBER.fullmatch(text) for text in said)


def _cells(row: tuple[str, ...], kinds: Sequence[str]) -> str:
    """Write the cells of a row, the first as its heading."""
    pairs = list(zip(row, kinds, strict=True))
    first = [f'<th scope="row"{kind}>{escape(text)}</th>' for text, kind in pairs[:1]]
    return "".join(first + [f"<td{kind}>{escape(text)}</td>" for text, kind in pairs[1:]])


_PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{title}</title>
<style>
{css}</style>
</head>
<body>
<main>
<header>
<h1>{title}</h1>
{banner}{summary}</header>
{body}{footer}</main>
</body>
</html>
"""

_CSS = """\
:root { color-scheme: light dark; --ink: #1f2933; --quiet: #52606d; --page: #ffffff; --line: #d5dae0;
  --stripe: #f5f7fa; --warn: #fff4e5; --warn-ink: #7a2e0e; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e4e7eb; --quiet: #9aa5b1; --page: #14191f; --line: #3e4c59; --stripe: #1c232b;
    --warn: #4a2a0a; --warn-ink: #ffd8a8; }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink); line-height: 1.5;
  font-family: system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
main { max-width: 62rem; margin: 0 auto; padding: 1.5rem 1rem 3rem; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0 0 1rem; }
h2 { font-size: 1.25rem; margin: 2.2rem 0 0.6rem; padding-top: 0.8rem; border-top: 1px solid var(--line); }
h1, h2, p, th, td { overflow-wrap: anywhere; }
p { max-width: 46rem; margin: 0.6rem 0; }
.banner { max-width: none; background: var(--warn); color: var(--warn-ink); padding: 0.6rem 0.9rem;
  border-left: 4px solid currentColor; border-radius: 4px; }
figure { margin: 1rem 0; padding: 0.8rem; background: #ffffff; border: 1px solid var(--line);
  border-radius: 6px; text-align: center; break-inside: avoid; }
figure svg { max-width: 100%; height: auto; vertical-align: middle; }
.wide { overflow-x: auto; margin: 1rem 0; }
table { border-collapse: collapse; font-size: 0.92rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; color: var(--quiet); padding-bottom: 0.4rem; }
th, td { padding: 0.3rem 0.8rem 0.3rem 0.4rem; text-align: left; vertical-align: top; min-width: 4rem;
  border-bottom: 1px solid var(--line); }
thead th { border-bottom: 2px solid var(--quiet); overflow-wrap: break-word; }
tbody th { font-weight: 500; min-width: 8rem; }
tbody tr:nth-child(even) { background: var(--stripe); }
.number { text-align: right; white-space: nowrap; }
footer { margin-top: 3rem; border-top: 1px solid var(--line); color: var(--quiet); font-size: 0.85rem; }
@media print {
  :root { color-scheme: light; --ink: #000000; --quiet: #444444; --page: #ffffff; --line: #bbbbbb;
    --stripe: #ffffff; --warn: #ffffff; --warn-ink: #7a2e0e; }
  main { max-width: none; padding: 0; }
  h2 { break-after: avoid; }
  tr { break-inside: avoid; }
  .wide { overflow: visible; }
}
"""

"""The rows of ``budget.toml``: read, and written again one by one, so that paths and comments stay.

A row is one line; comments have lines of their own. Its value is a number, a list of accepted items, or the
paths of a part with its lines and files. Every number, and every item of a list as 1, is an upper limit; what
has no row has the limit 0.
"""

from __future__ import annotations

import json
import re
import tomllib
from collections import defaultdict
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

SECTIONS = ("parts", "loaded", "cpu", "counts", "force_text", "arrows", "records", "protocols", "generated")
SIZES = ("lines", "files")


class Row(NamedTuple):
    """What a limit is for: ("parts", "optimize", "lines"), ("arrows", "study", "task"), ("cpu", "--help")."""

    section: str
    name: str
    part: str = ""

    def __str__(self) -> str:
        if self.section == "parts":
            return f"{self.part} of {self.name}"
        return f"{self.section}: {self.name}" + (f" -> {self.part}" if self.part else "")

    @property
    def kind(self) -> tuple[str, str]:
        """What may be summed: lines are no files."""
        return self.section, self.part if self.section == "parts" else ""


Limits = Mapping[Row, int]


def parse_limits(document: Mapping[str, Any]) -> dict[Row, int]:
    """Return every limit of a budget."""
    return {
        Row(section, name, part): limit
        for section in SECTIONS
        for name, value in document.get(section, {}).items()
        for part, limit in _limits(value)
    }


def _limits(value: Any) -> Iterable[tuple[str, int]]:
    if isinstance(value, int):
        return [("", value)]
    if isinstance(value, list):
        return [(item, 1) for item in value]
    return [(size, value[size]) for size in SIZES]


def find_raises(old: Limits, new: Limits) -> list[Row]:
    """Return the rows of which the limit rises.

    New rows do not count where the sum of their kind does not grow: they were renamed, or split from others.
    """
    higher = [row for row, limit in new.items() if limit > old.get(row, 0)]
    return [row for row in higher if row in old or _total(new, row.kind) > _total(old, row.kind)]


def _total(limits: Limits, kind: tuple[str, str]) -> int:
    return sum(limit for row, limit in limits.items() if row.kind == kind)


def write_limits(text: str, limits: Limits) -> str:
    """Return the text of a budget with these limits; a row with nothing left goes, a new one comes last."""
    tables: defaultdict[str, defaultdict[str, dict[str, int]]] = defaultdict(lambda: defaultdict(dict))
    for row, limit in limits.items():
        tables[row.section][row.name][row.part] = limit
    return "".join(_write_table(table, tables) for table in re.split(r"(?m)^(?=\[)", text))


def _write_table(text: str, tables: Mapping[str, Mapping[str, dict[str, int]]]) -> str:
    head = re.match(r"\[(\w+)\]", text)
    if head is None or head[1] not in SECTIONS:
        return text
    rows = {name: values for name, values in tables[head[1]].items() if any(values.values())}
    lines = []
    for line in text.rstrip().splitlines():
        if line.startswith(("[", "#")) or not line.strip():
            lines.append(line)
            continue
        (name,) = tomllib.loads(line)
        if name in rows:
            lines.append(_write_row(line, rows.pop(name)))
    lines += [_write_row(f"{_key(name)} = 0", values) for name, values in sorted(rows.items())]
    return "\n".join(lines) + text[len(text.rstrip()) :]


def _write_row(line: str, values: Mapping[str, int]) -> str:
    if set(values) == set(SIZES):
        return re.sub(r"\b(lines|files) = \d+", lambda size: f"{size[1]} = {values[size[1]]}", line)
    key = line[: line.rindex(" = ")]
    return f"{key} = {values[''] if '' in values else json.dumps(sorted(filter(values.get, values)))}"


def _key(name: str) -> str:
    return name if re.fullmatch(r"[\w-]+", name) else json.dumps(name)

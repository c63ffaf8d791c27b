"""The head of an export of Motive: what the file says of itself, and what each of its columns is."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime

from fdvv.recording._reading import refusal
from fdvv.text import cells

KNOWN = ("1.21", "1.22", "1.23", "1.24", "1.25")
LENGTH_mm = {"meters": 1000.0, "centimeters": 10.0, "millimeters": 1.0, "inches": 25.4}
SEEN = ("marker", "labeled marker", "unlabeled marker")
LABELS = ("type", "name", "id", "parent")
EXPORT = "export it again from Motive, with header information and the markers"
_BEFORE_NOON = {"am", "a.m.", "de."}
_AFTER_NOON = {"pm", "p.m.", "du."}
"""Halves of the day as English and Hungarian Windows write them."""


@dataclass(frozen=True)
class Triple:
    """The columns X, Y, Z of one place, as their head names it."""

    kind: str
    name: str
    at: tuple[int, int, int]

    @property
    def title(self) -> str:
        """Name the stream; one that Motive computed from a body says so."""
        seen = self.kind.lower() in SEEN
        return self.name if seen else f"{self.name} ({self.kind.lower()})"


@dataclass(frozen=True)
class Head:
    """What stands above the numbers.

    Attributes
    ----------
    told : the pairs of the first line.
    triples : places, in the order of their columns.
    left_out : components that are no place, each with the number of its columns.
    columns : how many a whole row has.
    first_row : index of the first line of numbers.
    """

    told: Mapping[str, str]
    triples: Sequence[Triple]
    left_out: Mapping[str, int]
    columns: int
    first_row: int

    def rate_Hz(self) -> float | None:
        """Give the rate of the rows; None if the head does not tell a usable one."""
        for key in ("Export Frame Rate", "Capture Frame Rate"):
            try:
                rate = float(self.told[key])
            except (KeyError, ValueError):
                continue
            if 0 < rate < 1e6:
                return rate
        return None


def is_motive(head: Sequence[str]) -> bool:
    """Tell an export of Motive by its first line."""
    return bool(re.match(r'"?Format Version"?,', head[0]))


def read_head(source: object, lines: Sequence[str]) -> Head:
    """Read the head. InputError where it names no place or no unit."""
    first = cells(lines[0], ",")
    told = {key.strip(): value.strip() for key, value in zip(first[::2], first[1::2], strict=False)}
    _check(source, told)
    at = next((i for i, line in enumerate(lines[1:30], 1) if _is_axes(line)), None)
    if at is None:
        raise refusal(source, "line 1 to 30", "no line begins with Frame,Time", EXPORT)
    axes = [cell.strip().upper() for cell in cells(lines[at], ",")]
    kinds, names, components = _rows([cells(line, ",") for line in lines[1:at] if line.strip()], len(axes))
    triples = _triples(kinds, names, components, axes)
    if not triples:
        reason = "it holds frames and times but no marker"
        raise refusal(source, f"line {at + 1}", reason, EXPORT)
    taken = {column for triple in triples for column in triple.at}
    left_out: dict[str, int] = {}
    for column in range(2, len(axes)):
        if column not in taken:
            what = components[column].strip().lower() or axes[column].lower() or "nameless"
            left_out[what] = left_out.get(what, 0) + 1
    return Head(told, triples, left_out, len(axes), at + 1)


def _check(source: object, told: Mapping[str, str]) -> None:
    version = told.get("Format Version", "")
    if not re.fullmatch(r"1\.2\d?", version):
        reason = f"format version {version!r:.20}, versions {KNOWN[0]} to {KNOWN[-1]} are read"
        raise refusal(source, "line 1", reason, "export it again from Motive 1.9 or newer")
    unit = told.get("Length Units", "")
    if unit.lower() not in LENGTH_mm:
        reason = f"Length Units is {unit!r:.20}, one of {', '.join(LENGTH_mm)} is read"
        raise refusal(source, "line 1", reason, EXPORT)


def _is_axes(line: str) -> bool:
    found = [cell.strip().lower() for cell in line.split(",", 2)]
    return found[0] == "frame" and len(found) > 1 and found[1].startswith("time")


def _rows(rows: list[list[str]], width: int) -> tuple[list[str], list[str], list[str]]:
    """Give kinds, names and components per column; version 1.21 does not say which row is which."""
    rows = [row + [""] * (width - len(row)) for row in rows]
    labelled = {row[1].strip().lower(): row for row in rows}
    blank = [""] * width
    bare = [row for row in rows if row[1].strip().lower() not in LABELS]
    components = bare.pop() if bare else blank
    kinds = labelled["type"] if "type" in labelled else (bare[0] if bare else blank)
    names = labelled["name"] if "name" in labelled else (bare[1] if len(bare) > 1 else blank)
    return kinds, names, components


def _triples(kinds: list[str], names: list[str], components: list[str], axes: list[str]) -> list[Triple]:
    found, column = [], 2
    while column + 2 < len(axes):
        same = len({(kinds[i], names[i]) for i in range(column, column + 3)}) == 1
        places = all(components[i].strip().lower() == "position" for i in range(column, column + 3))
        if same and places and axes[column : column + 3] == ["X", "Y", "Z"]:
            kind, name = kinds[column].strip() or "Marker", names[column].strip().strip('"')
            found.append(Triple(kind, name or f"column {column + 1}", (column, column + 1, column + 2)))
            column += 3
        else:
            column += 1
    return found


def made(told: str) -> str | None:
    """Read "2023-11-28 10.27.58.765 DU." as ISO 8601 without a zone; None if it tells no moment.

    Hours are those of a twelve-hour clock, so one without a half of the day tells none before 13.
    """
    match = re.match(r"(\d{4}-\d\d-\d\d) (\d\d)\.(\d\d)\.(\d\d)\.(\d{3})\s*(\S*)", told)
    if match is None:
        return None
    hour, half = int(match[2]), match[6].lower()
    if half in _BEFORE_NOON | _AFTER_NOON:
        hour = hour % 12 + 12 * (half in _AFTER_NOON)
    elif 0 < hour < 13:
        return None
    text = f"{match[1]}T{hour:02}:{match[3]}:{match[4]}.{match[5]}"
    try:
        datetime.fromisoformat(text)
    except ValueError:
        return None
    return text

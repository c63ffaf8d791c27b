"""HaaTa's charts: presses and releases side by side, quoted cells, short columns padded; gf and mm."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from fdvv.formats.force.text import Table, body, first_filled, refusal
from fdvv.formats.force.types import Notes, RawCycle, Reading, Track
from fdvv.io.text import cells
from fdvv.model.curve import Stroke
from fdvv.units import cN_from_gf

_TITLE = re.compile(r"^(.*?)\s*\b(Press|Release)\s*(\d*)\s*,\s*([xy])$", re.IGNORECASE)

Key = tuple[str, str, str]
"""Cycle (prefix and number), stroke, axis."""


def column_keys(title: str) -> list[Key]:
    """Read one column's name; a name joined by semicolons serves several curves.

    "Press 3, x" gives [("3", "press", "x")], "RS232 (Cal) Press, x; Analog (Cal) Press, x" two keys.
    """
    found = []
    for part in title.split(";"):
        match = _TITLE.match(part.strip())
        if match:
            prefix, stroke, number, axis = match.groups()
            found.append((f"{prefix} {number}".strip(), stroke.lower(), axis.lower()))
    return found


def is_haata(lines: Sequence[str]) -> bool:
    """Recognise the charts by at least one pair of "Press n, x" and "Press n, y" columns."""
    keys = {key for title in cells(lines[0], ",") for key in column_keys(title)}
    return any((cycle, stroke, "y") in keys for cycle, stroke, axis in keys if axis == "x")


def read_haata(source: Path, lines: Sequence[str], notes: Notes) -> Reading:
    """Read every cycle that has a displacement and a force column for at least one stroke."""
    at = first_filled(lines)
    titles = cells(lines[at], ",")
    places: dict[Key, int] = {}
    for index, title in enumerate(titles):
        keys = column_keys(title)
        if not keys and title.strip():
            notes.say(f"column {index + 1}: {title[:40]!r} is no stroke's column; it was not read")
        if len(keys) > 1:
            notes.say(f"column {index + 1}: {title!r} names {len(keys)} curves; it was read for each of them")
        for key in keys:
            places.setdefault(key, index)
    table = body(source, lines, at + 1)
    labels = list(dict.fromkeys(cycle for cycle, _, _ in places))
    _tell_missing(labels, at, notes)
    cycles = [_cycle(table, label, places, notes) for label in labels]
    if not any(cycle.press or cycle.release for cycle in cycles):
        raise refusal(source, f"line {at + 1}", "no column of displacement has its column of force")
    return Reading("haata", source.stem, cycles)


def _tell_missing(labels: list[str], at: int, notes: Notes) -> None:
    numbers = [int(label) for label in labels if label.isdigit()]
    missing = sorted(set(range(1, max(numbers, default=0) + 1)) - set(numbers))[:8]
    if missing:
        notes.say(
            f"line {at + 1}: the file holds no cycle {', '.join(map(str, missing))}; the others were read"
        )


def _cycle(table: Table, label: str, places: dict[Key, int], notes: Notes) -> RawCycle:
    strokes = {}
    for stroke in Stroke:
        x, force = places.get((label, stroke.value, "x")), places.get((label, stroke.value, "y"))
        if x is None and force is None:
            continue
        where = f"{stroke.capitalize()} {label}" if label.isdigit() else f"{stroke} of {label}"
        where = where if label else str(stroke)
        if x is None or force is None:
            lacking = "displacement" if x is None else "force"
            notes.say(f"{where}: its {lacking} column is missing; the stroke was left out")
            continue
        columns = table.columns([x, force], notes, where)
        strokes[stroke] = Track(where, columns[0], cN_from_gf(columns[1]))
    title = f"Cycle {label}" if label.isdigit() else label
    return RawCycle(title, press=strokes.get(Stroke.PRESS), release=strokes.get(Stroke.RELEASE))

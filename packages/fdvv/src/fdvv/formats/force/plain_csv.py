"""Any table with named columns: the header says what each column is, its unit, stroke and velocity."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from fdvv.formats.force.text import Column, Quantity, Table, body, describe, guess_length_mm, refusal
from fdvv.formats.force.types import Notes, RawCycle, Reading, Track, pair_up
from fdvv.io.text import cells, sniff_separator
from fdvv.model.curve import Stroke
from fdvv.units import FloatArray

FORMATS = {
    ("x_um", "force_gf", "actuated"): "bluepylons-csv",
    ("millis", "steps", "travel (mm)", "scale raw", "scale (grams)"): "buddyog",
}
"""Published tables that are known by their exact column names."""
_IGNORED = {"buddyog": {"Steps", "Scale raw"}}


def find_header(lines: Sequence[str]) -> tuple[int, str, list[Column]] | None:
    """Find the first of the leading lines that names a force, and a displacement beside it."""
    for at, line in enumerate(lines[:60]):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        separator = sniff_separator(line)
        columns = [describe(i, title) for i, title in enumerate(cells(line, separator))]
        if len({Quantity.FORCE, Quantity.DISPLACEMENT} & {c.quantity for c in columns}) == 2:
            return at, separator, columns
    return None


def read_plain_csv(source: Path, lines: Sequence[str], stroke: Stroke | None, notes: Notes) -> Reading:
    """Read one curve per force column; ``stroke`` is what the file's name says, if it says anything.

    A force belongs to the nearest displacement on its left, else to the first one.
    """
    found = find_header(lines)
    if found is None:
        reason = "no header names a displacement and a force"
        remedy = "name the columns with their units, e.g. displacement_mm,force_cN"
        raise refusal(source, "line 1", reason, remedy)
    at, separator, columns = found
    form = FORMATS.get(tuple(c.title.lower() for c in columns), "plain-csv")
    width = len(columns)
    columns = [c for c in columns if c.title not in _IGNORED.get(form, ())]
    table = body(source, lines, at + 1, separator)
    comma = separator != "," and any(re.match(r"^\s*-?\d+,\d+\s*$", c) for row in table.rows[:5] for c in row)
    table = Table(source, table.rows, table.first_line, comma)
    table.check_width(width)
    _tell_unread(columns, notes)
    forces = [c for c in columns if c.quantity is Quantity.FORCE]
    _check_distinct(source, at, forces)
    cycles = [_curve(table, columns, force, stroke, len(forces) > 1, notes) for force in forces]
    runs = [cycle for cycle in cycles if cycle.run]
    pairs = pair_up([c for c in cycles if c.press], [c for c in cycles if c.release])
    return Reading(form, _name(source, form), runs + pairs)


def _name(source: Path, form: str) -> str:
    # a log is called DataLog_1; its folder names the dome
    if form == "buddyog" and re.match(r"(.*-)?DataLog_\d+$", source.stem):
        return f"{source.parent.name.replace('_', ' ')}, {source.stem.split('-')[-1]}".lstrip(", ")
    return source.stem


def _tell_unread(columns: Sequence[Column], notes: Notes) -> None:
    unread = [repr(c.title[:30]) for c in columns if c.quantity is Quantity.OTHER and c.title]
    if unread:
        notes.say(f"header: column{'s' if len(unread) > 1 else ''} {', '.join(unread[:6])} not read")


def _check_distinct(source: Path, at: int, forces: Sequence[Column]) -> None:
    titles = [c.title for c in forces]
    for column in forces:
        if titles.count(column.title) > 1 and column.stroke is None and column.velocity_mm_s is None:
            reason = f"{titles.count(column.title)} columns are all called {column.title[:30]!r}"
            raise refusal(source, f"line {at + 1}", reason, "give each its own name")
        if column.scale is None:
            place = f"line {at + 1}, column {column.index + 1}"
            reason = f"force column {column.title[:30]!r} has no unit, and numbers cannot tell gf from cN"
            raise refusal(source, place, reason, "write the unit into the header, e.g. force_gf or force (N)")


def _curve(
    table: Table,
    columns: Sequence[Column],
    force: Column,
    stroke: Stroke | None,
    several: bool,
    notes: Notes,
) -> RawCycle:
    travel = _beside(columns, Quantity.DISPLACEMENT, force) or force
    extra = {q: _beside(columns, q, force) for q in (Quantity.TIME, Quantity.CLOSED)}
    # a clock without a unit tells no time
    known = {q: column for q, column in extra.items() if column is not None and column.scale is not None}
    picks = [travel.index, force.index, *(column.index for column in known.values())]
    x, values, *rest = table.columns(picks, notes, force.title)
    scaled = {q: values * (known[q].scale or 1.0) for q, values in zip(known, rest, strict=True)}
    where = force.title if several else "run"
    # rounded to a picometre, so that 1880 um is 1.88 mm
    x_mm = np.round(x * _length_scale(table.source, travel, x, notes), 9)
    force_cN = values * (force.scale or 1.0)
    track = Track(where, x_mm, force_cN, scaled.get(Quantity.TIME), scaled.get(Quantity.CLOSED))
    return _as_cycle(track, force, stroke, where if several else "")


def _beside(columns: Sequence[Column], quantity: Quantity, force: Column) -> Column | None:
    of = [c for c in columns if c.quantity is quantity]
    left = [c for c in of if c.index < force.index]
    return left[-1] if left else (of[0] if of else None)


def _length_scale(source: Path, column: Column, values: FloatArray, notes: Notes) -> float:
    if column.scale is not None:
        return column.scale
    span = float(np.ptp(values))
    scale = guess_length_mm(span)
    if scale is None:
        reason = f"{column.title[:30]!r} has no unit, and a span of {span:.3g} fits none"
        remedy = "write the unit into the header, e.g. displacement_mm"
        raise refusal(source, f"column {column.index + 1}", reason, remedy)
    unit = {1.0: "mm", 1e-3: "um", 1000.0: "m"}[scale]
    notes.say(
        f"column {column.index + 1}: {column.title[:30]!r} has no unit; read as {unit}, the only one "
        f"in which a span of {span:.3g} is a button's travel"
    )
    return scale


def _as_cycle(track: Track, force: Column, stroke: Stroke | None, label: str) -> RawCycle:
    x = track.x_mm
    stroke = force.stroke or stroke
    cycle = RawCycle(label, velocity_mm_s=force.velocity_mm_s)
    turns = x.size > 8 and 0.1 * x.size < int(np.argmax(np.abs(x - x[0]))) < 0.9 * x.size
    if turns and force.stroke is None:
        return replace(cycle, run=track)
    falls = x[-1] < x[0] and track.force_cN[0] > track.force_cN[-1]
    released = stroke is Stroke.RELEASE or (stroke is None and falls)
    return replace(cycle, release=track) if released else replace(cycle, press=track)

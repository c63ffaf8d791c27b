"""The ThereminGoat bench: raw export, high-resolution export and the tidy re-publication, all gf and mm."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from fdvv.formats.force.text import FORCE_cN, LENGTH_mm, Table, body, first_filled, refusal
from fdvv.formats.force.types import Notes, RawCycle, Reading, Track
from fdvv.units import FloatArray, cN_from_gf

_RAW = re.compile(r"^No\.,Force,Unit,Displacement,Unit\b", re.IGNORECASE)
_KEY = re.compile(r"^([A-Z0-9][A-Z0-9 ]+) = (.*)$")


OTHER_NAMES_ratio = 0.05
"""More rows than this of another name are of another switch; fewer are a damage."""


def is_raw(lines: Sequence[str]) -> bool:
    """Recognise the raw export by its column names under a few lines of statistics."""
    return any(_RAW.match(line) for line in lines[:12])


def is_highres(lines: Sequence[str]) -> bool:
    """Recognise the high-resolution export by its ``KEY = value`` lines, one of them the unit."""
    keys = [_KEY.match(line) for line in lines[:16]]
    return any(k is not None and k.group(1) == "UNIT" for k in keys)


def is_tidy(lines: Sequence[str]) -> bool:
    """Recognise the tidy form by its four column names, in any order."""
    names = [name.strip().lower() for name in lines[0].split(",")]
    return sorted(names) == ["displacement", "force", "judge", "name"]


def read_raw(source: Path, lines: Sequence[str], notes: Notes) -> Reading:
    """Read the raw export; the judge column only marks a force above 200 gf and drops nothing."""
    at = next(i for i, line in enumerate(lines) if _RAW.match(line))
    table = body(source, lines, at + 1)
    if not table.rows:
        raise refusal(source, f"line {at + 1}", "there are no samples below the column names")
    scales = [_unit(source, table, 2, FORCE_cN), _unit(source, table, 4, LENGTH_mm)]
    force, x = table.columns([1, 3], notes)
    return _run("thereminGoat-raw", clean_name(source.stem), x * scales[1], force * scales[0])


def _unit(source: Path, table: Table, column: int, known: dict[str, float]) -> float:
    found = [row[column].strip() for row in table.rows if len(row) > column]
    name = max(sorted(set(found)), key=found.count, default="")
    if name.lower() not in known:
        where = f"from line {table.first_line}, column {column + 1}"
        reason = f"unknown unit {name[:20]!r}"
        raise refusal(source, where, reason, "use gf, N, mm or another unit known here")
    return known[name.lower()]


def read_highres(source: Path, lines: Sequence[str], notes: Notes) -> Reading:
    """Read the high-resolution export: force, displacement; its recording rate gives the clock."""
    first = first_filled(lines)
    keys = [_KEY.match(line) for line in lines[: first + 40]]
    at = max(i for i, key in enumerate(keys) if key)
    values = {key.group(1): key.group(2).strip() for key in keys if key}
    units = [unit.strip().lower() for unit in values["UNIT"].split(",")]
    if len(units) != 2 or units[0] not in FORCE_cN or units[1] not in LENGTH_mm:
        raise refusal(source, "UNIT", f"unknown units {values['UNIT'][:20]!r}", "expected gf,mm or the like")
    table = body(source, lines, at + 1)
    table.check_width(2)
    force, x = table.columns([0, 1], notes)
    interval = re.match(r"\d*\.?\d+", values.get("RECORDING RATE", ""))
    # rows left out would bend the clock; then there is none
    clean = not notes.sentences
    time = np.arange(x.size, dtype=np.float64) * float(interval.group()) if interval and clean else None
    name = clean_name(source.stem)
    return _run("thereminGoat-highres", name, x * LENGTH_mm[units[1]], force * FORCE_cN[units[0]], time)


def read_tidy(source: Path, lines: Sequence[str], notes: Notes) -> Reading:
    """Read the tidy form: force, displacement, judge, name, found by their names."""
    at = first_filled(lines)
    names = [name.strip().lower() for name in lines[at].split(",")]
    table = body(source, lines, at + 1)
    table.check_width(len(names))
    force, x = table.columns([names.index("force"), names.index("displacement")], notes)
    column = names.index("name")
    titles = [row[column].strip() for row in table.rows if len(row) == 4]
    title = max(sorted(set(titles)), key=titles.count, default="") or clean_name(source.stem)
    if len(titles) - titles.count(title) > OTHER_NAMES_ratio * len(titles) and title:
        reason = f"{len(set(titles))} names in one file"
        raise refusal(source, f"column {column + 1}", reason, "put each switch in a file of its own")
    if len(set(titles)) > 1:
        notes.say(f"column {column + 1}: {len(set(titles))} names in one file; {title[:60]!r} was taken")
    return _run("thereminGoat-tidy", title, x, cN_from_gf(force))


def is_stroke(lines: Sequence[str]) -> bool:
    """Recognise half of a stroke pair: no header, displacement and force with four decimals each."""
    pattern = re.compile(r"^-?\d+\.\d{4},-?\d+\.\d{4}$")
    head = [line.strip() for line in lines[:20] if line.strip()]
    fits = [bool(pattern.match(line)) for line in head]
    # a first line that does not fit is a header, and a table with a header says its own units
    return len(head) >= 2 and fits[0] and sum(fits) >= 0.8 * len(head)


def read_stroke(source: Path, lines: Sequence[str], where: str, notes: Notes) -> Track:
    """Read half of a stroke pair: displacement (mm) first, force (gf) second."""
    x, force = body(source, lines, 0).columns([0, 1], notes, where)
    return Track(where, x, cN_from_gf(force))


def clean_name(stem: str) -> str:
    """Take the switch's name out of a file's name."""
    stem = stem.split("__")[-1].replace("_", " ")
    stem = re.sub(r"(\.excerpt|\.(down|up)stroke)$", "", stem, flags=re.IGNORECASE)
    stem = re.sub(r"\s*(ra ?w|high ?res\w*)?\s*(data)?\s*csv$", "", stem, flags=re.IGNORECASE)
    return re.sub(r"\s*high ?re\w*raw$", "", stem, flags=re.IGNORECASE).strip() or stem


def _run(form: str, name: str, x: FloatArray, force: FloatArray, time: FloatArray | None = None) -> Reading:
    return Reading(form, name, [RawCycle("", run=Track("run", x, force, time))])

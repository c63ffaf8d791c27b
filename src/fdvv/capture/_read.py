"""Read a file of force curves, whatever bench it is from."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

from fdvv.capture import _theremingoat as goat
from fdvv.capture._build import build
from fdvv.capture._haata import is_haata, read_haata
from fdvv.capture._ods import is_ods, read_ods
from fdvv.capture._pairs import base_name, stroke_of
from fdvv.capture._plain_csv import read_plain_csv
from fdvv.capture._record import Notes, RawCycle, Reading
from fdvv.capture._tester_json import is_tester_json, read_tester_json
from fdvv.capture._text import decode, refusal
from fdvv.capture._types import ForceFile
from fdvv.errors import InputError, ModelError
from fdvv.model import Stroke

LARGEST_FILE = 64 * 2**20

Lines = Sequence[str]
READERS: tuple[tuple[Callable[[Lines], bool], Callable[[Path, Lines, Notes], Reading]], ...] = (
    (is_tester_json, read_tester_json),
    (goat.is_tidy, goat.read_tidy),
    (goat.is_raw, goat.read_raw),
    (goat.is_highres, goat.read_highres),
    (is_haata, read_haata),
)
"""Text formats known by their first lines; a table with named columns is what none of them takes."""


def reader_names() -> tuple[str, ...]:
    """List the formats that can be read, as ForceFile.format gives them."""
    return (
        "thereminGoat-raw",
        "thereminGoat-highres",
        "thereminGoat-tidy",
        "stroke-pair",
        "haata",
        "bluepylons-ods",
        "bluepylons-csv",
        "buddyog",
        "tester-json",
        "plain-csv",
    )


def read_force_file(path: str | Path) -> ForceFile:
    """Read one file of force curves, found out by looking inside it.

    Half of a stroke pair brings the other half with it. What was repaired is told in ``warnings``.
    Raises InputError, one line, if the file cannot be used.
    """
    path = Path(path)
    notes = Notes()
    reading = _read(path, notes)
    try:
        return build(path, reading, notes)
    except ModelError as error:
        raise refusal(path, "whole file", f"no valid curve: {error}") from None


def _read(path: Path, notes: Notes) -> Reading:
    content = _content(path)
    if is_ods(content):
        return read_ods(path, content, notes)
    lines = decode(path, content, notes)
    head = [line for line in lines if line.strip()][:60] or [""]
    for recognise, read in READERS:
        if recognise(head):
            return read(path, _from_first(lines), notes)
    return _strokes_or_table(path, lines, notes)


def _content(path: Path) -> bytes:
    try:
        size = path.stat().st_size
        if size > LARGEST_FILE:
            raise refusal(path, "whole file", f"it has {size / 2**20:.0f} MiB; at most 64 are read")
        return path.read_bytes()
    except OSError as error:
        raise InputError(path, "whole file", f"cannot be read ({error.strerror})", "check the path") from None
    except ValueError as error:
        raise InputError(repr(str(path)), "path", str(error), "check the path") from None


def _from_first(lines: Lines) -> Lines:
    """Leave off the empty lines before the header."""
    start = next((i for i, line in enumerate(lines) if line.strip()), 0)
    return lines[start:] if start else lines


def _strokes_or_table(path: Path, lines: Lines, notes: Notes) -> Reading:
    named = stroke_of(path)
    mine = _half(path, lines, named[0] if named else None, notes)
    if named is None:
        return mine
    stroke, sibling = named
    name = base_name(path)
    if not sibling.is_file():
        notes.say(f"{sibling.name} is not there; the file holds the {stroke.value} only")
        return replace(mine, name=name)
    other_stroke = Stroke.RELEASE if stroke is Stroke.PRESS else Stroke.PRESS
    theirs = _half(sibling, decode(sibling, _content(sibling), notes), other_stroke, notes)
    return Reading(mine.format, name, _join(mine.cycles, theirs.cycles))


def _half(path: Path, lines: Lines, stroke: Stroke | None, notes: Notes) -> Reading:
    if not goat.is_stroke(lines):
        return read_plain_csv(path, lines, stroke, notes)
    if stroke is None:
        raise refusal(
            path,
            "line 1",
            "two columns without a header, and the file's name tells no stroke",
            "name the columns with their units, or the file NAME.downstroke.csv",
        )
    track = goat.read_stroke(path, lines, stroke.value, notes)
    cycle = RawCycle("", press=track) if stroke is Stroke.PRESS else RawCycle("", release=track)
    return Reading("stroke-pair", base_name(path), [cycle])


def _join(mine: Sequence[RawCycle], theirs: Sequence[RawCycle]) -> list[RawCycle]:
    """Join presses and releases of the same velocity from two files; what finds no partner stays alone."""
    rest = list(theirs)
    joined = []
    for cycle in mine:
        match = next((c for c in rest if _fits(cycle, c)), None)
        if match is not None:
            rest.remove(match)
            cycle = replace(cycle, press=cycle.press or match.press, release=cycle.release or match.release)
        joined.append(cycle)
    return joined + rest


def _fits(a: RawCycle, b: RawCycle) -> bool:
    both = (a.press is None) != (b.press is None) and (a.release is None) != (b.release is None)
    return both and a.velocity_mm_s == b.velocity_mm_s

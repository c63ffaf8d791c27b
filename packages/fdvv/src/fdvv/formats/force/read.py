"""Read a file of force curves, whatever bench it is from."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from fdvv.errors import InputError, ModelError
from fdvv.formats.force import repair
from fdvv.formats.force import theremingoat as goat
from fdvv.formats.force.excursions import drop_spikes, drop_stuck_probe
from fdvv.formats.force.haata import is_haata, read_haata
from fdvv.formats.force.ods import is_ods, read_ods
from fdvv.formats.force.plain_csv import read_plain_csv
from fdvv.formats.force.split import hand_over_turn, orient, split_run
from fdvv.formats.force.tester_json import is_tester_json, read_tester_json
from fdvv.formats.force.text import LEAST_SAMPLES, decode, refusal
from fdvv.formats.force.types import Cycle, ForceFile, Notes, RawCycle, Reading, Track, pair_up
from fdvv.io.files import open_plain
from fdvv.model.curve import MeasuredCurve, Stroke

_ENDING = re.compile(r"(?P<mark>[._])(?P<stroke>downstroke|upstroke|press|release)\Z", re.IGNORECASE)
OTHER = {"downstroke": "upstroke", "upstroke": "downstroke", "press": "release", "release": "press"}


def stroke_of(path: Path) -> tuple[Stroke, Path] | None:
    """Return the stroke in a file's name and the path of the other stroke; None if it names none."""
    ending = _ENDING.search(path.stem)
    if ending is None:
        return None
    named = ending["stroke"].lower()
    stroke = Stroke.PRESS if named in ("downstroke", "press") else Stroke.RELEASE
    return stroke, path.with_name(f"{path.stem[: ending.start()]}{ending['mark']}{OTHER[named]}{path.suffix}")


def companion(path: Path) -> Path | None:
    """Return the path of the other stroke of a pair; None if the name says no stroke."""
    named = stroke_of(path)
    return named and named[1]


def base_name(path: Path) -> str:
    """Return the name that both halves share."""
    return _ENDING.sub("", path.stem) or path.stem


MOST_BACK_mm, MOST_BACK_ratio = 1.0, 0.2
"""A stroke that runs back by more than both is several strokes. Real stages waver by up to 0.73 mm."""

LEAST_TRAVEL_mm = 0.02
"""Below four steps of the finest bench nothing was pressed."""


def build(source: Path, reading: Reading, notes: Notes) -> ForceFile:
    """Check a reading and make it a file; raises InputError if no stroke is left."""
    parts: list[RawCycle] = []
    for raw in reading.cycles:
        possible = raw.map(lambda track: _possible(track, notes))
        parts += split_run(possible, notes)
    placed = [_placed(part, notes) for part in parts]
    cycles = [_cycle(part, [other for other in placed if other is not part], notes) for part in placed]
    cycles = [cycle for cycle in cycles if cycle.press or cycle.release]
    if not cycles:
        why = notes.sentences[-1] if notes.sentences else "the displacement never changes"
        raise refusal(source, "whole file", f"no stroke in it: {why}")
    return ForceFile(reading.name, reading.format, tuple(cycles), notes.lines())


def _possible(track: Track, notes: Notes) -> Track | None:
    if track.x_mm.size == 0:
        return None
    track = repair.drop_impossible(track, notes)
    if track.x_mm.size >= 3:
        track = repair.drop_stray_positions(track, notes)
    return track if _long_enough(track, notes) else None


def _long_enough(track: Track, notes: Notes) -> bool:
    short = ""
    if track.x_mm.size < LEAST_SAMPLES:
        short = f"only {track.x_mm.size} usable samples"
    elif np.ptp(track.x_mm) < LEAST_TRAVEL_mm:
        short = f"the displacement stays within {np.ptp(track.x_mm):.3g} mm"
    if short:
        notes.say(f"{track.where}: {short}; it was left out")
    return not short


def _placed(raw: RawCycle, notes: Notes) -> RawCycle:
    """Point both strokes into the button, the samples of the turn and of a slip where they belong."""
    oriented = raw.map(lambda track: orient(track, notes, begins_out=track is raw.press))
    return repair.correct_slip(hand_over_turn(oriented, notes), notes)


def _cycle(raw: RawCycle, others: Sequence[RawCycle], notes: Notes) -> Cycle:
    presses = [other.press for other in others if other.press]
    releases = [other.release for other in others if other.release]
    actuation = repair.switching_mm(raw.press, Stroke.PRESS, notes)
    reset = repair.switching_mm(raw.release, Stroke.RELEASE, notes)
    return Cycle(
        _curve(raw.press, Stroke.PRESS, raw.velocity_mm_s, presses, notes),
        _curve(raw.release, Stroke.RELEASE, raw.velocity_mm_s, releases, notes),
        raw.actuation_mm if actuation is None else actuation,
        raw.reset_mm if reset is None else reset,
        raw.label,
        raw.velocity_mm_s is not None,
    )


def _curve(
    track: Track | None, stroke: Stroke, velocity: float | None, repeats: Sequence[Track], notes: Notes
) -> MeasuredCurve | None:
    if track is None or not _long_enough(track, notes):
        return None
    track = repair.drop_lost_tare(drop_spikes(track, notes, repeats), notes)
    if stroke is Stroke.PRESS:
        track = drop_stuck_probe(track, notes, repeats)
    if not _long_enough(track, notes):
        return None
    _check_one_stroke(track)
    repair.warn_of_jumps(track, notes)
    speed = repair.mean_velocity_mm_s(track) if velocity is None else velocity
    curve = MeasuredCurve(*repair.rising(track, notes), stroke, speed)
    repair.warn_of_touches(curve, track.where, notes)
    return curve


def _check_one_stroke(track: Track) -> None:
    """Raise ModelError where one column holds several strokes, one after another."""
    loaded = track.x_mm[track.force_cN > repair.AIR_cN]
    if loaded.size < 2:
        return
    x = loaded if loaded[-1] > loaded[0] else loaded[::-1]
    back = float((np.maximum.accumulate(x) - x).max())
    if back > max(MOST_BACK_mm, MOST_BACK_ratio * float(np.ptp(track.x_mm))):
        raise ModelError(f"{track.where}: the displacement runs back by {back:.2f} mm within one stroke")


LARGEST_FILE = 16 * 2**20
"""Ten times the largest file of the published collections."""
MOST_LINES, MOST_CELLS = 300_000, 3_000_000
"""Of a text file: a hundred times the longest published; more would take ten seconds and a gigabyte."""
Lines = Sequence[str]

READERS: tuple[tuple[Callable[[Lines], bool], Callable[[Path, Lines, Notes], Reading]], ...] = (
    (is_tester_json, read_tester_json),
    (goat.is_tidy, goat.read_tidy),
    (goat.is_raw, goat.read_raw),
    (goat.is_highres, goat.read_highres),
    (is_haata, read_haata),
)
"""Text formats: how each is recognised by its first lines that are not blank, and read from all its lines.

A table with named columns is what none of them takes.
"""


def read_force_file(path: str | Path) -> ForceFile:
    """Read one file of force curves, found out by looking inside it.

    Half of a stroke pair brings the other half with it. ``warnings`` say what was repaired.
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
    lines = _lines(path, content, notes)
    head = [line for line in lines if line.strip()][:60] or [""]
    for recognise, read in READERS:
        if recognise(head):
            return read(path, lines, notes)
    return _strokes_or_table(path, lines, notes)


def _lines(path: Path, content: bytes, notes: Notes) -> list[str]:
    lines = decode(path, content, notes)
    if len(lines) > MOST_LINES:
        raise refusal(path, "whole file", f"it has {len(lines)} lines; at most {MOST_LINES} are read")
    cells = sum(map(content.count, (b",", b";", b"\t")))
    if cells > MOST_CELLS:
        raise refusal(path, "whole file", f"it has {cells} cells; at most {MOST_CELLS} are read")
    return lines


def _content(path: Path) -> bytes:
    try:
        size = path.stat().st_size
        if size > LARGEST_FILE:
            raise refusal(path, "whole file", f"it has {size / 2**20:.0f} MiB; at most 16 are read")
        with open_plain(path) as stream:
            return stream.read()
    except OSError as error:
        raise InputError(path, "whole file", f"cannot be read ({error.strerror})", "check the path") from None
    except ValueError as error:
        raise InputError(repr(str(path)), "path", str(error), "check the path") from None


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
    theirs = _half(sibling, _lines(sibling, _content(sibling), notes), other_stroke, notes)
    return Reading(mine.format, name, pair_up(mine.cycles, theirs.cycles))


def _half(path: Path, lines: Lines, stroke: Stroke | None, notes: Notes) -> Reading:
    if not goat.is_stroke(lines):
        return read_plain_csv(path, lines, stroke, notes)
    if stroke is None:
        reason = "two columns without a header, and the file's name tells no stroke"
        remedy = "name the columns with their units, or the file NAME.downstroke.csv"
        raise refusal(path, "line 1", reason, remedy)
    track = goat.read_stroke(path, lines, stroke.value, notes)
    cycle = RawCycle("", press=track) if stroke is Stroke.PRESS else RawCycle("", release=track)
    return Reading("stroke-pair", base_name(path), [cycle])


SUFFIXES = (".csv", ".ods", ".json", ".txt")
NOT_DATA = ("readme", "license", "licence", "copying", "changelog", "contributing", "notice")


def find_force_files(folder: str | Path) -> list[Path]:
    """List candidates under a folder, in the order of their paths; a stroke pair is listed once.

    Only suffixes and names are looked at (.csv .ods .json .txt, no hidden files, readmes or licences);
    whether a file can be read shows when it is read. Raises InputError if there is no such folder.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise InputError(folder, "path", "there is no such folder", "give a folder of measurements")
    visible = (
        path
        for path in folder.rglob("*")
        if not any(part.startswith(".") for part in path.relative_to(folder).parts)
    )
    found = {path for path in visible if is_force_file(path.name) and path.is_file()}
    return sorted(path for path in found if not _second_half(path, found))


def is_force_file(name: str) -> bool:
    """Return whether a file's name alone may be that of force curves."""
    return name.lower().endswith(SUFFIXES) and not name.lower().startswith(NOT_DATA)


def _second_half(path: Path, known: set[Path]) -> bool:
    named = stroke_of(path)
    return named is not None and named[0] is Stroke.RELEASE and named[1] in known

"""The ``*.recording.jsonl`` file: a journal with a head, a line for each take, and corrections."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

import numpy as np

from fdvv.errors import InputError, ModelError
from fdvv.eventlog import JournalKind, line_of, read_bodies
from fdvv.io.columns import pack_column
from fdvv.io.documents import Head, Kind, Layout, check_head, convert, document, to_plain
from fdvv.io.files import write_atomic
from fdvv.recording.types import Bench, Recording, Stream, Take

STREAM = ("scale", "zero")
TAKE = ("stage", "velocity_mm_s", "remark")
RECORDING = ("licence", "person")
TEXTS = (*RECORDING, "stage", "remark")
BENCH = tuple(f.name for f in fields(Bench))
RECORDING_SUFFIX = ".recording.jsonl"
"""How a recording's name ends."""
REMEDY = "compare with docs/reference/recording-file.md"
KIND = Kind("fdvv-recording", 1, "a recording", REMEDY)
LINES = JournalKind({"head": Any, "take": Any, "mend": Any}, REMEDY)
CUT = "the last record is not whole and is left out"


@dataclass(frozen=True)
class Correction:
    """What holds from now on of a stream, a take or the recording.

    Attributes
    ----------
    values : what holds from now on. Of a stream: scale, zero; of a take: stage, velocity_mm_s, remark; of the
        recording: licence, person and every field of Bench.
    take : number of the take that it is for; None for all that were made before it.
    stream : name of the stream that it is for; None corrects the take, or without a take the recording.
    why : what was found out, for the reader of the file.
    made : when, as ISO 8601.
    """

    values: Mapping[str, Any]
    take: int | None = None
    stream: str | None = None
    why: str = ""
    made: str = ""

    def __post_init__(self) -> None:
        whole = self.take is None and self.stream is None
        may = STREAM if self.stream is not None else (*RECORDING, *BENCH) if whole else TAKE
        wrong = sorted(set(self.values) - set(may))
        if wrong or not self.values:
            raise ModelError(f"a correction may set {', '.join(may)} here, got {wrong or 'nothing'}")
        for key, value in self.values.items():
            if not _fits(key, value):
                raise ModelError(f"a correction cannot set {key} to {value!r:.40}")


TAKES = {"takes"}
"""No field of the head: each is a line."""
LAYOUT = Layout(
    last=("sources", "warnings", "marks", "streams", "t_s", "raw"),
    needed={f.name for kind in (Recording, Bench, Take, Stream, Correction) for f in fields(kind)} - TAKES,
    beside=(),
)


def schema() -> dict[str, Any]:
    """Return the JSON schema of one line, as published in docs/reference/fdvv-recording.schema.json."""
    from fdvv.io.schema import DIALECT, add_head, components

    refs, parts = components((Recording, Take, Correction), LAYOUT)
    del parts["Recording"]["properties"]["takes"]
    add_head(parts["Recording"], KIND)
    records = [
        {"type": "object", "properties": {key: ref}, "required": [key], "additionalProperties": False}
        for key, ref in zip(LINES.types, refs, strict=True)
    ]
    checksum = {"type": "integer", "minimum": 0, "maximum": 2**32 - 1}
    return {
        "$schema": DIALECT,
        "title": "A line of a recording",
        "type": "object",
        "properties": {"crc32": checksum, "record": {"oneOf": records}},
        "required": ["crc32", "record"],
        "additionalProperties": False,
        "$defs": parts,
    }


def pack_head(recording: Recording) -> dict[str, Any]:
    return document(recording, KIND, layout=LAYOUT, keep=lambda field, _value: field.name not in TAKES)


def pack_take(take: Take) -> dict[str, Any]:
    """Encode a take. ModelError for a kind of number that no file holds."""
    try:
        return dict(to_plain(take, LAYOUT, special=_pack))
    except ValueError as error:
        raise ModelError(f"take {take.number}: {error}") from error


def _pack(value: Any) -> Any:
    return pack_column(value) if isinstance(value, np.ndarray) else value


def _unpack_head(path: Path, found: Any) -> Recording:
    """Decode a recording without takes. Raises ValueError, InputError."""
    facts = dict(found) if isinstance(found, dict) else {}
    head = Head(facts.pop("format", None), facts.pop("version", None))
    check_head(head, path, KIND, "line 1, $")
    if TAKES & facts.keys():
        raise ValueError("Object contains unknown field `takes`")
    return convert(facts, Recording, LAYOUT)


def _fits(key: str, value: object) -> bool:
    """Return whether a value is of the field's type; its range is checked where it is used."""
    if key in TEXTS:
        return isinstance(value, str)
    if key == "clocks_go_on":
        return isinstance(value, bool)
    if value is None:
        return key == "velocity_mm_s"
    return isinstance(value, int | float) and not isinstance(value, bool)


def corrected(recording: Recording, correction: Correction) -> Recording:
    """Return a recording with a correction applied. ModelError if it names what is not there."""
    if correction.take is not None and not 1 <= correction.take <= len(recording.takes):
        raise ModelError(f"there is no take {correction.take} to correct, only {len(recording.takes)}")
    if correction.take is None and correction.stream is None:
        of_bench = {key: value for key, value in correction.values.items() if key in BENCH}
        own = {key: value for key, value in correction.values.items() if key in RECORDING}
        return replace(recording, bench=replace(recording.bench, **of_bench), **own)
    chosen = [take for take in recording.takes if correction.take in (None, take.number)]
    if correction.stream is not None:
        chosen = [take for take in chosen if any(s.name == correction.stream for s in take.streams)]
        if not chosen:
            raise ModelError(f"there is no stream {correction.stream!r} to correct")
    new = {take.number: _take(take, correction) for take in chosen}
    return replace(recording, takes=tuple(new.get(take.number, take) for take in recording.takes))


def _take(take: Take, correction: Correction) -> Take:
    if correction.stream is None:
        return replace(take, **correction.values)
    streams = [replace(s, **correction.values) if s.name == correction.stream else s for s in take.streams]
    return replace(take, streams=tuple(streams))


def load_recording(path: Path | str) -> Recording:
    """Read a recording, corrections applied.

    A last line that was cut short, as a killed process leaves it, is left out with a warning.
    Raises InputError that names the line or the take and the remedy, also where the file cannot be read.
    """
    recording, end, whole = read_file(Path(path))
    if recording is None:
        raise InputError(path, "whole file", "holds no whole record", REMEDY)
    if end < whole:
        warning = f"{CUT}; takes kept: {len(recording.takes)}"
        return replace(recording, warnings=(*recording.warnings, warning))
    return recording


def save_recording(recording: Recording, path: Path | str) -> None:
    """Write a recording into a new file, whole or not at all.

    Raises InputError if there is a file already, for what was recorded is never written over; OSError.
    """
    path = Path(path)
    if path.exists():
        raise InputError(path, "output", "there is a file already", "name another, or remove it yourself")
    lines = [line_of({"head": pack_head(recording)})]
    lines += [line_of({"take": pack_take(take)}) for take in recording.takes]
    write_atomic(path, b"".join(lines))


def read_file(path: Path) -> tuple[Recording | None, int, int]:
    """Read a recording, where its last whole record ends, and the size of the file; None without a head.

    Raises InputError.
    """
    try:
        whole = path.stat().st_size
        return *_read(path), whole
    except OSError as error:
        reason = error.strerror or str(error)
        raise InputError(path, "whole file", reason, "check the path and its permissions") from error


def _read(path: Path) -> tuple[Recording | None, int]:
    recording: Recording | None = None
    takes: list[Take] = []
    end = 0
    for number, (key, found, after) in enumerate(read_bodies(path, LINES), 1):
        if (key == "head") != (number == 1):
            reason = "begins with no head" if number == 1 else "holds a second head"
            raise InputError(path, f"line {number}", reason, REMEDY)
        try:
            if key == "head":
                recording = _unpack_head(path, found)
            elif key == "take":
                takes.append(take := convert(found, Take, LAYOUT))
                if take.number != len(takes):
                    raise ModelError(f"take {len(takes)} bears the number {take.number}")
            elif recording is not None:
                correction = convert(found, Correction, LAYOUT)
                recording = corrected(replace(recording, takes=tuple(takes)), correction)
                takes = list(recording.takes)
        except (ModelError, ValueError, TypeError) as error:
            reason, _, place = str(error).partition(" - at ")
            inside = f", {place.strip('`')}" if place else ""
            raise InputError(path, f"line {number}{inside}", reason, REMEDY) from error
        end = after
    return (replace(recording, takes=tuple(takes)) if recording else None), end

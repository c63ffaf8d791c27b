"""The ``*.recording.jsonl`` file: a journal with a head, a line for each take, and corrections."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import msgspec

from fdvv.errors import InputError, ModelError
from fdvv.files import write_atomic
from fdvv.journal import JournalKind, line_of, read_records
from fdvv.recording._mend import Mend, mended
from fdvv.recording._records import (
    FORMAT,
    VERSION,
    MendRecord,
    pack_head,
    pack_take,
    unpack_head,
    unpack_take,
)
from fdvv.recording._types import Recording, Take

RECORDING_SUFFIX = ".recording.jsonl"
"""How a recording's name ends."""
REMEDY = "compare with docs/reference/recording-file.md"
KIND = JournalKind(frozenset({"head", "take", "mend"}), REMEDY)
CUT = "the last record is not whole and is left out"


def load_recording(path: Path | str) -> Recording:
    """Read a recording, corrections applied.

    A last line that was cut short, as a killed process leaves it, is left out and told of in the warnings.
    Raises InputError that names the line or the take and the remedy, also where the file cannot be read.
    """
    recording, end, whole = read_file(Path(path))
    if recording is None:
        raise InputError(path, "whole file", "holds no whole record", REMEDY)
    if end < whole:
        told = f"{CUT}; takes kept: {len(recording.takes)}"
        return replace(recording, warnings=(*recording.warnings, told))
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


def pack_mend(mend: Mend, made: str) -> dict[str, Any]:
    """Write a correction."""
    return {**asdict(mend), "values": dict(mend.values), "made": made}


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
    for number, (key, found, after) in enumerate(_records(path), 1):
        if (key == "head") != (number == 1):
            reason = "begins with no head" if number == 1 else "holds a second head"
            raise InputError(path, f"line {number}", reason, REMEDY)
        try:
            if key == "head":
                recording = unpack_head(_known(path, found))
            elif key == "take":
                takes.append(_next(found, len(takes) + 1))
            elif recording is not None:
                recording = mended(replace(recording, takes=tuple(takes)), _mend(found))
                takes = list(recording.takes)
        except (ModelError, ValueError, TypeError) as error:
            reason, _, place = str(error).partition(" - at ")
            raise InputError(path, f"line {number}{_inside(place)}", reason, REMEDY) from error
        end = after
    return (replace(recording, takes=tuple(takes)) if recording else None), end


def _records(path: Path) -> Iterator[tuple[str, Any, int]]:
    for record, end in read_records(path, KIND):
        ((key, found),) = record.items()
        yield key, found, end


def _inside(place: str) -> str:
    return f", {place.strip('`')}" if place else ""


def _known(path: Path, found: Any) -> Any:
    """Refuse a head of another format or version."""
    told = found if isinstance(found, dict) else {}
    if told.get("format") != FORMAT:
        reason = f'not a recording ("format" must be "{FORMAT}")'
        raise InputError(path, "line 1, $.format", reason, REMEDY)
    if told.get("version") != VERSION:
        reason = f"file version {told.get('version')!r:.40}, this fdvv reads version {VERSION}"
        raise InputError(path, "line 1, $.version", reason, "install the fdvv that wrote it, or a newer one")
    return found


def _next(found: Any, number: int) -> Take:
    """Read a take that must bear this number."""
    take = unpack_take(found)
    if take.number != number:
        raise ModelError(f"take {number} bears the number {take.number}")
    return take


def _mend(found: Any) -> Mend:
    record = msgspec.convert(found, MendRecord)
    return Mend(record.values, record.take, record.stream, record.why)

"""The presses of a session on file, each as it is made: people cannot repeat them.

``presses.jsonl`` holds a line ``{"crc32": …, "record": {…}}`` per record: ``{"run": {…}}`` each time the
session is begun or gone on with, ``{"press": {…}}`` for every press, used or not, with all columns and the
table it was made on. The checksum is that of the record's bytes. Each line is on the disk before the next
press begins; columns are packed as in recordings of devices.
"""

from __future__ import annotations

import fcntl
import json
import os
import zlib
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import msgspec

from fdvv.compensate import UNTUNED, Tuning
from fdvv.device import pack_record, unpack_press, unpack_surface
from fdvv.errors import InputError
from fdvv.files import sync_folder
from fdvv.model import ForceSurface, Press

PRESSES = "presses.jsonl"
REMEDY = "begin a new session in another folder"


class Run(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One start of the program on a session: when, with which versions, seed and bounds."""

    started: str
    seed: int | None
    versions: dict[str, str]
    acceptance: dict[str, int | float]


class Entry(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What became of one press.

    Attributes
    ----------
    number : counts all presses of the session from 1, those that were not used among them.
    reason : why it was not used; empty if it was.
    achieved_mm_s : mean speed of the press; None if it has none.
    made : when, UTC.
    """

    number: int
    velocity_mm_s: float
    reason: str
    achieved_mm_s: float | None
    made: str

    @property
    def used(self) -> bool:
        """Tell whether it taught or was judged."""
        return not self.reason

    def __str__(self) -> str:
        return f"press {self.number} at {self.velocity_mm_s:g} mm/s: {self.reason or 'used'}"


@dataclass(frozen=True, eq=False)
class Kept:
    """A press as it was kept; without columns if the device faulted before it could tell of it.

    tuning : of the controller; on file only where it does something.
    """

    entry: Entry
    surface: ForceSurface
    press: Press | None
    tuning: Tuning = UNTUNED


class Line(msgspec.Struct, forbid_unknown_fields=True):
    """A line of the file."""

    crc32: int
    record: msgspec.Raw


class PressLog:
    """The presses of a session, in memory, and on file if there is a folder for it.

    Parameters
    ----------
    folder : of the session, for one process at a time; None keeps only what became of each press.

    Attributes
    ----------
    runs, entries : so far, those of earlier runs among them.
    warnings : what a person should know of the file.

    Raises InputError on a file that is damaged or in use, OSError if it cannot be written.
    """

    def __init__(self, folder: Path | None = None) -> None:
        self.folder = folder
        self.path = folder / PRESSES if folder else None
        self.runs: list[Run] = []
        self.entries: list[Entry] = []
        self.warnings: list[str] = []
        self._file: int | None = None
        if self.path:
            self._file = _locked(self.path)
            try:
                self._read(self.path)
            except BaseException:
                self.close()
                raise

    def _read(self, path: Path) -> None:
        """Learn what is there; cut off a record that was not finished."""
        self.runs, self.entries, end = read_log(path)
        if end < path.stat().st_size:
            assert self._file is not None
            os.ftruncate(self._file, end)
            kept = f"presses kept: {len(self.entries)}"
            self.warnings.append(f"{path}: the last record is not whole and is left out; {kept}")

    def kept(self) -> Iterator[Kept]:
        """Read the presses on file again, with all columns, in order; nothing if there is no file."""
        if self.path is None:
            return
        number = 0
        for record, _ in _records(self.path):
            if "press" in record:
                number += 1
                yield _kept(self.path, record["press"], number)

    @property
    def used(self) -> int:
        """Count the presses that were used."""
        return sum(entry.used for entry in self.entries)

    def begin(self, run: Run) -> None:
        """Note that the session is begun, or gone on with."""
        if self._file is not None:
            self._write({"run": msgspec.to_builtins(run)})
        self.runs.append(run)

    def add(self, kept: Kept) -> None:
        """Keep a press."""
        if self._file is not None:
            self._write({"press": _packed(kept)})
        self.entries.append(kept.entry)

    def _write(self, record: dict[str, Any]) -> None:
        """Append a record and force it to the disk, whole or not at all."""
        assert self._file is not None
        body = json.dumps(record, allow_nan=False).encode()
        line = b'{"crc32": %d, "record": %b}\n' % (zlib.crc32(body), body)
        end = os.fstat(self._file).st_size
        try:
            while line:
                line = line[os.write(self._file, line) :]
            os.fsync(self._file)
        except OSError as error:
            os.ftruncate(self._file, end)
            raise OSError(error.errno, error.strerror, str(self.path)) from error

    def close(self) -> None:
        """Let go of the file; a second time does nothing."""
        if self._file is not None:
            os.close(self._file)
            self._file = None


def read_log(path: Path) -> tuple[list[Run], list[Entry], int]:
    """Read what became of each press, and where the last whole record ends. InputError on a damaged file."""
    runs: list[Run] = []
    entries: list[Entry] = []
    end = 0
    for record, after in _records(path):
        end = after
        if "run" in record:
            runs.append(_run(path, record["run"]))
        else:
            entries.append(_kept(path, record["press"], len(entries) + 1).entry)
    return runs, entries, end


def _packed(kept: Kept) -> dict[str, Any]:
    columns = pack_record(kept.press) if kept.press else None
    tuning = {} if kept.tuning == UNTUNED else {"tuning": asdict(kept.tuning)}
    found = {**msgspec.to_builtins(kept.entry), "surface": pack_record(kept.surface), "columns": columns}
    return found | tuning


def _locked(path: Path) -> int:
    """Open the file for this process alone; the system frees it however the process ends."""
    file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND | os.O_CLOEXEC, 0o666)
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(file)
        reason = "another process is at work on this session"
        raise InputError(path.parent, "session", reason, "wait for it, or name another folder") from None
    sync_folder(path.parent)
    return file


def _records(path: Path) -> Iterator[tuple[dict[str, Any], int]]:
    """Read records, each with the place where it ends; one that was cut short at the end is left out."""
    end = 0
    with path.open("rb") as stream:
        for number, text in enumerate(stream, 1):
            record = _record(text)
            if record is None:
                if stream.read(1):
                    raise _damaged(path, f"line {number}", "the record is damaged")
                return
            end += len(text)
            yield record, end


def _record(text: bytes) -> dict[str, Any] | None:
    """Read a line; None if it is not whole."""
    try:
        line = msgspec.json.decode(text, type=Line)
        if zlib.crc32(bytes(line.record)) != line.crc32 or not text.endswith(b"\n"):
            return None
        found: dict[str, Any] = msgspec.json.decode(line.record)
    except (msgspec.MsgspecError, UnicodeDecodeError):
        return None
    return found if len(found) == 1 and set(found) <= {"run", "press"} else None


def _run(path: Path, found: Any) -> Run:
    try:
        return msgspec.convert(found, Run)
    except msgspec.ValidationError as error:
        raise _damaged(path, "run", str(error)) from error


def _kept(path: Path, found: dict[str, Any], number: int) -> Kept:
    """Read a press that must bear this number."""
    try:
        surface, columns = unpack_surface(found.pop("surface")), found.pop("columns")
        tuning = Tuning(**found.pop("tuning", {}))
        entry = msgspec.convert(found, Entry)
        if entry.number != number:
            raise ValueError(f"bears the number {entry.number}")
        return Kept(entry, surface, unpack_press(columns) if columns else None, tuning)
    except (ValueError, TypeError, KeyError, AttributeError, zlib.error) as error:
        raise _damaged(path, f"press {number}", str(error)) from error


def _damaged(path: Path, place: str, reason: str) -> InputError:
    return InputError(path, place, reason, REMEDY)

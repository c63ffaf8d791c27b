"""Journals: append-only files of typed records, one per line, that survive a killed process.

Each line is ``{"crc32": …, "record": {key: body}}`` and ends with a newline. The checksum covers the bytes of
the record as they are in the line. Each line is forced to the disk before the next is written, so a killed
process leaves at most one torn line, the last. Readers skip it; `Journal.resume` removes it. A damaged line
before the last is an error.
"""

from __future__ import annotations

import json
import os
import zlib
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

import msgspec

from fdvv.errors import InputError
from fdvv.io.files import open_alone, sync_folder


@dataclass(frozen=True)
class JournalKind:
    """The records that a journal may hold.

    Attributes
    ----------
    types : type of the body by key, as `msgspec.convert` takes it; a record has exactly one of these keys.
    remedy : what to do about a damaged file.
    """

    types: Mapping[str, Any]
    remedy: str


class Line(msgspec.Struct, forbid_unknown_fields=True):
    """A line of the file."""

    crc32: int
    record: msgspec.Raw


class Journal:
    """A journal opened for appending by this process alone; created if it does not exist.

    Parameters
    ----------
    path : the file; its folder exists.
    busy : raised if another process has it open.

    Attributes
    ----------
    torn : whether `resume` removed an incomplete last line.

    Raises OSError if it cannot be written.
    """

    def __init__(self, path: Path, busy: InputError) -> None:
        self.path = path
        self.torn = False
        self._file: int | None = _locked(path, busy)

    @classmethod
    def resume(
        cls, path: Path, kind: JournalKind, busy: InputError, replay: Callable[[str, Any], None]
    ) -> Journal:
        """Open a journal to continue it: replay(key, body) every record, then remove a torn last line.

        Raises InputError that names the line on a damaged file, on a body of another type, and where replay
        raises a ValueError; closes the file then.
        """
        journal = cls(path, busy)
        try:
            end = 0
            for number, (key, body, after) in enumerate(read_bodies(path, kind), 1):
                try:
                    replay(key, body)
                except ValueError as error:
                    raise InputError(path, f"line {number}", str(error), kind.remedy) from error
                end = after
            journal.torn = journal.cut(end)
        except BaseException:
            journal.close()
            raise
        return journal

    def cut(self, end: int) -> bool:
        """Truncate the file to end bytes, where the last whole record ends; return whether it was longer."""
        assert self._file is not None
        if end >= os.fstat(self._file).st_size:
            return False
        os.ftruncate(self._file, end)
        return True

    def write(self, record: dict[str, Any]) -> None:
        """Append a record and force it to the disk, whole or not at all. Raises OSError."""
        assert self._file is not None
        line = line_of(record)
        end = os.fstat(self._file).st_size
        try:
            while line:
                line = line[os.write(self._file, line) :]
            os.fsync(self._file)
        except OSError as error:
            os.ftruncate(self._file, end)
            raise OSError(error.errno, error.strerror, str(self.path)) from error

    def close(self) -> None:
        """Close the file; closing twice is harmless."""
        if self._file is not None:
            os.close(self._file)
            self._file = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def line_of(record: dict[str, Any]) -> bytes:
    """Return a record as a line with its checksum. Raises ValueError for what cannot be read back."""
    body = json.dumps(record, allow_nan=False).encode()
    msgspec.json.decode(body)
    return b'{"crc32": %d, "record": %b}\n' % (zlib.crc32(body), body)


def read_records(path: Path, kind: JournalKind) -> Iterator[tuple[dict[str, Any], int]]:
    """Read records as they are, each with the byte where it ends; a torn last line is skipped.

    Raises InputError that names the line on a file that is damaged before its end, OSError.
    """
    end = 0
    with path.open("rb") as stream:
        for number, text in enumerate(stream, 1):
            record = _record(text, kind.types.keys())
            if record is None:
                if stream.read(1):
                    raise InputError(path, f"line {number}", "the record is damaged", kind.remedy)
                return
            end += len(text)
            yield record, end


def read_bodies(path: Path, kind: JournalKind) -> Iterator[tuple[str, Any, int]]:
    """Read records as key, body of its type and the byte where it ends. Raises like `read_records`."""
    for number, (record, end) in enumerate(read_records(path, kind), 1):
        ((key, found),) = record.items()
        try:
            body = msgspec.convert(found, kind.types[key])
        except ValueError as error:  # of msgspec too
            raise InputError(path, f"line {number}", str(error), kind.remedy) from error
        yield key, body, end


def _record(text: bytes, keys: Collection[str]) -> dict[str, Any] | None:
    try:
        line = msgspec.json.decode(text, type=Line)
        if zlib.crc32(bytes(line.record)) != line.crc32 or not text.endswith(b"\n"):
            return None
        found: Any = msgspec.json.decode(line.record)
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError):
        return None
    return found if isinstance(found, dict) and len(found) == 1 and set(found) <= set(keys) else None


def _locked(path: Path, busy: InputError) -> int:
    try:
        file = open_alone(path)
    except BlockingIOError:
        raise busy from None
    try:
        sync_folder(path.parent)
    except BaseException:
        os.close(file)
        raise
    return file

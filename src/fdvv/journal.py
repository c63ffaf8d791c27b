"""Journals: files of records that only grow and outlive the process that writes them.

Each line is ``{"crc32": …, "record": {…}}`` and ends with a newline; the checksum is that of the record's
bytes as they stand in the line. A line is on the disk before the next is asked for, so a killed process can
leave at most the last one cut short: that one is left out, and cut off when the file is opened to go on. A
damaged line before it is refused: nothing false is read back.
"""

from __future__ import annotations

import json
import os
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec

from fdvv.errors import InputError
from fdvv.files import open_alone, sync_folder


@dataclass(frozen=True)
class JournalKind:
    """What the lines of a kind of journal hold, and what to do about one that is damaged.

    Attributes
    ----------
    keys : a record is an object with exactly one of them.
    remedy : said after the reason.
    """

    keys: frozenset[str]
    remedy: str


class Line(msgspec.Struct, forbid_unknown_fields=True):
    """A line of the file."""

    crc32: int
    record: msgspec.Raw


class Journal:
    """A journal opened to append, by this process alone; the file is made if it is not there.

    Parameters
    ----------
    path : the file; its folder exists.
    busy : raised if another process is at work on it.

    Raises OSError if it cannot be written.
    """

    def __init__(self, path: Path, busy: InputError) -> None:
        self.path = path
        self._file: int | None = _locked(path, busy)

    def cut(self, end: int) -> bool:
        """Cut off what follows the byte where the last whole record ends; tell whether there was any."""
        assert self._file is not None
        if end >= os.fstat(self._file).st_size:
            return False
        os.ftruncate(self._file, end)
        return True

    def write(self, record: dict[str, Any]) -> None:
        """Append a record and force it to the disk, whole or not at all. OSError."""
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
        """Let go of the file; a second time does nothing."""
        if self._file is not None:
            os.close(self._file)
            self._file = None


def line_of(record: dict[str, Any]) -> bytes:
    """Write a record as a line with its checksum. ValueError if it holds what could not be read again."""
    body = json.dumps(record, allow_nan=False).encode()
    msgspec.json.decode(body)
    return b'{"crc32": %d, "record": %b}\n' % (zlib.crc32(body), body)


def read_records(path: Path, kind: JournalKind) -> Iterator[tuple[dict[str, Any], int]]:
    """Read records, each with the byte where it ends; one that was cut short at the end is left out.

    Raises InputError that names the line on a file that is damaged before its end, OSError.
    """
    end = 0
    with path.open("rb") as stream:
        for number, text in enumerate(stream, 1):
            record = _record(text, kind.keys)
            if record is None:
                if stream.read(1):
                    raise InputError(path, f"line {number}", "the record is damaged", kind.remedy)
                return
            end += len(text)
            yield record, end


def _record(text: bytes, keys: frozenset[str]) -> dict[str, Any] | None:
    """Read a line; None if it is not whole."""
    try:
        line = msgspec.json.decode(text, type=Line)
        if zlib.crc32(bytes(line.record)) != line.crc32 or not text.endswith(b"\n"):
            return None
        found: Any = msgspec.json.decode(line.record)
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError):
        return None
    return found if isinstance(found, dict) and len(found) == 1 and set(found) <= keys else None


def _locked(path: Path, busy: InputError) -> int:
    """Open the file for this process alone; the system frees it however the process ends."""
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

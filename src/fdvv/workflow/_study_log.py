"""Chained logs: journals whose lines hang together, so that a changed, cut, moved or added line is noticed.

A journal (see `fdvv.journal`). Its first record is ``{"begin": {"about": …, "salt": …, "marked": …}}``; every
other one is ``{"entry": {"record": …, "chain": …, "mark": …}}``. chain is SHA-256 of the chain before and the
record. mark, in a log with a key, is BLAKE2b of the chain under that key: who does not have the key cannot
write such a line.

Beside it lies the **head**, ``<name>.head``: how many lines there are, and the last chain. A marked log
writes it behind each line, so that a killed process leaves at most one line more, which its mark vouches for.
A log without marks writes it before too, with the chain that comes next: no other line may follow.
"""

from __future__ import annotations

import json
import secrets
import time
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any

from fdvv.errors import InputError
from fdvv.files import sync_folder, write_atomic
from fdvv.journal import Journal, line_of
from fdvv.workflow._study_chain import (
    REMEDY,
    Head,
    bytes_of,
    first_chain,
    head_path,
    mark_of,
    next_chain,
    read_chained,
)

AT_WORK = "another process is at work on it"
PATIENCE_s = 10.0
"""How long a study waits for another process that writes its log."""


class ChainedLog:
    """A chained log opened to append, by this process alone; a context manager.

    Parameters
    ----------
    path : of the journal, which was made by `create`.
    key : lines are marked with it; empty: they are not.

    Attributes
    ----------
    about : what the log belongs to. records : so far.

    InputError where the log was changed, or is at work elsewhere. OSError.
    """

    def __init__(self, path: Path, key: bytes = b"") -> None:
        self.path, self._key = Path(path), key
        if not self.path.exists():
            raise InputError(self.path, "whole file", "is missing", REMEDY)
        busy = InputError(self.path, "whole file", AT_WORK, "close the other one")
        self._journal = Journal(self.path, busy)
        try:
            found = read_chained(self.path, key)
            for problem in found.problems:
                raise InputError(self.path, "whole file", problem, REMEDY)
            self._journal.cut(found.end)
            self.about, self.records = found.about, list(found.records)
            self._head = Head(len(self.records) + 1, found.chain)
            if bytes_of(head_path(self.path)) != self._head.text.encode():
                self._keep_head(self._head)
        except BaseException:
            self._journal.close()
            raise

    @classmethod
    def create(cls, path: Path, about: Mapping[str, Any], key: bytes = b"") -> ChainedLog:
        """Begin a log where there is none. about : what it belongs to: no other can take its place."""
        path = Path(path)
        begin = {"begin": {"about": dict(about), "salt": secrets.token_hex(16), "marked": bool(key)}}
        head = Head(1, first_chain(begin))
        write_atomic(path, line_of(begin))
        write_atomic(head_path(path), head.text)
        sync_folder(path.parent)
        return cls(path, key)

    def write(self, record: Mapping[str, Any]) -> None:
        """Append a record and force it to the disk. OSError; ValueError where JSON cannot hold it."""
        plain = json.loads(json.dumps(dict(record), allow_nan=False))
        chain = next_chain(self._head.chain, plain)
        line = {"entry": {"record": plain, "chain": chain, "mark": mark_of(chain, self._key)}}
        if not self._key:
            self._keep_head(Head(self._head.lines, self._head.chain, chain))
            sync_folder(self.path.parent)
        self._journal.write(line)
        self._head = Head(self._head.lines + 1, chain)
        self._keep_head(self._head)
        self.records.append(plain)

    def _keep_head(self, head: Head) -> None:
        write_atomic(head_path(self.path), head.text)

    def close(self) -> None:
        """Let go of the file; a second time does nothing."""
        self._journal.close()

    def __enter__(self) -> ChainedLog:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def open_when_free(path: Path, patience_s: float = PATIENCE_s) -> ChainedLog:
    """Open a log without marks; wait while another process writes it. InputError, OSError."""
    until = time.monotonic() + patience_s
    while True:
        try:
            return ChainedLog(path)
        except InputError as error:
            if AT_WORK not in error.reason or time.monotonic() > until:
                raise
        time.sleep(0.02)

"""Hash-chained event logs: a changed, cut, moved or added line is detected.

An event log (see `fdvv.eventlog`). Its first record is ``{"begin": {"about": …, "salt": …, "marked": …}}``;
every other one is ``{"entry": {"record": …, "chain": …, "mark": …}}``. chain is SHA-256 of the chain before
and the record. mark, in a log with a key, is BLAKE2b of the chain under that key: such a line cannot be
written without the key.

Beside it lies the **head**, ``<name>.head``: the number of lines, and the last chain. A log with a key has
``"head": "marked"`` in its first record, unless an earlier fdvv began it: its head carries a mark too. It
writes the head after each line, so that a killed process leaves at most one line more, which is verified by
its mark. A log without marks writes it before each line too, with the chain that comes next: no other line
may follow.
"""

from __future__ import annotations

import hashlib
import hmac
import json
import secrets
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fdvv.errors import InputError
from fdvv.eventlog import Journal, JournalKind, line_of, read_records
from fdvv.io.files import sync_folder, write_atomic
from fdvv_people.study.files.log_head import MARKED, LogHead, head_of, head_path, mark_of

REMEDY = "take the study's folder from a backup; fdvv study verify lists all that is wrong"
KIND = JournalKind({"begin": Any, "entry": Any}, REMEDY)
LINE_BEGINS = b'{"crc32": '
AT_WORK = "another process is at work on it"
PATIENCE_s = 10.0
"""Wait for another process that writes the log."""


@dataclass(frozen=True)
class ChainRead:
    """Content of a log.

    Attributes
    ----------
    about : what its first line says it belongs to. records : that were written, in order.
    chains : of each line. end : the byte where it ends. problems : what is wrong with it, in words.
    head_marked : its head carries a mark.
    """

    about: Mapping[str, Any]
    records: tuple[dict[str, Any], ...]
    chains: tuple[str, ...]
    end: int
    problems: tuple[str, ...]
    head_marked: bool = False

    @property
    def chain(self) -> str:
        """The chain of the last line; empty if there is none."""
        return self.chains[-1] if self.chains else ""


def read_chained(path: Path, key: bytes = b"") -> ChainRead:
    """Read a log as far as it is whole, with a list of what is wrong with it.

    key : marks are verified with it; empty: they are not. A log that another process writes at the
    moment is read again until its head no longer changes.
    """
    # a writer changes the head with every line; that one does so during 20 readings in a row does not happen
    for _ in range(20):
        before = bytes_of(head_path(path))
        found = _read(path, key, before)
        if bytes_of(head_path(path)) == before:
            break
    return found


def _read(path: Path, key: bytes, head: bytes | None) -> ChainRead:
    data = bytes_of(path)
    if data is None:
        return ChainRead({}, (), (), 0, ("is missing",))
    reader = _Reader(key)
    try:
        for record, end in read_records(path, KIND):
            # what another process has written since is read next time
            if end > len(data) or not reader.take(record, data[reader.end : end], end):
                break
    except InputError as error:
        reader.problems.append(f"{error.place}: {error.reason}")
    return reader.compared_with(head, data[reader.end :])


class _Reader:
    """What was read so far."""

    def __init__(self, key: bytes) -> None:
        self.key, self.end, self.marked, self.head_marked = key, 0, False, False
        self.chains: list[str] = []
        self.about: dict[str, Any] = {}
        self.records: list[dict[str, Any]] = []
        self.problems: list[str] = []

    def take(self, line: dict[str, Any], text: bytes, end: int) -> bool:
        """Take a line; return False where it does not follow the one before."""
        number = len(self.chains) + 1
        try:
            whole = line_of(line) == text and (self._entry(line) if self.chains else self._begin(line))
        except (KeyError, TypeError, ValueError, AttributeError):
            whole = False
        if whole:
            self.end = end
        else:
            self.problems.append(f"line {number} was changed, moved or added")
        return whole

    def _begin(self, line: dict[str, Any]) -> bool:
        begin = line["begin"]
        if set(begin) - {"head"} != {"about", "salt", "marked"} or begin.get("head", MARKED) != MARKED:
            return False
        self.about, self.marked = dict(begin["about"]), begin["marked"]
        self.head_marked = "head" in begin
        self.chains.append(first_chain(line))
        return True

    def _entry(self, line: dict[str, Any]) -> bool:
        entry = line["entry"]
        chain = next_chain(self.chains[-1], entry["record"])
        known = not self.key or hmac.compare_digest(entry["mark"], mark_of(chain, self.key))
        fits = known and bool(entry["mark"]) == self.marked and set(entry) == {"record", "chain", "mark"}
        if entry["chain"] != chain or not fits:
            return False
        self.chains.append(chain)
        self.records.append(entry["record"])
        return True

    def compared_with(self, head_text: bytes | None, rest: bytes) -> ChainRead:
        """Compare what was read with the head. rest : of the file, which is no line."""
        head = head_of(head_text)
        if head is None or not (self.problems or head.known(self.key, self.head_marked)):
            self.problems.append("its head is missing or was changed")
        elif not self.problems:
            self.problems += self._beside(head, rest)
        read = (self.about, tuple(self.records), tuple(self.chains), self.end, tuple(self.problems))
        return ChainRead(*read, self.head_marked)

    def _beside(self, head: LogHead, rest: bytes) -> list[str]:
        lines, last = len(self.chains), self.chains[-1] if self.chains else ""
        one_more = lines == head.lines + 1 > 1 and self.chains[-2] == head.chain
        one_more = one_more and (self.marked or last == head.next)
        if not one_more and (lines, last) != (head.lines, head.chain):
            return [f"has {lines} lines, {head.lines} were written"]
        # a line may have been cut short when its process was killed; nothing else may follow
        torn = not one_more and (self.marked or bool(head.next)) and rest[:10] == LINE_BEGINS[: len(rest)]
        return ["something was added to its end"] if rest and not (torn and b"\n" not in rest) else []


def bytes_of(path: Path) -> bytes | None:
    try:
        return path.read_bytes()
    except FileNotFoundError:
        return None


def first_chain(begin: dict[str, Any]) -> str:
    return hashlib.sha256(json.dumps(begin).encode()).hexdigest()


def next_chain(chain: str, record: Any) -> str:
    return hashlib.sha256(f"{chain} {json.dumps(record)}".encode()).hexdigest()


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
            self._head_key = key if found.head_marked else b""
            self._head = self._marked(LogHead(len(self.records) + 1, found.chain))
            if bytes_of(head_path(self.path)) != self._head.text.encode():
                self._keep_head(self._head)
        except BaseException:
            self._journal.close()
            raise

    @classmethod
    def create(cls, path: Path, about: Mapping[str, Any], key: bytes = b"") -> ChainedLog:
        """Create a log where there is none. about : what it belongs to: no other can take its place."""
        path = Path(path)
        fields = {"about": dict(about), "salt": secrets.token_hex(16), "marked": bool(key)}
        begin = {"begin": fields | ({"head": MARKED} if key else {})}
        head = LogHead(1, first_chain(begin))
        head = head.marked(key) if key else head
        write_atomic(path, line_of(begin), private=True)
        write_atomic(head_path(path), head.text, private=True)
        sync_folder(path.parent)
        return cls(path, key)

    def write(self, record: Mapping[str, Any]) -> None:
        """Append a record and force it to the disk. OSError; ValueError where JSON cannot hold it."""
        plain = json.loads(json.dumps(dict(record), allow_nan=False))
        chain = next_chain(self._head.chain, plain)
        line = {"entry": {"record": plain, "chain": chain, "mark": mark_of(chain, self._key)}}
        if not self._key:
            self._keep_head(LogHead(self._head.lines, self._head.chain, chain))
            sync_folder(self.path.parent)
        self._journal.write(line)
        self._head = self._marked(LogHead(self._head.lines + 1, chain))
        self._keep_head(self._head)
        self.records.append(plain)

    def _marked(self, head: LogHead) -> LogHead:
        return head.marked(self._head_key) if self._head_key else head

    @property
    def head(self) -> LogHead:
        """Where the log ends now."""
        return self._head

    def _keep_head(self, head: LogHead) -> None:
        write_atomic(head_path(self.path), head.text, private=True)

    def close(self) -> None:
        """Close the file; idempotent."""
        self._journal.close()

    def __enter__(self) -> ChainedLog:
        return self

    def __exit__(self, *_: object) -> None:
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

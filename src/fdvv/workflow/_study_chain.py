"""Reading chained logs: as far as they are whole, and what is wrong with them.

See `fdvv.workflow._study_log` for what their files hold.
"""

from __future__ import annotations

import hashlib
import hmac
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec
from msgspec import Struct

from fdvv.errors import InputError
from fdvv.journal import JournalKind, line_of, read_records

REMEDY = "take the study's folder from a backup; fdvv study verify tells of all that is wrong"
KIND = JournalKind(frozenset({"begin", "entry"}), REMEDY)
HEAD_SUFFIX = ".head"
LINE_BEGINS = b'{"crc32": '


class Head(Struct, frozen=True, forbid_unknown_fields=True):
    """How far a log goes; next is announced before the line is written, else empty."""

    lines: int
    chain: str
    next: str = ""

    @property
    def text(self) -> str:
        """Get it as its file holds it."""
        return json.dumps({"lines": self.lines, "chain": self.chain, "next": self.next}) + "\n"


@dataclass(frozen=True)
class ChainRead:
    """What a log says.

    Attributes
    ----------
    about : what its first line says it belongs to. records : that were written, in order.
    chains : of each line. end : the byte where it ends. problems : what is wrong with it, in words.
    """

    about: Mapping[str, Any]
    records: tuple[dict[str, Any], ...]
    chains: tuple[str, ...]
    end: int
    problems: tuple[str, ...]

    @property
    def chain(self) -> str:
        """Get the chain of the last line; empty if there is none."""
        return self.chains[-1] if self.chains else ""


def head_path(path: Path) -> Path:
    """Give the file that tells how far a log goes."""
    return path.with_suffix(HEAD_SUFFIX)


def read_chained(path: Path, key: bytes = b"") -> ChainRead:
    """Read a log as far as it is whole, and tell what is wrong with it.

    key : marks are held against it; empty: they are not looked at. A log that another process writes at the
    moment is read again until its head stands still.
    """
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
    return reader.held_against(head, data[reader.end :])


class _Reader:
    """What was read so far."""

    def __init__(self, key: bytes) -> None:
        self.key, self.end, self.marked = key, 0, False
        self.chains: list[str] = []
        self.about: dict[str, Any] = {}
        self.records: list[dict[str, Any]] = []
        self.problems: list[str] = []

    def take(self, line: dict[str, Any], text: bytes, end: int) -> bool:
        """Take a line; False where it does not hang on the one before."""
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
        if set(begin) != {"about", "salt", "marked"}:
            return False
        self.about, self.marked = dict(begin["about"]), begin["marked"]
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

    def held_against(self, head_text: bytes | None, rest: bytes) -> ChainRead:
        """Hold what was read against the head. rest : of the file, which is no line."""
        head = _head(head_text)
        if head is None:
            self.problems.append("its head is missing or was changed")
        elif not self.problems:
            self.problems += self._beside(head, rest)
        return ChainRead(self.about, tuple(self.records), tuple(self.chains), self.end, tuple(self.problems))

    def _beside(self, head: Head, rest: bytes) -> list[str]:
        lines, last = len(self.chains), self.chains[-1] if self.chains else ""
        one_more = lines == head.lines + 1 > 1 and self.chains[-2] == head.chain
        one_more = one_more and (self.marked or last == head.next)
        if not one_more and (lines, last) != (head.lines, head.chain):
            return [f"has {lines} lines, {head.lines} were written"]
        # a line may have been cut short when its process was killed; nothing else may follow
        torn = not one_more and (self.marked or bool(head.next)) and rest[:10] == LINE_BEGINS[: len(rest)]
        return ["something was added to its end"] if rest and not (torn and b"\n" not in rest) else []


def _head(text: bytes | None) -> Head | None:
    try:
        head = msgspec.json.decode(text or b"", type=Head)
    except (msgspec.MsgspecError, UnicodeDecodeError):
        return None
    return head if head.text.encode() == text else None


def bytes_of(path: Path) -> bytes | None:
    try:
        return path.read_bytes()
    except FileNotFoundError:
        return None


def first_chain(begin: dict[str, Any]) -> str:
    return hashlib.sha256(json.dumps(begin).encode()).hexdigest()


def next_chain(chain: str, record: Any) -> str:
    return hashlib.sha256(f"{chain} {json.dumps(record)}".encode()).hexdigest()


def mark_of(chain: str, key: bytes) -> str:
    return hashlib.blake2b(chain.encode(), key=key, digest_size=32).hexdigest() if key else ""

"""The head of a chained log: how long it is and where it ends, in a file beside it."""

from __future__ import annotations

import hashlib
import json
import zlib
from pathlib import Path

import msgspec
from msgspec import Struct

HEAD_SUFFIX = ".head"
MARKED = "marked"
"""What the first record of a log says of its heads where they carry a mark."""


class LogHead(Struct, frozen=True, forbid_unknown_fields=True):
    """The end of a log.

    Attributes
    ----------
    next : is announced before the line is written, else empty. mark : of lines and chain under the log's key;
        empty without one. crc32 : of the mark.
    """

    lines: int
    chain: str
    next: str = ""
    mark: str = ""
    crc32: int = 0

    @property
    def text(self) -> str:
        fields = {"lines": self.lines, "chain": self.chain, "next": self.next}
        return json.dumps(fields | ({"mark": self.mark, "crc32": self.crc32} if self.mark else {})) + "\n"

    def marked(self, key: bytes) -> LogHead:
        """Return the head under the mark of a key."""
        mark = mark_of(f"head {self.lines} {self.chain}", key)
        return LogHead(self.lines, self.chain, self.next, mark, zlib.crc32(mark.encode()))

    def known(self, key: bytes, marked: bool) -> bool:
        """Whether it is of a log with that key, empty: unknown. marked : the log's heads have marks."""
        if not marked:
            return not self.mark
        mark = self.marked(key).mark if key else self.mark
        return bool(self.mark) and mark == self.mark and zlib.crc32(mark.encode()) == self.crc32


def head_path(path: Path) -> Path:
    return path.with_suffix(HEAD_SUFFIX)


def head_of(text: bytes | None) -> LogHead | None:
    try:
        head = msgspec.json.decode(text or b"", type=LogHead)
    except (msgspec.MsgspecError, UnicodeDecodeError):
        return None
    return head if head.text.encode() == text else None


def mark_of(chain: str, key: bytes) -> str:
    return hashlib.blake2b(chain.encode(), key=key, digest_size=32).hexdigest() if key else ""

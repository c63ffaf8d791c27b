"""The shelf's cache: what was read from each file, so that a restart reads only what changed.

Lines of JSON that are only added to; a later line of a place stands for an earlier one. A line that cannot
be read is passed over, and its file is read again. Nothing in it is precious.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import msgspec

from fdvv.files import write_atomic
from fdvv.workflow._shelf_row import ShelfRow

CACHE_version = 1
"""Of what a row holds and how it is found; another version's cache is not used."""


class CacheLine(msgspec.Struct, frozen=True):
    """What became of one file: its row, or the reason why it has none, or neither if it is no button."""

    place: str
    stamp: str
    row: ShelfRow | None = None
    reason: str = ""


class _Head(msgspec.Struct, frozen=True):
    format: str
    version: int


_HEAD = msgspec.json.encode(_Head("fdvv-shelf-cache", CACHE_version)) + b"\n"
_LINES = msgspec.json.Decoder(CacheLine)


def read_cache(path: Path) -> dict[str, CacheLine]:
    """Read a cache, by place; empty if there is none of this version."""
    try:
        head, *lines = path.read_bytes().split(b"\n")
    except OSError:
        return {}
    found: dict[str, CacheLine] = {}
    if head + b"\n" != _HEAD:
        return found
    for text in lines:
        try:
            line = _LINES.decode(text)
        except (msgspec.MsgspecError, UnicodeDecodeError):
            continue
        found[line.place] = line
    return found


def add_to_cache(path: Path, lines: Iterable[CacheLine]) -> None:
    """Add lines to a cache that write_cache made. OSError if it cannot be written."""
    with path.open("ab") as stream:
        stream.write(b"".join(msgspec.json.encode(line) + b"\n" for line in lines))


def write_cache(path: Path, lines: Iterable[CacheLine]) -> None:
    """Write a cache anew, whole or not at all. OSError if it cannot be written."""
    write_atomic(path, _HEAD + b"".join(msgspec.json.encode(line) + b"\n" for line in lines))

"""What the catalogue knows of a button without opening it, and the cache of what was read from each file.

The cache saves reading after a restart. It holds lines of JSON and only grows; a later line of a place
replaces an earlier one. A line that cannot be read is skipped, and its file is read again.
"""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum
from pathlib import Path

import msgspec

from fdvv.button.kind import ButtonType
from fdvv.button.like import Sketch
from fdvv.io.files import write_atomic


class Origin(StrEnum):
    """Where a button of the catalogue comes from."""

    BUILTIN = "builtin"
    OWN = "own"
    MEASURED = "measured"


class ButtonRow(msgspec.Struct, frozen=True, kw_only=True):
    """One button of the catalogue. A figure that is None was not detected or is unknown; ``why`` says which.

    Attributes
    ----------
    id : ``builtin:NAME``, ``own:NAME`` or ``measured:`` and 16 hexadecimal digits.
    collection : the folder a measured file lies in, below the source and with it.
    stated : words of the maker or the measurer ("silent", "linear" ...) in name, folder or a table beside the
        file, and the type of a known make; not measured.
    kind, kind_reason : decided from the force alone; what is stated, how often such a curve is right, and by
        which fact.
    peak_cN, peak_mm, valley_cN, valley_mm, drop_cN, snap_ratio : of the bump of the press.
    release_drop_cN : of the bump of the release.
    actuation_mm, actuation_cN, reset_mm : of the electrical contact.
    preload_cN, bottom_out_cN, travel_mm, pre_slope_cN_mm, post_slope_cN_mm, work_mJ, loss_mJ : as
        fdvv.model.landmarks.Landmarks; loss is work put in and not given back.
    speeds_mm_s : the known speeds of the presses, rising; empty if the source tells none.
    cycles, used : how many presses the source holds and how many the mean is of; None for a model.
    date : ISO day on which the file was last changed; None for a built-in.
    source, licence : as the button's file states them.
    simulated : whether the numbers come from the twin.
    why : reasons of what is None, each beginning with its subject and a colon.
    """

    id: str
    name: str
    origin: Origin
    collection: str
    stated: tuple[str, ...]
    kind: ButtonType
    kind_reason: str
    peak_cN: float | None
    peak_mm: float | None
    valley_cN: float | None
    valley_mm: float | None
    drop_cN: float | None
    snap_ratio: float | None
    release_drop_cN: float | None
    actuation_mm: float | None
    actuation_cN: float | None
    reset_mm: float | None
    preload_cN: float | None
    bottom_out_cN: float | None
    travel_mm: float
    pre_slope_cN_mm: float | None
    post_slope_cN_mm: float | None
    work_mJ: float | None
    loss_mJ: float | None
    speeds_mm_s: tuple[float, ...]
    cycles: int | None
    used: int | None
    date: str | None
    source: str
    licence: str
    simulated: bool
    why: tuple[str, ...]
    sketch: Sketch


NUMBERS = (
    *("peak_cN", "peak_mm", "valley_cN", "valley_mm", "drop_cN", "snap_ratio", "release_drop_cN"),
    *("actuation_mm", "actuation_cN", "reset_mm", "preload_cN", "bottom_out_cN", "travel_mm"),
    *("pre_slope_cN_mm", "post_slope_cN_mm", "work_mJ", "loss_mJ"),
)
"""Figures of a row that can be searched by range and sorted by."""


CACHE_version = 2
"""Of what a row holds and how it is found; another version's cache is not used."""


class CacheLine(msgspec.Struct, frozen=True):
    """What became of one file: its row, or the reason why it has none, or neither if it is no button."""

    place: str
    stamp: str
    row: ButtonRow | None = None
    reason: str = ""


_HEAD = msgspec.json.encode({"format": "fdvv-shelf-cache", "version": CACHE_version}) + b"\n"
_LINES = msgspec.json.Decoder(CacheLine)


def read_cache(path: Path) -> dict[str, CacheLine]:
    """Read a cache, by place; empty if there is none of this version."""
    try:
        head, *lines = path.read_bytes().split(b"\n")
    except OSError:
        return {}
    by_place: dict[str, CacheLine] = {}
    if head + b"\n" != _HEAD:
        return by_place
    for text in lines:
        try:
            line = _LINES.decode(text)
        except (msgspec.MsgspecError, UnicodeDecodeError):
            continue
        by_place[line.place] = line
    return by_place


def add_to_cache(path: Path, lines: Iterable[CacheLine]) -> None:
    """Add lines to a cache that write_cache made. OSError if it cannot be written."""
    with path.open("ab") as stream:
        stream.write(_encode(lines))


def write_cache(path: Path, lines: Iterable[CacheLine]) -> None:
    """Write a cache anew, whole or not at all. OSError if it cannot be written."""
    write_atomic(path, _HEAD + _encode(lines))


def _encode(lines: Iterable[CacheLine]) -> bytes:
    return b"".join(msgspec.json.encode(line) + b"\n" for line in lines)

"""Haptic files as JSON: written as people read it, read into typed records within limits."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TypeVar

import msgspec

from fdvv.errors import InputError
from fdvv.io.files import read_limited

LARGEST_bytes = 4_000_000
"""A vibration of a button takes a few kB; hours of a film's take more, and are no button."""
MOST_POINTS = 20_000
Record = TypeVar("Record")


def json_bytes(record: object) -> bytes:
    """Write JSON as people read it, in UTF-8; a NaN, which JSON has not, is a ValueError."""
    return (json.dumps(record, indent=2, ensure_ascii=False, allow_nan=False) + "\n").encode()


def read_json(source: Path | str | bytes, record: type[Record], name: str, remedy: str) -> Record:
    """Read JSON into a typed record; fields it does not name are ignored, as the formats ask.

    source : a path, or the file's bytes; name : of the source in messages. Raises InputError.
    """
    data = source if isinstance(source, bytes) else read_limited(source, LARGEST_bytes, remedy)
    if len(data) > LARGEST_bytes:
        raise InputError(name, "whole file", f"larger than {LARGEST_bytes // 1_000_000} MB", remedy)
    try:
        return msgspec.json.decode(data.removeprefix(b"\xef\xbb\xbf"), type=record)
    except msgspec.ValidationError as error:
        reason, _, place = str(error).partition(" - at ")
        raise InputError(name, place.strip("`") or "$", reason, remedy) from error
    except (msgspec.DecodeError, UnicodeError, RecursionError) as error:
        raise InputError(name, "whole file", f"not valid JSON ({error})", remedy) from error


def check_points(name: str, place: str, count: int, remedy: str) -> None:
    if count > MOST_POINTS:
        raise InputError(name, place, f"{count} points, at most {MOST_POINTS} are read", remedy)

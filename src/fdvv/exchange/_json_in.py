"""Reading JSON of other programs: small, strictly typed, told in one line where it is wrong."""

from __future__ import annotations

from pathlib import Path
from typing import TypeVar

import msgspec

from fdvv.errors import InputError
from fdvv.files import read_limited

LARGEST_bytes = 4_000_000
"""A vibration of a button takes a few kB; hours of a film's take more, and are no button."""
MOST_POINTS = 20_000
Record = TypeVar("Record")


def read_json(source: Path | str | bytes, record: type[Record], name: str, what: str) -> Record:
    """Read JSON into a typed record; fields it does not name are ignored, as the formats ask.

    source : a path, or the file's bytes; name : of the source in messages; what : the format with its
        article. Raises InputError.
    """
    remedy = f"give {what}"
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


def refuse(name: str, place: str, reason: str, what: str) -> InputError:
    """Make the error that tells what is wrong with a value of the right type."""
    return InputError(name, place, reason, f"give {what}")


def check_points(name: str, place: str, count: int, what: str) -> None:
    """Refuse a list that is too long for a button's vibration."""
    if count > MOST_POINTS:
        raise refuse(name, place, f"{count} points, at most {MOST_POINTS} are read", what)

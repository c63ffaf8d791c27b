"""Names of a person's buttons, which are names of files too."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable

from fdvv.errors import InputError

LONGEST = 60
"""Characters; with a suffix and in any script it stays below the 255 bytes of file systems."""

_RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", re.IGNORECASE)
_SAFE = re.compile(r"\w[\w .+()-]*", re.UNICODE)


def check_name(name: str, there: Iterable[str] = ()) -> str:
    """Give a name that every file system takes, and that is not there yet in any case.

    Raises InputError on another, with the reason.
    """
    tidy = unicodedata.normalize("NFC", name)
    reason = _wrong(tidy)
    if reason:
        raise InputError("studio", "name", f"{name[:LONGEST]!r} {reason}", "choose another name")
    for other in there:
        if other.casefold() == tidy.casefold():
            raise InputError("studio", "name", f"there is a button {other!r} already", "choose another name")
    return tidy


def _wrong(name: str) -> str:
    if not name:
        return "is empty"
    if len(name) > LONGEST:
        return f"is longer than {LONGEST} characters"
    if not _SAFE.fullmatch(name) or name[0] == "_":
        return "must begin with a letter or digit and have only letters, digits, spaces and . + - _ ( )"
    if name[-1] in " .":
        return "must not end with a space or a point"
    return "is reserved by an operating system" if _RESERVED.fullmatch(name) else ""


def free_name(wanted: str, there: Iterable[str]) -> str:
    """Give a safe name near the wanted one that is not there yet: "name", "name 2", "name 3"."""
    taken = {name.casefold() for name in there}
    base = re.sub(r"[^\w .+()-]+", "-", unicodedata.normalize("NFC", wanted)).strip(" ._-+()")
    base = base[: LONGEST - 6].rstrip(" .") or "button"
    if _wrong(base):
        base = f"button {base}"[: LONGEST - 6]
    number, name = 1, base
    while name.casefold() in taken:
        number += 1
        name = f"{base} {number}"
    return name

"""List the files of a folder that may hold force curves."""

from __future__ import annotations

from pathlib import Path

from fdvv.capture._pairs import stroke_of
from fdvv.errors import InputError
from fdvv.model import Stroke

SUFFIXES = (".csv", ".ods", ".json", ".txt")
NOT_DATA = ("readme", "license", "licence", "copying", "changelog", "contributing", "notice")


def find_force_files(folder: str | Path) -> list[Path]:
    """List candidates under a folder, in the order of their paths; a stroke pair is listed once.

    Only suffixes and names are looked at (.csv .ods .json .txt, no hidden files, readmes or licences);
    whether a file can be read shows when it is read. Raises InputError if there is no such folder.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise InputError(folder, "path", "there is no such folder", "give a folder of measurements")
    found = [path for path in folder.rglob("*") if _is_candidate(path.relative_to(folder)) and path.is_file()]
    known = set(found)
    return sorted(path for path in found if not _second_half(path, known))


def _is_candidate(inside: Path) -> bool:
    hidden = any(part.startswith(".") for part in inside.parts)
    return not hidden and is_force_file(inside.name)


def is_force_file(name: str) -> bool:
    """Tell from a file's name alone whether it may hold force curves."""
    lower = name.lower()
    return lower.endswith(SUFFIXES) and not lower.startswith(NOT_DATA)


def _second_half(path: Path, known: set[Path]) -> bool:
    named = stroke_of(path)
    return named is not None and named[0] is Stroke.RELEASE and named[1] in known

"""The files that the shelf's buttons lie in, each with the id it is known by."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from fdvv.capture import companion, is_force_file
from fdvv.model import SUFFIX
from fdvv.workflow._shelf_row import Origin


@dataclass(frozen=True)
class ShelfFile:
    """A file that may hold a button.

    Attributes
    ----------
    id : ``own:NAME``, or ``measured:`` and 16 hexadecimal digits of a hash of the place: the same after a
        restart and wherever the folder lies.
    path : where it is; pair is where the release lies if that is another file.
    place : its path below the folder, with the folder's name before it.
    stamp : size and time of change of it and of the release's file.
    """

    id: str
    origin: Origin
    path: Path
    place: str
    stamp: str
    pair: Path | None = None

    @property
    def collection(self) -> str:
        """Get the folder of the file, below the source and with it; empty for the person's own."""
        return self.place.rpartition("/")[0] if self.origin is Origin.MEASURED else ""

    def again(self) -> ShelfFile | None:
        """Give the file as it is now; None if it is gone."""
        try:
            return replace(self, stamp="".join(stamp_of(p.stat()) for p in (self.path, self.pair) if p))
        except OSError:
            return None


def own_files(folder: Path) -> Iterator[ShelfFile]:
    """List the models of a folder, by name; none if there is no such folder."""
    for inside, entry in sorted(_walk(folder, "")):
        if entry.name.endswith(SUFFIX) and inside == entry.name:
            name = inside.removesuffix(SUFFIX)
            button_id = f"own:{name.encode(errors='replace').decode()}"
            yield ShelfFile(button_id, Origin.OWN, Path(entry.path), button_id, stamp_of(entry.stat()))


def source_files(sources: Sequence[Path]) -> Iterator[ShelfFile]:
    """List the files of the folders that may hold a button, in the order of their paths.

    A source that lies within another is listed once, with the other; a folder that is not there is empty.
    """
    for label, folder in _labelled(sources):
        found = dict(sorted(_walk(folder, "")))
        for inside, entry in found.items():
            path = Path(entry.path)
            other = companion(path)
            beside = found.get(inside.removesuffix(entry.name) + other.name) if other else None
            if other and beside and other.name < path.name:
                continue  # the press is listed, which is first in the alphabet for every way of naming
            place = os.fsencode(f"{label}/{inside}")
            yield ShelfFile(
                id=f"measured:{hashlib.sha256(place).hexdigest()[:16]}",
                origin=Origin.MEASURED,
                path=path,
                place=place.decode(errors="replace"),
                stamp=stamp_of(entry.stat()) + (stamp_of(beside.stat()) if beside else ""),
                pair=Path(beside.path) if beside else None,
            )


def _labelled(sources: Sequence[Path]) -> Iterator[tuple[str, Path]]:
    """Name every source after its folder; the second of a name gets a number."""
    folders = list(dict.fromkeys(Path(source).resolve() for source in sources))
    seen: dict[str, int] = {}
    for folder in folders:
        if any(other in folder.parents for other in folders):
            continue
        name = folder.name or "files"
        seen[name] = seen.get(name, 0) + 1
        yield (name if seen[name] == 1 else f"{name} ({seen[name]})"), folder


def _walk(folder: Path | str, inside: str) -> Iterator[tuple[str, os.DirEntry[str]]]:
    """Walk a folder; links to folders are not followed, what cannot be read is passed over."""
    try:
        entries = list(os.scandir(folder))
    except OSError:
        return
    for entry in entries:
        if entry.name.startswith("."):
            continue
        if entry.is_dir(follow_symlinks=False):
            yield from _walk(entry.path, f"{inside}{entry.name}/")
        elif entry.is_file() and (is_force_file(entry.name) or entry.name.endswith(SUFFIX)):
            yield inside + entry.name, entry


def stamp_of(told: os.stat_result) -> str:
    """Write size and time of change as text."""
    return f"{told.st_size}.{told.st_mtime_ns};"

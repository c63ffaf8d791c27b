"""The catalogue: built-in buttons, own models and measured files by id. No id is ever joined to a path."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

from fdvv.button.fit import fit_file
from fdvv.errors import InputError
from fdvv.formats.force.read import companion, is_force_file
from fdvv.io.documents import MODEL, own_kind
from fdvv.model.file import MODEL_SUFFIX, builtin_names, load_builtin, load_model
from fdvv.model.model import FDVVModel
from fdvv_studio.library.figures import read_file
from fdvv_studio.library.row import Origin


@dataclass(frozen=True)
class ButtonFile:
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
        """Return the folder of the file, below the source and with it; empty for the person's own."""
        return self.place.rpartition("/")[0] if self.origin is Origin.MEASURED else ""

    def again(self) -> ButtonFile | None:
        """Return the file as it is now; None if it is gone."""
        try:
            return replace(self, stamp="".join(stamp_of(p.stat()) for p in (self.path, self.pair) if p))
        except OSError:
            return None


def own_files(folder: Path) -> Iterator[ButtonFile]:
    """List the models of a folder, by name; none if there is no such folder."""
    for inside, entry in sorted(_walk(folder, "")):
        if entry.name.endswith(MODEL_SUFFIX) and inside == entry.name:
            name = inside.removesuffix(MODEL_SUFFIX)
            button_id = f"own:{name.encode(errors='replace').decode()}"
            # one that is deleted or renamed while the folder is listed is passed over
            if stamp := _stamp(entry):
                yield ButtonFile(button_id, Origin.OWN, Path(entry.path), button_id, stamp)


def source_files(sources: Sequence[Path]) -> Iterator[ButtonFile]:
    """List the files of the folders that may hold a button, in the order of their paths.

    A source that lies within another is listed once, with the other; a folder that is not there is empty.
    """
    for label, folder in _label_sources(sources):
        entries = dict(sorted(_walk(folder, "")))
        for inside, entry in entries.items():
            path = Path(entry.path)
            other = companion(path)
            beside = entries.get(inside.removesuffix(entry.name) + other.name) if other else None
            if other and beside and other.name < path.name:
                continue  # the press is listed, which is first in the alphabet for every way of naming
            place = os.fsencode(f"{label}/{inside}")
            if not (stamp := _stamp(entry)):
                continue
            yield ButtonFile(
                id=f"measured:{hashlib.sha256(place).hexdigest()[:16]}",
                origin=Origin.MEASURED,
                path=path,
                place=place.decode(errors="replace"),
                stamp=stamp + (_stamp(beside) if beside else ""),
                pair=Path(beside.path) if beside else None,
            )


def _label_sources(sources: Sequence[Path]) -> Iterator[tuple[str, Path]]:
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
        elif entry.is_file() and (is_force_file(entry.name) or entry.name.endswith(MODEL_SUFFIX)):
            yield inside + entry.name, entry


def _stamp(entry: os.DirEntry[str]) -> str:
    """Return the stamp of a listed file; empty if it is gone."""
    try:
        return stamp_of(entry.stat())
    except FileNotFoundError:
        return ""


def stamp_of(status: os.stat_result) -> str:
    """Write size and time of change as text."""
    return f"{status.st_size}.{status.st_mtime_ns};"


KEPT = 64
"""Opened buttons kept in memory; a model takes some 20 kB."""

BUTTONS = "buttons"
"""The folder of a project that holds the person's own models."""


class Catalog:
    """The built-in buttons, the models of a project and the measured files of folders.

    Parameters
    ----------
    project : the person's own models lie in its folder ``buttons``; nothing is written.
    sources : folders of measured files; one that is not there is empty.

    Any thread may call any method.
    """

    def __init__(self, project: Path, sources: Sequence[Path] = ()) -> None:
        self.project, self.sources = Path(project), tuple(Path(s) for s in sources)
        self._files: dict[str, ButtonFile] = {}

    def scan(self) -> tuple[ButtonFile, ...]:
        """List the files that may hold a button as they are now: the person's own, then the sources'."""
        files = (*own_files(self.project / BUTTONS), *source_files(self.sources))
        self._files = {file.id: file for file in files}
        return files

    def model(self, button_id: str) -> FDVVModel:
        """Open a button; a measured one is fitted. Raises InputError."""
        return self._open(button_id, fitted=True)

    def curves(self, button_id: str) -> FDVVModel:
        """Open a button as its row is read: a measured one as polylines of its means. Raises InputError."""
        return self._open(button_id, fitted=False)

    def _open(self, button_id: str, fitted: bool) -> FDVVModel:
        origin, _, name = button_id.partition(":")
        if origin == "builtin" and name in builtin_names():
            return load_builtin(name)
        file = self._file(button_id)
        return _read_model(file.path, file.stamp, fitted)

    def _file(self, button_id: str) -> ButtonFile:
        """Find the file of a button as it is now, also one that came after the last scan."""
        file = self._files.get(button_id)
        current = file and file.again()
        if current is None:
            self.scan()
            current = self._files.get(button_id)
        if current is None:
            reason = f"no button is called {button_id!r:.80}"
            raise InputError("library", "button", reason, "choose one of the library")
        return current


@lru_cache(maxsize=KEPT)
def _read_model(path: Path, _stamp: str, fitted: bool) -> FDVVModel:
    """Read a file as long as its stamp is another than when it was read last."""
    if path.name.endswith(MODEL_SUFFIX) or own_kind(path) == MODEL:
        return load_model(path)
    return fit_file(path).model if fitted else read_file(path).model

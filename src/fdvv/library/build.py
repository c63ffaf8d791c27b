"""Build a library of a folder of measured files, or bring one up to date."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import msgspec

from fdvv import __version__
from fdvv.documents import Kind, pretty, read_document
from fdvv.errors import InputError
from fdvv.files import read_limited, write_atomic
from fdvv.journal import Journal
from fdvv.workflow._executor import Executor
from fdvv.workflow._isolated import DEADLY, run_isolated
from fdvv.workflow._library_columns import FORMAT, VERSION, library_schema, table_of
from fdvv.workflow._library_record import LibraryRecord
from fdvv.workflow._library_work import LibraryWork
from fdvv.workflow._parquet import need_parquet
from fdvv.workflow._part_store import PartStore
from fdvv.workflow._shelf_files import ShelfFile, source_files

MANIFEST, BUTTONS, LOCK = "library.json", "buttons.parquet", ".lock"
REMEDY = "name the folder of a library, or build one with fdvv library build"
KIND = Kind(FORMAT, VERSION, "a library", REMEDY)
LARGEST_bytes = 1_000_000
FILES = 64
"""Of a chunk: half a second of work, and what a killed process has to do again."""

Progress = Callable[[int, int], None]
"""Is told how many files are known, and of how many."""


class LibraryManifest(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """What a library's folder says of itself.

    Attributes
    ----------
    sources : names of the folders it is of. finished : whether the file of buttons holds all of them.
    files, buttons, refused : how many; 0 as long as it is not finished. made_with : the program's version.
    """

    format: Literal["fdvv-library"] = "fdvv-library"
    version: Literal[1] = 1
    sources: tuple[str, ...]
    finished: bool = False
    files: int = 0
    buttons: int = 0
    refused: int = 0
    made_with: str = __version__


@dataclass(frozen=True)
class LibraryBuilt:
    """What a build did.

    Attributes
    ----------
    files, buttons, refused : in the library now.
    read, kept, gone : files that were read, that had not changed, and that are no longer there.
    """

    folder: Path
    files: int
    buttons: int
    refused: int
    read: int
    kept: int
    gone: int

    def to_dict(self) -> dict[str, Any]:
        """Give the report of ``fdvv library build --json``."""
        counts = ("files", "buttons", "refused", "read", "kept", "gone")
        return {"library": str(self.folder), **{name: getattr(self, name) for name in counts}}


def build_library(
    sources: Sequence[Path],
    folder: Path,
    executor: Executor,
    progress: Progress = lambda _done, _whole: None,
    work: LibraryWork | None = None,
) -> LibraryBuilt:
    """Read every measured file below folders into a library: what did not change is not read again.

    folder : new, empty, or a library of the same folders, whole or begun. Whatever ends a build, the same
    call goes on. work : how files are read.
    Raises InputError on a folder of other things, of another library or at work elsewhere, and if there is
    nothing to read; BuildError without the extra `sweep`; WorkerError; OSError.
    """
    need_parquet()
    folder, sources = Path(folder), [Path(source).resolve() for source in sources]
    files = _listed(sources)
    labels = tuple(dict.fromkeys(file.place.partition("/")[0] for file in files))
    _begin(folder, labels)
    lock = Journal(folder / LOCK, InputError(folder, "folder", "another process builds it", "wait for it"))
    try:
        return _build(folder, labels, files, executor, progress, work or LibraryWork(tuple(sources)))
    finally:
        lock.close()


def read_manifest(folder: Path) -> LibraryManifest:
    """Read what a library's folder says of itself. InputError if it is none."""
    if not (folder / MANIFEST).is_file():
        raise InputError(folder, "library", f"there is no {MANIFEST} in it", REMEDY)
    text = read_limited(folder / MANIFEST, LARGEST_bytes, REMEDY)
    return read_document(
        text,
        folder / MANIFEST,
        KIND,
        lambda data: msgspec.json.decode(data, type=LibraryManifest),
        lambda _: None,
    )


def _listed(sources: Sequence[Path]) -> list[ShelfFile]:
    for source in sources:
        if not source.is_dir():
            raise InputError(source, "folder", "there is no such folder", "give a folder of measurements")
    files = list(source_files(sources))
    if not files:
        told = ", ".join(map(str, sources))
        reason = "no .csv, .ods, .json or .txt file of measurements in it"
        raise InputError(told, "folder", reason, "name another folder")
    return files


def _begin(folder: Path, labels: tuple[str, ...]) -> None:
    """Make a library's folder, or find one of the same sources."""
    if not (folder / MANIFEST).exists():
        if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
            raise InputError(folder, "folder", "is not empty and no library", "name a new one, or a library")
        _write_manifest(folder, LibraryManifest(sources=labels))
        return
    lost = [label for label in read_manifest(folder).sources if label not in labels]
    if lost:
        reason = f"holds a library of {', '.join(lost)}, which would be dropped"
        raise InputError(folder, "folder", reason, "name that folder too, or a new library")


def _build(
    folder: Path,
    labels: tuple[str, ...],
    files: Sequence[ShelfFile],
    executor: Executor,
    progress: Progress,
    work: LibraryWork,
) -> LibraryBuilt:
    store = PartStore(folder / BUTTONS, library_schema(), ("id", "stamp"))
    order = [(file.id, file.stamp) for file in files]
    missing = [file for file, key in zip(files, order, strict=True) if key not in store]
    kept, known = len(files) - len(missing), len(store)
    done = kept
    progress(done, len(files))
    chunks = [tuple(missing[i : i + FILES]) for i in range(0, len(missing), FILES)]
    for records in run_isolated(executor, work, chunks, _deadly):
        store.add(table_of(records))
        done += len(records)
        progress(done, len(files))
    store.finish(order)
    return _finished(folder, labels, store, (len(missing), kept, known - kept))


def _finished(
    folder: Path, labels: tuple[str, ...], store: PartStore, told: tuple[int, int, int]
) -> LibraryBuilt:
    states = [state for table in store.tables(["state"]) for state in table.column("state").to_pylist()]
    counts = len(states), states.count("button"), states.count("refused")
    manifest = LibraryManifest(
        sources=labels, finished=True, files=counts[0], buttons=counts[1], refused=counts[2]
    )
    if read_manifest(folder) != manifest:
        _write_manifest(folder, manifest)
    return LibraryBuilt(folder, *counts, *told)


def _deadly(file: ShelfFile) -> LibraryRecord:
    return LibraryRecord(file.id, file.place, file.stamp, reason=f"whole file: {DEADLY}")


def _write_manifest(folder: Path, manifest: LibraryManifest) -> None:
    write_atomic(folder / MANIFEST, pretty(msgspec.to_builtins(manifest)) + "\n")

"""Build a library of a folder of measured files, or update one."""

from __future__ import annotations

import hashlib
import socket
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Literal

import msgspec
from msgspec.structs import replace

from fdvv._version import __version__
from fdvv.button.fit import one_line
from fdvv.errors import InputError
from fdvv.eventlog import Journal
from fdvv.io.documents import MODEL, Kind, own_kind, pretty, read_document
from fdvv.io.files import read_limited, write_atomic
from fdvv.io.part_store import PartStore, need_parquet
from fdvv.parallel.campaign import run_campaign
from fdvv.parallel.executor import DEADLY, Executor
from fdvv_studio.library.catalog import ButtonFile, source_files
from fdvv_studio.library.figures import UNREADABLE, read_file, refusal, row_of_file
from fdvv_studio.library.table import FORMAT, VERSION, LibraryRecord, library_schema, sample, table_of

BLOCK_bytes = 1 << 20  # assumed: a single read of most files, and little memory for any


def read_button(file: ButtonFile) -> LibraryRecord:
    """Read a file; whatever it holds, a record comes."""
    record = LibraryRecord(file.id, file.place, file.stamp, one_line(file.pair.name) if file.pair else None)
    try:
        record = replace(record, sha256=_sha256(file))
        return _read_record(file, record) if own_kind(file.path) in (None, MODEL) else record
    except UNREADABLE as error:
        return replace(record, reason=refusal(error))


@dataclass(frozen=True)
class LibraryWork:
    """Reads the files of a chunk.

    folders : where the files lie; a worker that does not see them must not refuse every file.
    read : reads one file.
    """

    folders: tuple[Path, ...]
    read: Callable[[ButtonFile], LibraryRecord] = read_button

    def __call__(self, files: tuple[ButtonFile, ...]) -> list[LibraryRecord]:
        """Return a record for every file, in their order."""
        for folder in self.folders:
            if not folder.is_dir():
                where = f"{folder} is not there on {socket.gethostname()}"
                raise FileNotFoundError(f"{where}; share the folder with every worker")
        return [self.read(file) for file in files]


def _read_record(file: ButtonFile, record: LibraryRecord) -> LibraryRecord:
    parsed = read_file(file.path)
    row = row_of_file(file.path, file.id, file.collection, file.origin, parsed)
    warnings = parsed.parts.warnings if parsed.parts else ()
    return replace(record, row=row, format=parsed.format, warnings=warnings, curves=sample(parsed.model))


def _sha256(file: ButtonFile) -> str:
    digest = hashlib.sha256()
    for path in filter(None, (file.path, file.pair)):
        with path.open("rb") as stream:
            while block := stream.read(BLOCK_bytes):
                digest.update(block)
    return digest.hexdigest()


MANIFEST, BUTTONS, LOCK = "library.json", "buttons.parquet", ".lock"
REMEDY = "name the folder of a library, or build one with fdvv library build"
KIND = Kind(FORMAT, VERSION, "a library", REMEDY)
LARGEST_bytes = 1_000_000
FILES = 64
"""Of a chunk: half a second of work, and what a killed process has to do again."""

Progress = Callable[[int, int], None]
"""Called with the number of known files, and of all."""


class LibraryManifest(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """What a library's folder says of itself.

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
        """Return the report of ``fdvv library build --json``."""
        counts = asdict(self)
        return {"library": str(counts.pop("folder")), **counts}


def build_library(
    sources: Sequence[Path],
    folder: Path,
    executor: Executor,
    progress: Progress = lambda _done, _whole: None,
    work: LibraryWork | None = None,
) -> LibraryBuilt:
    """Read every measured file below folders into a library: what did not change is not read again.

    folder : new, empty, or a library of the same folders, complete or not. An interrupted build continues
    with the same call. work : how files are read.
    Raises InputError on a folder of other things, of another library or at work elsewhere, and if there is
    nothing to read; BuildError without the extra `sweep`; WorkerError; OSError.
    """
    need_parquet()
    folder, sources = Path(folder), [Path(source).resolve() for source in sources]
    files = _list_files(sources)
    labels = tuple(dict.fromkeys(file.place.partition("/")[0] for file in files))
    _begin(folder, labels)
    busy = InputError(folder, "folder", "another process builds it", "wait for it")
    with Journal(folder / LOCK, busy):
        store = PartStore(folder / BUTTONS, library_schema(), ("id", "stamp"))
        known = len(store)
        read = run_campaign(
            executor,
            work or LibraryWork(tuple(sources)),
            files,
            lambda _files, records: store.add(table_of(records)),
            done=lambda file: (file.id, file.stamp) in store,
            progress=progress,
            item_s=1.0,
            chunk_s=FILES,
            lost=_deadly,
        )
        store.finish([(file.id, file.stamp) for file in files])
        kept = len(files) - read
        return _finish(folder, labels, store, (read, kept, known - kept))


def read_manifest(folder: Path) -> LibraryManifest:
    """Read what a library's folder says of itself. InputError if it is none."""
    if not (folder / MANIFEST).is_file():
        raise InputError(folder, "library", f"there is no {MANIFEST} in it", REMEDY)
    path = folder / MANIFEST
    read = msgspec.json.Decoder(LibraryManifest).decode
    return read_document(read_limited(path, LARGEST_bytes, REMEDY), path, KIND, read, lambda _: None)


def _list_files(sources: Sequence[Path]) -> list[ButtonFile]:
    for source in sources:
        if not source.is_dir():
            raise InputError(source, "folder", "there is no such folder", "give a folder of measurements")
    files = list(source_files(sources))
    if not files:
        names = ", ".join(map(str, sources))
        reason = "no .csv, .ods, .json or .txt file of measurements in it"
        raise InputError(names, "folder", reason, "name another folder")
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


def _finish(
    folder: Path, labels: tuple[str, ...], store: PartStore, changes: tuple[int, int, int]
) -> LibraryBuilt:
    states = [state for table in store.tables(["state"]) for state in table.column("state").to_pylist()]
    files, buttons, refused = len(states), states.count("button"), states.count("refused")
    manifest = LibraryManifest(sources=labels, finished=True, files=files, buttons=buttons, refused=refused)
    if read_manifest(folder) != manifest:
        _write_manifest(folder, manifest)
    return LibraryBuilt(folder, files, buttons, refused, *changes)


def _deadly(file: ButtonFile) -> LibraryRecord:
    return LibraryRecord(file.id, file.place, file.stamp, reason=f"whole file: {DEADLY}")


def _write_manifest(folder: Path, manifest: LibraryManifest) -> None:
    write_atomic(folder / MANIFEST, pretty(msgspec.to_builtins(manifest)) + "\n")

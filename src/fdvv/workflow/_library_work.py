"""The work of a library's chunk: files read to rows and curves."""

from __future__ import annotations

import hashlib
import socket
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from msgspec.structs import replace

from fdvv.capture import read_force_file
from fdvv.errors import FdvvError, InputError
from fdvv.model import FDVVModel, load_model
from fdvv.workflow._fit import one_line
from fdvv.workflow._kind import MODEL, own_kind
from fdvv.workflow._library_record import LibraryRecord, sampled
from fdvv.workflow._shelf_files import ShelfFile
from fdvv.workflow._shelf_read import button_of_file, row_of_model

BLOCK_bytes = 1 << 20


def read_button(file: ShelfFile) -> LibraryRecord:
    """Read a file; whatever it holds, a record comes."""
    begun = LibraryRecord(file.id, file.place, file.stamp, one_line(file.pair.name) if file.pair else None)
    try:
        begun = replace(begun, sha256=_sha256(file))
        kind = own_kind(file.path)
        return _read(file, begun, kind == MODEL) if kind in (None, MODEL) else begun
    except InputError as error:
        reason = f"{error.place}: {error.reason}; {error.remedy}"
    except (FdvvError, OSError, ValueError, ArithmeticError, LookupError, MemoryError) as error:
        reason = f"whole file: cannot be read ({error}); check the file"
    return replace(begun, reason=one_line(reason))


@dataclass(frozen=True)
class LibraryWork:
    """Reads the files of a chunk.

    Attributes
    ----------
    folders : where the files lie; a worker that does not see them must not refuse every file.
    read : reads one file.
    """

    folders: tuple[Path, ...]
    read: Callable[[ShelfFile], LibraryRecord] = read_button

    def __call__(self, files: tuple[ShelfFile, ...]) -> list[LibraryRecord]:
        """Give a record for every file, in their order."""
        for folder in self.folders:
            if not folder.is_dir():
                host = socket.gethostname()
                raise FileNotFoundError(
                    f"{folder} is not there on {host}; share the folder with every worker"
                )
        return [self.read(file) for file in files]


def _read(file: ShelfFile, begun: LibraryRecord, is_model: bool) -> LibraryRecord:
    dated = datetime.fromtimestamp(file.path.stat().st_mtime, UTC).date().isoformat()
    if is_model:
        model: FDVVModel = load_model(file.path)
        row = row_of_model(model, file.id, file.origin, file.collection, dated)
        return replace(begun, row=row, format="fdvv-model", curves=sampled(model))
    found = read_force_file(file.path)
    model, parts = button_of_file(found, file.path)
    row = row_of_model(model, file.id, file.origin, file.collection, dated, parts)
    return replace(begun, row=row, format=found.format, warnings=parts.warnings, curves=sampled(model))


def _sha256(file: ShelfFile) -> str:
    digest = hashlib.sha256()
    for path in filter(None, (file.path, file.pair)):
        with path.open("rb") as stream:
            while block := stream.read(BLOCK_bytes):
                digest.update(block)
    return digest.hexdigest()

"""One studio per project: a lock that the system frees however the process ends.

Two studios would take each other's devices, and each would mark the other's running jobs as cancelled. A
killed studio leaves the file behind, which then locks nothing.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from fdvv.errors import InputError
from fdvv.io.files import open_alone

LOCK_FILE = ".studio-lock"
LONGEST_bytes = 200
"""Of the address in the file."""


@contextmanager
def project_lock(project: Path) -> Iterator[int]:
    """Keep a project to this studio while the block lasts; the value is for ``note_address``.

    A folder that was made for the lock, and in which nothing was kept, is removed again.
    Raises InputError, which names the other studio's address, if another one has the project. OSError.
    """
    made = [folder for folder in (project, *project.absolute().parents) if not folder.exists()]
    lock = _lock(project)
    try:
        yield lock
    finally:
        # removed while it is locked: a studio that has opened the old file tries again
        with suppress(OSError):
            (project / LOCK_FILE).unlink()
        os.close(lock)
        for folder in made:
            with suppress(OSError):
                folder.rmdir()


def note_address(lock: int, address: str) -> None:
    """Write the address of this studio, without its token, for whoever is refused."""
    os.ftruncate(lock, 0)
    os.write(lock, address.encode())


def _lock(project: Path) -> int:
    path = project / LOCK_FILE
    while not project.is_file():
        # a studio that has just ended may take file and folder away in between
        with suppress(FileNotFoundError, FileExistsError):
            project.mkdir(parents=True, exist_ok=True)
            try:
                lock = open_alone(path)
            except BlockingIOError:
                reason = f"another studio has this project open{_address(path)}"
                raise InputError(project, "project", reason, "use it, or name another --project") from None
            if _is(lock, path):
                return lock
            os.close(lock)
    raise InputError(project, "project", "is a file", "name a folder")


def _is(lock: int, path: Path) -> bool:
    """Return whether an open file is the one that has this name now."""
    try:
        return os.path.samestat(os.fstat(lock), path.stat())
    except FileNotFoundError:
        return False


def _address(path: Path) -> str:
    try:
        with path.open("rb") as stream:
            address = stream.read(LONGEST_bytes).decode(errors="replace").strip()
    except OSError:
        return ""
    return f" at {address}" if address else ""

"""Write files whole or not at all; open them alone; read small ones."""

from __future__ import annotations

import os
import signal
import stat
import sys
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import BinaryIO

from fdvv.errors import InputError

FAR_byte = 1 << 40
"""Where Windows is asked to lock: what it locks nobody else can read, and no file of ours grows so long."""

LONGEST_NAME_bytes = 255
"""Of a file, on all common file systems."""
TEMPORARY_bytes = 14
"""What the name of a temporary file has more than that of its file: two points, eight letters, .tmp."""


def _umask() -> int:
    found = os.umask(0)
    os.umask(found)
    return found


UMASK = _umask()
"""Of this process, read once: reading it changes it for a moment, for all threads."""
OWNER_FILE, OWNER_FOLDER = 0o600, 0o700
"""Permissions of what holds people's data."""


def write_atomic(path: Path, content: str | bytes, private: bool = False) -> None:
    """Write content to path so that a killed process leaves the old file or the new one, never half.

    The content goes to a temporary file in the same folder, is forced to disk, then renamed.
    Text is UTF-8 with the line endings as given. Parent folders are made. private : only this account can
    read it, and open the folder that it was made with. Raises OSError.
    """
    path = Path(path)
    if private:
        private_folder(path.parent)
    path.parent.mkdir(parents=True, exist_ok=True)
    with atomic_stream(path, private) as stream:
        stream.write(content.encode() if isinstance(content, str) else content)


def private_folder(folder: Path) -> None:
    """Make a folder that only this account can open, unless it is there; parents as usual. OSError."""
    if not folder.is_dir():
        folder.parent.mkdir(parents=True, exist_ok=True)
        folder.mkdir(mode=OWNER_FOLDER, exist_ok=True)


def make_private(folder: Path) -> None:
    """Let only this account open a folder and read all that lies in it; nothing if there is none. OSError."""
    if folder.is_dir():
        folder.chmod(OWNER_FOLDER)
        for path in folder.rglob("*"):
            if not path.is_symlink():
                path.chmod(OWNER_FOLDER if path.is_dir() else OWNER_FILE)


@contextmanager
def atomic_stream(path: Path, private: bool = False) -> Iterator[BinaryIO]:
    """Open a stream whose content becomes the file when the block ends, and is dropped if it fails.

    private : only this account can read the file.
    """
    short = len(os.fsencode(path.name)) <= LONGEST_NAME_bytes - TEMPORARY_bytes
    prefix = f".{path.name}." if short else ".fdvv."
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=prefix, suffix=".tmp")
    temporary = Path(name)
    try:
        with os.fdopen(handle, "wb") as stream:
            yield stream
            stream.flush()
            os.fsync(stream.fileno())
        # mkstemp keeps a file to its owner; an ordinary open() gives what the umask leaves
        temporary.chmod(OWNER_FILE if private else 0o666 & ~UMASK)
        temporary.replace(path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def require_new_folder(folder: Path, remedy: str) -> None:
    """Raise InputError unless a folder is empty or does not exist."""
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise InputError(folder, "folder", "is not empty", remedy)


def open_alone(path: Path) -> int:
    """Open a file to read and append for this process alone, made if it is not there; return its handle.

    The system frees it however the process ends; others can still read it. Raises BlockingIOError if another
    process has it so, OSError.
    """
    flags = os.O_RDWR | os.O_CREAT | os.O_APPEND
    # Windows would turn line ends and hand the file on to what is started; elsewhere these are as wanted
    flags |= getattr(os, "O_BINARY", 0) | getattr(os, "O_NOINHERIT", 0) | getattr(os, "O_CLOEXEC", 0)
    file = os.open(path, flags, 0o666)
    try:
        _lock(file)
    except BaseException:
        os.close(file)
        raise
    return file


def _lock(file: int) -> None:
    """Take a file for this process, or raise BlockingIOError at once."""
    if sys.platform == "win32":
        import msvcrt

        os.lseek(file, FAR_byte, os.SEEK_SET)
        try:
            msvcrt.locking(file, msvcrt.LK_NBLCK, 1)
        except PermissionError as error:
            raise BlockingIOError(error.errno, error.strerror) from error
        return
    import fcntl

    fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


def sync_folder(folder: Path) -> None:
    """Force the names in a folder to disk, so that a file made in it is still there after a power cut.

    Windows opens no folder; its file system keeps a journal of names.
    """
    if sys.platform == "win32":
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def open_plain(path: Path | str) -> BinaryIO:
    """Open a file to read. A device or a pipe could have no end, or keep its reader waiting: InputError.

    Raises OSError, a folder's among them.
    """
    mode = Path(path).stat().st_mode
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
        reason = "is a device or a pipe, not a file"
        raise InputError(path, "whole file", reason, "save what it holds in a file first")
    return Path(path).open("rb")


def read_limited(path: Path | str, limit_bytes: int, remedy: str) -> bytes:
    """Read a file that should be small. InputError where it cannot be read or is larger than the limit.

    remedy : what to pass instead of a file that is too large.
    """
    try:
        with open_plain(path) as stream:
            # a reader asked for more than there is takes that much memory at once; /proc knows no sizes
            size = os.fstat(stream.fileno()).st_size or limit_bytes
            content = stream.read(min(size, limit_bytes) + 1)
    except OSError as error:
        reason = error.strerror or str(error)
        raise InputError(path, "whole file", reason, "check the path and its permissions") from error
    if len(content) > limit_bytes:
        raise InputError(path, "whole file", f"larger than {limit_bytes // 1_000_000} MB", remedy)
    return content


@contextmanager
def defer_interrupt() -> Iterator[None]:
    """Defer Ctrl-C until the block is left, so that a press that was made is stored."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    came: list[int] = []

    def note(number: int, _frame: FrameType | None) -> None:
        came.append(number)

    before = signal.signal(signal.SIGINT, note)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
    if came:
        raise KeyboardInterrupt

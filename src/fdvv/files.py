"""Write files whole or not at all; read small ones."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from fdvv.errors import InputError


def write_atomic(path: Path, content: str | bytes) -> None:
    """Write content to path so that a killed process leaves the old file or the new one, never half.

    The content goes to a temporary file in the same folder, is forced to disk, then renamed.
    Text is UTF-8 with the line endings as given. Parent folders are made. Raises OSError.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    data = content.encode() if isinstance(content, str) else content
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", suffix=".tmp")
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        # mkstemp makes files private; give the permissions an ordinary open() would
        umask = os.umask(0)
        os.umask(umask)
        Path(name).chmod(0o666 & ~umask)
        Path(name).replace(path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise


def sync_folder(folder: Path) -> None:
    """Force the names in a folder to disk, so that a file made in it is still there after a power cut."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def read_limited(path: Path | str, limit_bytes: int, remedy: str) -> bytes:
    """Read a file that should be small. InputError where it cannot be read or is larger than the limit.

    remedy : what to pass instead of a file that is too large.
    """
    try:
        with Path(path).open("rb") as stream:
            # a reader asked for more than there is takes that much memory at once; of a pipe no size is known
            size = os.fstat(stream.fileno()).st_size or limit_bytes
            content = stream.read(min(size, limit_bytes) + 1)
    except OSError as error:
        reason = error.strerror or str(error)
        raise InputError(path, "whole file", reason, "check the path and its permissions") from error
    if len(content) > limit_bytes:
        raise InputError(path, "whole file", f"larger than {limit_bytes // 1_000_000} MB", remedy)
    return content

"""The token of a studio whose address outlives its restarts: a secret in the project, for its owner alone."""

from __future__ import annotations

import os
import re
import secrets
import stat
from pathlib import Path

from fdvv.errors import InputError
from fdvv.files import sync_folder, write_atomic

TOKEN_FILE, IGNORE_FILE = ".studio-token", ".gitignore"
TOKEN = re.compile(r"[A-Za-z0-9_-]{32,64}")
REMEDY = "delete it: the next start draws another, and the old address opens nothing"


def new_token() -> str:
    """Draw a token, 192 bits."""
    return secrets.token_urlsafe(24)


def kept_token(project: Path) -> str:
    """Give the token that a project keeps; draw it when it is first asked for.

    InputError where others can read it, or where it is none. OSError.
    """
    path = project / TOKEN_FILE
    project.mkdir(parents=True, exist_ok=True)
    try:
        # nobody else may read it, not even for the moment between making and closing it to them
        handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    except FileExistsError:
        return _read(path)
    with os.fdopen(handle, "w", encoding="utf-8") as stream:
        stream.write(token := new_token())
        stream.flush()
        os.fsync(stream.fileno())
    if not (project / IGNORE_FILE).exists():
        # projects are put under version control
        write_atomic(project / IGNORE_FILE, f"{TOKEN_FILE}\n")
    sync_folder(project)
    return token


def _read(path: Path) -> str:
    about = path.stat(follow_symlinks=False)
    if not stat.S_ISREG(about.st_mode):
        raise InputError(path, "whole file", "is no plain file", REMEDY)
    # Windows knows no such permissions
    if os.name == "posix" and about.st_mode & 0o077:
        raise InputError(path, "permissions", "others on this machine can read it", REMEDY)
    token = path.read_text(encoding="utf-8", errors="replace").strip()
    if not TOKEN.fullmatch(token):
        raise InputError(path, "whole file", "holds no token", REMEDY)
    return token

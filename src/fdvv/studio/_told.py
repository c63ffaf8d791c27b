"""How what went wrong is told on the page."""

from __future__ import annotations

import os
from pathlib import Path

from fdvv.errors import FdvvError, InputError


def told(error: FdvvError | OSError) -> str:
    """Give an error's one line; whoever looks at the page needs no path of this machine."""
    if isinstance(error, InputError):
        return f"{error.place}: {error.reason}; {error.remedy}"
    if isinstance(error, OSError) and error.strerror:
        known = isinstance(error.filename, str | bytes)  # else a number, or nothing
        return f"{Path(os.fsdecode(error.filename)).name}: {error.strerror}" if known else error.strerror
    return str(error)

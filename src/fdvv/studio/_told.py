"""How what went wrong is told on the page."""

from __future__ import annotations

from fdvv.errors import FdvvError, InputError


def told(error: FdvvError) -> str:
    """Give an error's one line; whoever looks at the page needs no path of this machine."""
    if isinstance(error, InputError):
        return f"{error.place}: {error.reason}; {error.remedy}"
    return str(error)

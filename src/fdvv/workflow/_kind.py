"""Tell files that fdvv wrote from files of measurements."""

from __future__ import annotations

from pathlib import Path

MODEL, ACTUATION = "an FDVV model", "an actuation"
MARKS = {
    b'"fdvv-model"': MODEL,
    b'"fdvv-actuation"': ACTUATION,
    b'"fdvv-session"': "a session",
    b'"fdvv-receipt"': "a receipt",
}
HEAD_bytes = 200
"""The format is the first field of the files that fdvv writes."""


def own_kind(path: Path) -> str | None:
    """Say what a file holds if fdvv wrote it; None for anything else and for what cannot be read."""
    if path.suffix.lower() != ".json":
        return None
    try:
        with path.open("rb") as stream:
            head = stream.read(HEAD_bytes)
    except OSError:
        return None
    return next((kind for mark, kind in MARKS.items() if mark in head), None)

"""The ``*.exciter.json`` file: a known exciter as versioned plain JSON."""

from __future__ import annotations

from dataclasses import asdict, fields
from pathlib import Path
from typing import Literal

import msgspec

from fdvv.documents import Kind, pretty, read_document
from fdvv.errors import InputError, ModelError
from fdvv.files import read_limited, write_atomic
from fdvv.vibration._exciter import KnownExciter

EXCITER_SUFFIX = ".exciter.json"
"""How the name of a known exciter's file ends."""
LIMIT_bytes = 100_000
_REMEDY = "identify the exciter again"
_KIND = Kind("fdvv-exciter", 1, "a known exciter", _REMEDY)


class ExciterRecord(msgspec.Struct, forbid_unknown_fields=True):
    """A known exciter in its file; the names are those of KnownExciter."""

    format: Literal["fdvv-exciter"]
    version: Literal[1]
    gain_m_s2_V: float
    resonance_Hz: float
    quality: float
    latency_s: float | None = None
    error: dict[str, float] = {}
    residual_ratio: float = 0.0
    tones: int = 0
    simulated: bool = False


def save_exciter(exciter: KnownExciter, path: Path | str) -> None:
    """Write a known exciter to an ``*.exciter.json`` file, whole or not at all. Raises OSError."""
    head = {"format": _KIND.format, "version": _KIND.version}
    write_atomic(Path(path), pretty({**head, **asdict(exciter)}) + "\n")


def load_exciter(path: Path | str) -> KnownExciter:
    """Read an ``*.exciter.json`` file. InputError names the place in it and the remedy."""
    text = read_limited(path, LIMIT_bytes, _REMEDY)
    found = read_document(text, path, _KIND, _decoded, lambda _: None)
    numbers = {f.name: getattr(found, f.name) for f in fields(KnownExciter)}
    try:
        return KnownExciter(**numbers)
    except ModelError as error:
        raise InputError(path, "numbers", str(error), _REMEDY) from error


def _decoded(data: bytes) -> ExciterRecord:
    return msgspec.json.decode(data, type=ExciterRecord)

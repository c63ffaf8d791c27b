"""The ``*.rig.json`` file: a known rig as versioned plain JSON, each number with its standard error."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import Literal

import msgspec

from fdvv.compensate._known_rig import KnownRig
from fdvv.documents import Kind, pretty, read_document
from fdvv.errors import InputError, ModelError
from fdvv.files import read_limited, write_atomic

FORMAT, VERSION, SUFFIX = "fdvv-rig", 1, ".rig.json"
LIMIT_bytes = 1_000_000
_REMEDY = "identify the rig again"
_KIND = Kind(FORMAT, VERSION, "a known rig", _REMEDY)


class RigRecord(msgspec.Struct, forbid_unknown_fields=True):
    """A known rig in its file; the names are those of KnownRig."""

    format: Literal["fdvv-rig"]
    version: Literal[1]
    gain: tuple[float, float, float]
    delay_s: float
    electric_lag_s: float
    position_lag_s: float
    drag_N_s_m: float
    back_emf_N_s_m: float
    friction_cN: float
    weight_cN: float
    mass_g: float
    play_cN: float
    position_noise_mm: float
    force_noise_cN: float
    residual_cN: float
    presses: int
    error: dict[str, float]


def rig_to_json(known: KnownRig) -> str:
    """Write a known rig as the text of a ``*.rig.json`` file."""
    numbers = {f.name: getattr(known, f.name) for f in fields(known)}
    told = {**numbers, "gain": list(known.gain), "error": dict(known.error)}
    return pretty({"format": FORMAT, "version": VERSION, **told}) + "\n"


def rig_from_json(text: str | bytes, source: object = "rig") -> KnownRig:
    """Read a known rig from its text; InputError names source, the place in it and the remedy."""
    return read_document(text, source, _KIND, lambda data: _rig(data, source), lambda _place: None)


def _rig(data: bytes, source: object) -> KnownRig:
    record = msgspec.json.decode(data, type=RigRecord)
    try:
        return KnownRig(**{f.name: getattr(record, f.name) for f in fields(KnownRig)})
    except ModelError as error:
        raise InputError(source, "$", str(error), _REMEDY) from error


def save_rig(known: KnownRig, path: Path | str) -> None:
    """Write a known rig to a ``*.rig.json`` file, whole or not at all. Raises OSError."""
    write_atomic(Path(path), rig_to_json(known))


def load_rig(path: Path | str) -> KnownRig:
    """Read a known rig from a ``*.rig.json`` file. Raises InputError, also where it cannot be read."""
    return rig_from_json(read_limited(path, LIMIT_bytes, "pass a file of a known rig"), path)

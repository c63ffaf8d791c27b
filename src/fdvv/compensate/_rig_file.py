"""The ``*.rig.json`` file: a known rig as versioned plain JSON, and what it has taught beyond its numbers."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import Any, Literal

import msgspec
import numpy as np

from fdvv.compensate._known_rig import KnownRig
from fdvv.compensate._rig_memory import RigMemory
from fdvv.documents import Kind, pretty, read_document
from fdvv.errors import InputError
from fdvv.files import read_limited, write_atomic
from fdvv.model import ForceSurface

FORMAT, VERSION, SUFFIX = "fdvv-rig", 1, ".rig.json"
LIMIT_bytes = 4_000_000
_REMEDY = "identify the rig again"
_KIND = Kind(FORMAT, VERSION, "a known rig", _REMEDY)
_TABLES = ("displacement_mm", "velocity_mm_s", "press_cN", "release_cN")


class LearnedRecord(msgspec.Struct, forbid_unknown_fields=True):
    """What a rig has taught beyond its numbers; the names are those of RigMemory and its residual."""

    travel_mm: float
    displacement_mm: list[float]
    velocity_mm_s: list[float]
    press_cN: list[list[float]]
    release_cN: list[list[float]]
    error_cN: tuple[list[float], list[float]]


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
    learned: LearnedRecord | None = None


def rig_to_json(rig: KnownRig | RigMemory) -> str:
    """Write a known rig, or what it has taught, as the text of a ``*.rig.json`` file."""
    known = rig.known if isinstance(rig, RigMemory) else rig
    numbers = {f.name: getattr(known, f.name) for f in fields(known)}
    told = {**numbers, "gain": list(known.gain), "error": dict(known.error)}
    learned = {"learned": _learned(rig)} if isinstance(rig, RigMemory) else {}
    return pretty({"format": FORMAT, "version": VERSION, **told, **learned}) + "\n"


def _learned(memory: RigMemory) -> dict[str, Any]:
    tables = {name: getattr(memory.residual, name).tolist() for name in _TABLES}
    return {"travel_mm": memory.travel_mm, **tables, "error_cN": memory.error_cN.tolist()}


def rig_from_json(text: str | bytes, source: object = "rig") -> KnownRig:
    """Read a known rig from its text; InputError names source, the place in it and the remedy."""
    return _read(text, source)[0]


def memory_from_json(text: str | bytes, source: object = "rig") -> RigMemory:
    """Read what a rig has taught from its text; InputError names source, place and remedy, also where the
    text holds a rig's numbers alone.
    """
    _, memory = _read(text, source)
    if memory is None:
        reason = "holds the rig's numbers, but nothing that it has taught"
        raise InputError(source, "$.learned", reason, "keep it with fdvv compensate --save-rig")
    return memory


def _read(text: str | bytes, source: object) -> tuple[KnownRig, RigMemory | None]:
    return read_document(text, source, _KIND, lambda data: _rig(data, source), lambda _place: None)


def _rig(data: bytes, source: object) -> tuple[KnownRig, RigMemory | None]:
    record, place = msgspec.json.decode(data, type=RigRecord), "$"
    try:
        known = KnownRig(**{f.name: getattr(record, f.name) for f in fields(KnownRig)})
        place = "$.learned"
        return known, _memory(known, record.learned) if record.learned else None
    except ValueError as error:  # rows of different lengths, or what a record refuses
        raise InputError(source, place, str(error), _REMEDY) from error


def _memory(known: KnownRig, learned: LearnedRecord) -> RigMemory:
    residual = ForceSurface(*(np.array(getattr(learned, name), dtype=np.float64) for name in _TABLES))
    return RigMemory(known, residual, learned.travel_mm, np.array(learned.error_cN, dtype=np.float64))


def save_rig(rig: KnownRig | RigMemory, path: Path | str) -> None:
    """Write a known rig, or what it has taught, to a file, whole or not at all. Raises OSError."""
    write_atomic(Path(path), rig_to_json(rig))


def load_rig(path: Path | str) -> KnownRig:
    """Read a known rig from a ``*.rig.json`` file. Raises InputError, also where it cannot be read."""
    return rig_from_json(_text(path), path)


def load_memory(path: Path | str) -> RigMemory:
    """Read what a rig has taught from a file. Raises InputError, also if it holds nothing of that."""
    return memory_from_json(_text(path), path)


def _text(path: Path | str) -> bytes:
    return read_limited(path, LIMIT_bytes, "pass a file of a known rig")

"""The file of an actuation: tables for one device, how they were learned, and the session's summary."""

from __future__ import annotations

import json
from dataclasses import fields
from pathlib import Path
from typing import Any, Literal

import msgspec

from fdvv.compensation.force_loop.constants import of_earlier_version
from fdvv.compensation.identification.rig_file import RIG, RIG_FIELDS
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.compensation.method import CurveOutcome, Outcome, Tuning
from fdvv.errors import InputError, ModelError
from fdvv.io.documents import ACTUATION, Head, Layout, check_head, convert, document, own_kind, to_plain
from fdvv.io.files import read_limited, write_atomic
from fdvv.model.surface import ForceSurface
from fdvv.rendering.compensate import CompensationResult
from fdvv.rendering.run_summary import RunSummary, read_run_summary
from fdvv.units import Column, Table

FORMAT = "fdvv-actuation"
VERSION, LOOP_VERSION = 2, 3
"""The second only where the force loop is closed or the rig was known from its file: older versions of fdvv
read the other files."""
READ = (1, 2, 3)
LARGEST_bytes = 20_000_000
"""Version 1 had no receipt."""
SUFFIX = ".actuation.json"


class ActuationRecord(msgspec.Struct, forbid_unknown_fields=True):
    """Tables of actuation for one device, and how they were learned.

    rig : what was taken for granted of the rig, as in its file; null where it was identified.
    """

    format: Literal["fdvv-actuation"]
    version: Literal[1, 2, 3]
    method: str
    model: str
    device: str
    travel_mm: float
    displacement_mm: Column
    velocity_mm_s: Column
    press_cN: Table
    release_cN: Table
    curves: tuple[CurveOutcome, ...]
    presses: int
    skipped: list[str]
    explanation: str
    simulated: bool
    receipt: RunSummary | None = None
    tuning: dict[str, float | bool | dict[str, Any]] = {}
    rig: RigModel | None = None


LAYOUT = Layout(needed=RIG_FIELDS, beside=("$.rig.format", "$.rig.version"))


def save_actuation(result: CompensationResult, path: Path | str) -> None:
    """Write a result to an ``*.actuation.json`` file, whole or not at all. Raises OSError."""
    record: dict[str, Any] = {
        "format": FORMAT,
        "version": LOOP_VERSION if result.outcome.tuning.loop or result.known_rig else VERSION,
        **result.to_dict(),
        "travel_mm": result.travel_mm,
        **to_plain(result.surface),
        "tuning": result.outcome.tuning.to_dict(),
        "receipt": result.receipt.to_dict() if result.receipt else None,
    }
    if result.known_rig:
        record["rig"] = document(result.known_rig, RIG)
    write_atomic(Path(path), json.dumps(record, indent=1, allow_nan=False) + "\n")


def load_actuation(path: Path | str) -> CompensationResult:
    """Read an ``*.actuation.json`` file. Raises InputError, also where the file cannot be read."""
    remedy = "learn it again with fdvv compensate"
    try:
        record = msgspec.json.decode(read_limited(path, LARGEST_bytes, remedy), type=dict)
        if record.get("format") != FORMAT or record.get("version") not in READ:
            got = f"{record.get('format')!r} version {record.get('version')!r}"
            reason = f"expected {FORMAT!r} version {' or '.join(map(str, READ))}, got {got}"
            raise InputError(path, "$.format", reason, remedy)
        result = _result(convert(record, ActuationRecord, LAYOUT))
        if rig := record.get("rig"):
            check_head(Head(rig.get("format"), rig.get("version")), path, RIG, "$.rig")
        return result
    except (msgspec.MsgspecError, ValueError, RecursionError) as error:
        reason, _, place = str(error).partition(" - at ")
        raise InputError(path, place.strip("`") or "whole file", reason, remedy) from error


def open_run_summary(path: Path) -> RunSummary | None:
    """Return the summary in an actuation or a session's folder; None for other paths. Raises InputError."""
    if not (path.name.endswith(SUFFIX) or own_kind(path) == ACTUATION):
        return read_run_summary(path)
    receipt = load_actuation(path).receipt
    if receipt is None:
        reason = "was written before actuations had one (version 1)"
        raise InputError(path, "$.receipt", reason, "learn it again with fdvv compensate")
    return receipt


def _result(record: ActuationRecord) -> CompensationResult:
    grid = record.displacement_mm, record.velocity_mm_s
    surface = ForceSurface(*grid, record.press_cN, record.release_cN)
    learned = record.presses - len(record.skipped)
    unknown = sorted(set(record.tuning) - {f.name for f in fields(Tuning)})
    if unknown:
        raise ModelError(f"unknown field {unknown[0]!r} - at `$.tuning`")
    held = record.tuning
    if isinstance(loop := held.get("loop"), dict):
        held = {**held, "loop": of_earlier_version(loop)}
    tuning = msgspec.convert(held, Tuning)
    outcome = Outcome(surface, record.curves, learned, True, record.explanation, tuning)
    names = record.method, record.model, record.device, record.travel_mm
    about = tuple(record.skipped), record.simulated, record.receipt
    return CompensationResult(*names, outcome, *about, known_rig=record.rig)

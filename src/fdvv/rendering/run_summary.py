"""How a result came about: rig, method, presses used and not used, errors, time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from datetime import datetime
from pathlib import Path
from typing import Any, Literal

import msgspec

from fdvv.compensate import CurveOutcome
from fdvv.documents import Kind, pretty, read_document
from fdvv.files import read_limited, write_atomic
from fdvv.workflow._answer_log import ANSWERS, read_answers
from fdvv.workflow._session_file import Run
from fdvv.workflow._session_log import PRESSES, Entry, read_log
from fdvv.workflow._session_manifest import MANIFEST, LARGEST_bytes, Manifest, ModelName, read_manifest

RECEIPT = "receipt.json"
KIND = Kind("fdvv-receipt", 1, "a receipt", "run the session's command again, which writes it anew")


class NotUsed(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A press that was not used, and why."""

    number: int
    velocity_mm_s: float
    reason: str


class CurveErrors(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Errors of one curve, cN.

    Attributes
    ----------
    first_cN, last_cN, best_cN : error_k of presses, as measured by whoever made the result: the rig itself
        while it learned, the probe in true displacement.
    mean_cN, max_cN : of |target - felt| over the displacement.
    """

    stroke: Literal["press", "release"]
    velocity_mm_s: float
    presses: int
    first_cN: float | None
    last_cN: float | None
    best_cN: float | None
    mean_cN: float | None
    max_cN: float | None


class Receipt(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """How a result came about.

    Attributes
    ----------
    device : as the session's manifest tells it.
    seed, runs : of a simulated device the seed of the first run; every start of the program on the session.
    used, not_used : presses; answers of a tuning.
    begun, finished : UTC; the first start and the last press, None if there is none yet. Pauses between
        runs lie between.
    pressing_s : from the start of each run to its last press, summed.
    """

    format: Literal["fdvv-receipt"]
    version: Literal[1]
    task: Literal["compensate", "probe", "tune"]
    model: ModelName
    device: dict[str, Any]
    method: str
    settings: dict[str, Any]
    velocities_mm_s: list[float]
    seed: int | None
    simulated: bool
    runs: list[Run]
    used: int
    not_used: list[NotUsed]
    curves: list[CurveErrors]
    begun: str
    finished: str | None
    pressing_s: float

    def to_dict(self) -> dict[str, Any]:
        """Give it as plain values."""
        found = msgspec.to_builtins(self)
        assert isinstance(found, dict)
        return found


def make_receipt(
    manifest: Manifest, runs: Sequence[Run], entries: Sequence[Entry], curves: Sequence[CurveOutcome] = ()
) -> Receipt:
    """Write down how a result came about; without curves, how far a session is that is not finished."""
    return Receipt(
        "fdvv-receipt",
        1,
        manifest.task,
        manifest.model,
        manifest.device,
        manifest.method,
        manifest.settings,
        manifest.velocities_mm_s,
        manifest.seed,
        manifest.simulated,
        list(runs),
        sum(e.used for e in entries),
        [NotUsed(e.number, e.velocity_mm_s, e.reason) for e in entries if not e.used],
        [_errors(curve) for curve in curves],
        runs[0].started if runs else manifest.created,
        entries[-1].made if entries else None,
        _pressing_s(runs, entries),
    )


def save_receipt(folder: Path, receipt: Receipt) -> None:
    """Write the receipt of a session into its folder. Raises OSError."""
    write_atomic(folder / RECEIPT, pretty(receipt.to_dict()) + "\n")


def read_receipt(path: Path) -> Receipt | None:
    """Give the receipt of a session's folder; None if it is no such folder. InputError on a damaged one."""
    if not (path / MANIFEST).is_file():
        return None
    manifest = read_manifest(path / MANIFEST)
    if (path / RECEIPT).is_file():
        text = read_limited(path / RECEIPT, LARGEST_bytes, KIND.remedy)
        return read_document(text, path / RECEIPT, KIND, _decoded, lambda _: None)
    tuning = manifest.task == "tune"
    runs, entries, _ = read_answers(path / ANSWERS) if tuning else read_log(path / PRESSES)
    return make_receipt(manifest, runs, entries)


def _decoded(data: bytes) -> Receipt:
    return msgspec.json.decode(data, type=Receipt)


def _errors(curve: CurveOutcome) -> CurveErrors:
    errors = curve.error_cN
    told = (errors[0], errors[-1], min(errors)) if errors else (None, None, None)
    kept = (e if math.isfinite(e) else None for e in (curve.mean_error_cN, curve.max_error_cN))
    return CurveErrors(
        "press" if str(curve.stroke) == "press" else "release", curve.velocity_mm_s, len(errors), *told, *kept
    )


def _pressing_s(runs: Sequence[Run], entries: Sequence[Entry]) -> float:
    """Add up the time of each run, from its start to its last press."""
    starts = [datetime.fromisoformat(run.started) for run in runs]
    presses = [datetime.fromisoformat(entry.made) for entry in entries]
    total_s = 0.0
    for i, start in enumerate(starts):
        end = starts[i + 1] if i + 1 < len(starts) else None
        inside = [made for made in presses if start <= made and (end is None or made <= end)]
        total_s += (max(inside) - start).total_seconds() if inside else 0.0
    return round(total_s, 3)

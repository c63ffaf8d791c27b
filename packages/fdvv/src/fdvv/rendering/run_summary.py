"""Summary of a session: rig, method, presses used and not used, errors, time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from datetime import UTC, datetime
from itertools import pairwise
from pathlib import Path
from typing import Any, Literal

import msgspec

from fdvv.compensation.method import CurveOutcome
from fdvv.io.documents import Kind, pretty, read_record
from fdvv.io.files import write_atomic
from fdvv.model.curve import Stroke
from fdvv.rendering.session import (
    MANIFEST,
    MUST_AGREE,
    LARGEST_bytes,
    Manifest,
    ModelName,
    Task,
    read_manifest,
)
from fdvv.rendering.session_log import ANSWERS, PRESSES, AnswerLog, PressEntry, PressLog, SessionRun

RECEIPT = "receipt.json"
KIND = Kind("fdvv-receipt", 1, "a receipt", "run the session's command again, which writes it anew")
FROM_MANIFEST = (*MUST_AGREE, "simulated")


class NotUsed(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A press that was not used, and why."""

    number: int
    velocity_mm_s: float
    reason: str


class CurveErrors(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Errors of one curve, cN.

    Attributes
    ----------
    first_cN, last_cN, best_cN : error_k of presses, measured by the rig itself
        while it learned, or by a probe in true displacement.
    mean_cN, max_cN : of |target - rendered| over the displacement.
    """

    stroke: Literal["press", "release"]
    velocity_mm_s: float
    presses: int
    first_cN: float | None
    last_cN: float | None
    best_cN: float | None
    mean_cN: float | None
    max_cN: float | None


class RunSummary(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """How a result was obtained.

    Attributes
    ----------
    device : from the session's manifest.
    seed, runs : of a simulated device the seed of the first run; every start of the program on the session.
    used, not_used : presses; answers of a tuning.
    begun, finished : UTC; the first start and the last press, None if there is none yet. Pauses between
        runs lie between.
    pressing_s : from the start of each run to its last press, summed.
    """

    format: Literal["fdvv-receipt"]
    version: Literal[1]
    task: Task
    model: ModelName
    device: dict[str, Any]
    method: str
    settings: dict[str, Any]
    velocities_mm_s: list[float]
    seed: int | None
    simulated: bool
    runs: list[SessionRun]
    used: int
    not_used: list[NotUsed]
    curves: list[CurveErrors]
    begun: str
    finished: str | None
    pressing_s: float

    def to_dict(self) -> dict[str, Any]:
        record = msgspec.to_builtins(self)
        assert isinstance(record, dict)
        return record


def make_run_summary(
    manifest: Manifest,
    runs: Sequence[SessionRun],
    entries: Sequence[PressEntry],
    curves: Sequence[CurveOutcome] = (),
) -> RunSummary:
    """Return the summary of a session; without curves, of one that is not finished."""
    return RunSummary(
        "fdvv-receipt",
        1,
        **{name: getattr(manifest, name) for name in FROM_MANIFEST},
        runs=list(runs),
        used=sum(e.used for e in entries),
        not_used=[NotUsed(e.number, e.velocity_mm_s, e.reason) for e in entries if not e.used],
        curves=[_errors(curve) for curve in curves],
        begun=runs[0].started if runs else manifest.created,
        finished=entries[-1].made if entries else None,
        pressing_s=_pressing_s(runs, entries),
    )


def write_run_summary(
    folder: Path | None,
    manifest: Manifest,
    runs: Sequence[SessionRun],
    entries: Sequence[PressEntry],
    curves: Sequence[CurveOutcome] = (),
) -> RunSummary:
    """Return the summary of a session, written into its folder if it has one. Raises OSError."""
    summary = make_run_summary(manifest, runs, entries, curves)
    if folder:
        write_atomic(folder / RECEIPT, pretty(summary.to_dict()) + "\n")
    return summary


def read_run_summary(path: Path) -> RunSummary | None:
    """Return the summary of a session's folder; None if it is none. Raises InputError if it is damaged."""
    if not (path / MANIFEST).is_file():
        return None
    manifest = read_manifest(path / MANIFEST)
    if (path / RECEIPT).is_file():
        return read_record(path / RECEIPT, KIND, RunSummary, LARGEST_bytes)
    if manifest.task == "tune":
        runs, answers, _ = AnswerLog.read(path / ANSWERS)
        return make_run_summary(manifest, runs, [answer.entry for answer in answers])
    runs, entries, _ = PressLog.read(path / PRESSES)
    return make_run_summary(manifest, runs, entries)


def _errors(curve: CurveOutcome) -> CurveErrors:
    errors = curve.error_cN
    summary = (errors[0], errors[-1], min(errors)) if errors else (None, None, None)
    kept = (e if math.isfinite(e) else None for e in (curve.mean_error_cN, curve.max_error_cN))
    stroke: Literal["press", "release"] = "press" if curve.stroke is Stroke.PRESS else "release"
    return CurveErrors(stroke, curve.velocity_mm_s, len(errors), *summary, *kept)


def _pressing_s(runs: Sequence[SessionRun], entries: Sequence[PressEntry]) -> float:
    """Sum the time of each run, from its start to its last press."""
    starts = [datetime.fromisoformat(run.started) for run in runs]
    presses = [datetime.fromisoformat(entry.made) for entry in entries]
    total_s = 0.0
    for start, end in pairwise([*starts, datetime.max.replace(tzinfo=UTC)]):
        inside = [made for made in presses if start <= made <= end]
        total_s += (max(inside) - start).total_seconds() if inside else 0.0
    return round(total_s, 3)

"""Learn the actuation that makes a device feel like a model, and keep it in a file."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import msgspec
import numpy as np

from fdvv.compensate import CurveOutcome, Job, Method, Outcome, PaperLaw, PerCurve
from fdvv.device import Device
from fdvv.errors import DeviceError, InputError, ModelError
from fdvv.files import write_atomic
from fdvv.model import FDVVModel, ForceSurface, Press, Stroke

FORMAT = "fdvv-actuation"
VERSION = 1
SUFFIX = ".actuation.json"


@dataclass(frozen=True, eq=False)
class PressDone:
    """A press that was made: what a progress display needs, and the record itself.

    Attributes
    ----------
    stage : "compensate" or "probe".
    presses_done, presses_total : the total holds if no press is skipped.
    skipped : why the press taught nothing; empty if it did.
    """

    stage: str
    velocity_mm_s: float
    presses_done: int
    presses_total: int
    press: Press
    skipped: str = ""


Progress = Callable[[PressDone], None]


@dataclass(frozen=True, eq=False)
class CompensationResult:
    """Actuation for one device, and how it was learned.

    Attributes
    ----------
    method : the law and what it adds to the paper's.
    model_name, device_name, travel_mm : what was rendered, on what, with the stop where.
    outcome : surface of actuation, error history per curve, presses.
    simulated : the presses came from the twin.
    """

    method: str
    model_name: str
    device_name: str
    travel_mm: float
    outcome: Outcome
    simulated: bool

    @property
    def surface(self) -> ForceSurface:
        """Give the actuation."""
        return self.outcome.surface

    def to_dict(self) -> dict[str, Any]:
        """Give the report: per curve error_k of every press as the rig measured it while it learned."""
        return {
            "method": self.method,
            "model": self.model_name,
            "device": self.device_name,
            "presses": self.outcome.presses,
            "skipped": list(self.outcome.skipped),
            "explanation": self.outcome.sentence,
            "curves": [_curve_dict(c) for c in self.outcome.curves],
            "simulated": self.simulated,
        }

    def to_json(self) -> str:
        """Write the report as JSON."""
        return json.dumps(self.to_dict(), allow_nan=False)


def _curve_dict(curve: CurveOutcome) -> dict[str, Any]:
    return {
        "stroke": str(curve.stroke),
        "velocity_mm_s": curve.velocity_mm_s,
        "error_cN": list(curve.error_cN),
        "mean_error_cN": curve.mean_error_cN,
        "max_error_cN": curve.max_error_cN,
        "explanation": curve.sentence,
    }


def compensate(
    device: Device,
    model: FDVVModel,
    velocities_mm_s: Sequence[float],
    law: PaperLaw | Method[Any] | None = None,
    progress: Progress | None = None,
) -> CompensationResult:
    """Press and learn until the method is done.

    velocities_mm_s : speeds to learn at, any order; law : settings of a method, the paper's if None.
    progress : called after every press.

    Raises DeviceError if the device fails or the method gives up because presses keep failing, and
    InputError on speeds that cannot be learned at.
    """
    method = _method(law)
    info = device.info()
    state = method.init(_job(device, model, velocities_mm_s, method))
    while (trial := method.trial(state)) is not None:
        device.upload(trial.surface, model.travel_mm)
        press = device.press(trial.velocity_mm_s)
        known = len(method.count(state).skipped)
        state = method.step(press, state)
        if progress:
            count = method.count(state)
            why = "".join(count.skipped[known:])
            progress(PressDone("compensate", trial.velocity_mm_s, count.made, count.total, press, why))
    outcome = method.done(state)
    if not outcome.complete:
        raise DeviceError(f"{info.name}: {outcome.sentence}; check that the travel and the speeds suit it")
    return CompensationResult(method.name, model.name, info.name, model.travel_mm, outcome, info.simulated)


def uncompensated(
    device: Device,
    model: FDVVModel,
    velocities_mm_s: Sequence[float],
    law: PaperLaw | Method[Any] | None = None,
) -> ForceSurface:
    """Give the surface that a method starts from, before any press: what compensation is judged against.

    With the default law that is the model's own force, with the least command that keeps the cap up.
    """
    method = _method(law)
    return method.done(method.init(_job(device, model, velocities_mm_s, method))).surface


def _method(law: PaperLaw | Method[Any] | None) -> Method[Any]:
    return PerCurve(law or PaperLaw()) if law is None or isinstance(law, PaperLaw) else law


def _job(device: Device, model: FDVVModel, velocities_mm_s: Sequence[float], method: Method[Any]) -> Job:
    target = ForceSurface.of_model(model, check_speeds(velocities_mm_s), method.bin_mm)
    return Job(target, model.travel_mm, device.info().force_limit_cN)


def check_speeds(velocities_mm_s: Sequence[float]) -> list[float]:
    """Sort speeds; InputError unless they are positive, finite, different, and at least one."""
    speeds = sorted(float(v) for v in velocities_mm_s)
    remedy = "give one or more different speeds above 0 mm/s"
    if not speeds or not all(0 < v < float("inf") for v in speeds):
        raise InputError("velocities", "all", f"speeds cannot be {list(velocities_mm_s)} mm/s", remedy)
    if len(set(speeds)) != len(speeds):
        raise InputError("velocities", "all", f"a speed repeats in {speeds} mm/s", remedy)
    return speeds


class CurveRecord(msgspec.Struct, forbid_unknown_fields=True):
    """How one curve was learned."""

    stroke: Literal["press", "release"]
    velocity_mm_s: float
    error_cN: list[float]
    mean_error_cN: float | None
    max_error_cN: float | None
    explanation: str


class ActuationRecord(msgspec.Struct, forbid_unknown_fields=True):
    """Tables of actuation for one device, and how they were learned."""

    format: Literal["fdvv-actuation"]
    version: Literal[1]
    method: str
    model: str
    device: str
    travel_mm: float
    displacement_mm: list[float]
    velocity_mm_s: list[float]
    press_cN: list[list[float]]
    release_cN: list[list[float]]
    curves: list[CurveRecord]
    presses: int
    skipped: list[str]
    explanation: str
    simulated: bool


def save_actuation(result: CompensationResult, path: Path | str) -> None:
    """Write a result to an ``*.actuation.json`` file, whole or not at all. Raises OSError."""
    surface = result.surface
    columns = ("displacement_mm", "velocity_mm_s", "press_cN", "release_cN")
    record = {
        "format": FORMAT,
        "version": VERSION,
        **result.to_dict(),
        "travel_mm": result.travel_mm,
        **{name: getattr(surface, name).tolist() for name in columns},
    }
    write_atomic(Path(path), json.dumps(record, indent=1, allow_nan=False) + "\n")


def load_actuation(path: Path | str) -> CompensationResult:
    """Read an ``*.actuation.json`` file. Raises InputError, also where the file cannot be read."""
    remedy = "learn it again with fdvv compensate"
    try:
        record = msgspec.json.decode(Path(path).read_bytes(), type=dict)
        if record.get("format") != FORMAT or record.get("version") != VERSION:
            got = f"{record.get('format')!r} version {record.get('version')!r}"
            raise InputError(path, "$.format", f"expected {FORMAT!r} version {VERSION}, got {got}", remedy)
        return _result(msgspec.convert(record, ActuationRecord))
    except OSError as error:
        reason = error.strerror or str(error)
        raise InputError(path, "whole file", reason, "check the path and its permissions") from error
    except (msgspec.MsgspecError, UnicodeDecodeError, ModelError) as error:
        reason, _, place = str(error).partition(" - at ")
        raise InputError(path, place.strip("`") or "whole file", reason, remedy) from error


def _result(record: ActuationRecord) -> CompensationResult:
    columns = (record.displacement_mm, record.velocity_mm_s, record.press_cN, record.release_cN)
    surface = ForceSurface(*(np.array(column, dtype=np.float64) for column in columns))
    nan = float("nan")
    curves = tuple(
        CurveOutcome(
            Stroke(c.stroke),
            c.velocity_mm_s,
            tuple(c.error_cN),
            nan if c.mean_error_cN is None else c.mean_error_cN,
            nan if c.max_error_cN is None else c.max_error_cN,
            c.explanation,
        )
        for c in record.curves
    )
    outcome = Outcome(surface, curves, record.presses, tuple(record.skipped), True, record.explanation)
    return CompensationResult(
        record.method, record.model, record.device, record.travel_mm, outcome, record.simulated
    )

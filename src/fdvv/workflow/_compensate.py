"""Learn the actuation that makes a device feel like a model."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from fdvv.compensate import Count, CurveOutcome, Job, Method, Outcome, PaperLaw, PerCurve, RigMemory, judge
from fdvv.device import Device, Remote
from fdvv.errors import DeviceError, InputError
from fdvv.model import FDVVModel, ForceSurface
from fdvv.workflow._known_before import drift_told, remembered
from fdvv.workflow._receipt import Receipt, make_receipt, save_receipt
from fdvv.workflow._session import Session
from fdvv.workflow._session_events import Guide, Progress, Standing
from fdvv.workflow._session_log import PressLog
from fdvv.workflow._session_manifest import make_manifest
from fdvv.workflow._session_run import Course, run


@dataclass(frozen=True, eq=False)
class CompensationResult:
    """Actuation for one device, and how it was learned.

    Attributes
    ----------
    method : the law and what it adds to the paper's.
    model_name, device_name, travel_mm : what was rendered, on what, with the stop where.
    outcome : surface of actuation, error history per curve, presses.
    skipped : the presses that could not be used, each with its reason.
    simulated : the presses came from the twin.
    receipt : how it came about; None of files of version 1.
    memory : what the rig has taught, for other buttons; None of a method that keeps none, and of files.
    """

    method: str
    model_name: str
    device_name: str
    travel_mm: float
    outcome: Outcome
    skipped: tuple[str, ...]
    simulated: bool
    receipt: Receipt | None = None
    memory: RigMemory | None = None

    @property
    def surface(self) -> ForceSurface:
        """Give the actuation."""
        return self.outcome.surface

    @property
    def presses(self) -> int:
        """Count the presses made, those that could not be used among them."""
        return self.outcome.presses + len(self.skipped)

    def to_dict(self) -> dict[str, Any]:
        """Give the report: per curve error_k of every press as the rig measured it while it learned."""
        return {
            "method": self.method,
            "model": self.model_name,
            "device": self.device_name,
            "presses": self.presses,
            "skipped": list(self.skipped),
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
        "mean_error_cN": _known(curve.mean_error_cN),
        "max_error_cN": _known(curve.max_error_cN),
        "explanation": curve.sentence,
    }


def _known(error_cN: float) -> float | None:
    return error_cN if math.isfinite(error_cN) else None


def compensate(
    device: Device,
    model: FDVVModel,
    velocities_mm_s: Sequence[float],
    law: PaperLaw | Method[Any] | None = None,
    progress: Progress | None = None,
    session: Session | None = None,
    guide: Guide | None = None,
) -> CompensationResult:
    """Press and learn until the method is done.

    velocities_mm_s : speeds to learn at, any order; law : settings of a method, the paper's if None.
    progress : called after every press; guide : before it, and with notices.
    session : where presses are kept and what they must be; in memory with the usual bounds if None.

    Raises DeviceError if the device fails or too many presses in a row cannot be used, InputError on speeds
    that cannot be learned at and on a folder that is no session of this job, KeyboardInterrupt on Ctrl-C.
    """
    method, session = _method(law), session or Session()
    job = _job(device, model, velocities_mm_s, method)
    start = method.init(job)
    if method.trial(start) is not None:
        check_force_sensor(device)
    speeds = job.target.velocity_mm_s.tolist()
    manifest = make_manifest(
        "compensate", device, model, speeds, (method.name, method), (session.seed, session.parts)
    )
    with session.begun(manifest) as log:
        course = _course(method, job, log, session)
        course = replace(course, progress=progress or course.progress, guide=guide or course.guide)
        course = replace(course, progress=drift_told(method, course, log))
        state = run(device, course, start, log)
        outcome = method.done(state)
        if not outcome.complete:
            raise DeviceError(f"{device.info().name}: {outcome.sentence}")
        receipt = make_receipt(manifest, log.runs, log.entries, outcome.curves)
        if session.folder:
            save_receipt(session.folder, receipt)
        skipped = tuple(str(entry) for entry in log.entries if not entry.used)
    info = device.info()
    names = method.name, model.name, info.name, model.travel_mm
    memory = remembered(method, state)
    return CompensationResult(*names, outcome, skipped, info.simulated, receipt, memory)


def _course(method: Method[Any], job: Job, log: PressLog, session: Session) -> Course[Any]:
    return Course(
        "compensate",
        method,
        job.travel_mm,
        lambda press, pace_ratio: judge(press, job.travel_mm, session.acceptance.at_pace(pace_ratio)),
        session.acceptance.patience,
        lambda state: standings(job, method.count(state), log, method.done(state).curves),
    )


def standings(job: Job, count: Count, log: PressLog, curves: Sequence[CurveOutcome]) -> tuple[Standing, ...]:
    """Tell how far every velocity is."""
    speeds = job.target.velocity_mm_s.tolist()
    made = [sum(e.used and e.velocity_mm_s == speed for e in log.entries) for speed in speeds]
    wanted = count.wanted or (None,) * len(speeds)
    return tuple(
        Standing(speed, m, w, tuple(c for c in curves if c.velocity_mm_s == speed))
        for speed, m, w in zip(speeds, made, wanted, strict=True)
    )


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


def check_force_sensor(device: Device, truth_counts: bool = False) -> None:
    """Refuse a board without a force sensor on its cap: what it tells as force says nothing of the finger's.

    truth_counts : a simulated rig will do, as its true force is known. Raises DeviceError.
    """
    if not isinstance(device, Remote) or device.settings().force_gain_q14:
        return
    info = device.info()
    if not (truth_counts and info.simulated):
        remedy = 'name a --rig with [keycap_sensor] kind = "force"' if info.simulated else "fit one"
        raise DeviceError(
            f"{info.name}: no force sensor in its settings (force_gain_q14 is 0), its presses tell nothing "
            f"of the force felt; {remedy}"
        )


def check_speeds(velocities_mm_s: Sequence[float]) -> list[float]:
    """Sort speeds; InputError unless they are positive, finite, different, and at least one."""
    speeds = sorted(float(v) for v in velocities_mm_s)
    remedy = "give one or more different speeds above 0 mm/s"
    if not speeds or not all(0 < v < float("inf") for v in speeds):
        raise InputError("velocities", "all", f"speeds cannot be {list(velocities_mm_s)} mm/s", remedy)
    if len(set(speeds)) != len(speeds):
        raise InputError("velocities", "all", f"a speed repeats in {speeds} mm/s", remedy)
    return speeds

"""Judge a rendering: fresh presses, errors in true displacement."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

from fdvv.compensate import UNTUNED, FROM_mm, STOP_GUARD_mm, Tuning, judge
from fdvv.device import Device
from fdvv.model import FDVVModel, ForceSurface, Stroke, reading_order
from fdvv.workflow._compensate import check_force_sensor, check_speeds
from fdvv.workflow._probe_curve import ProbeCurve, judged_curves
from fdvv.workflow._probe_plan import Found, ProbePlan
from fdvv.workflow._receipt import Receipt, make_receipt, save_receipt
from fdvv.workflow._session import Session
from fdvv.workflow._session_events import Guide, Progress, Standing
from fdvv.workflow._session_log import PressLog
from fdvv.workflow._session_manifest import Manifest, make_manifest, table_digest
from fdvv.workflow._session_run import Course, run


@dataclass(frozen=True, eq=False)
class ProbeResult:
    """How a surface renders a model, judged on presses that nothing was learned from.

    Attributes
    ----------
    method : what made the surface.
    range_mm : displacement judged.
    presses : made, those that could not be used among them.
    skipped : the presses that could not be used, each with its reason.
    receipt : how it came about.
    """

    method: str
    model_name: str
    device_name: str
    range_mm: tuple[float, float]
    curves: tuple[ProbeCurve, ...]
    presses: int
    skipped: tuple[str, ...]
    simulated: bool
    receipt: Receipt

    def to_dict(self) -> dict[str, Any]:
        """Give the report; errors in cN, true displacement, median over presses."""
        return {
            "method": self.method,
            "model": self.model_name,
            "device": self.device_name,
            "range_mm": list(self.range_mm),
            "presses": self.presses,
            "skipped": list(self.skipped),
            "curves": [c.to_dict() for c in self.curves],
            "simulated": self.simulated,
        }

    def to_json(self) -> str:
        """Write the report as JSON."""
        return json.dumps(self.to_dict(), allow_nan=False)


def fd_only(model: FDVVModel) -> FDVVModel:
    """Reduce a model to force and displacement: the slowest curve of each stroke, no vibration."""
    slowest = tuple(model.of(stroke)[0] for stroke in Stroke if model.of(stroke))
    return replace(model, name=f"{model.name} (FD only)", curves=slowest, vibrations=())


def probe(
    device: Device,
    model: FDVVModel,
    surface: ForceSurface,
    velocities_mm_s: Sequence[float],
    presses: int = 10,
    progress: Progress | None = None,
    method: str = "as uploaded",
    session: Session | None = None,
    guide: Guide | None = None,
    tuning: Tuning = UNTUNED,
) -> ProbeResult:
    """Upload a surface once, press it afresh at every speed, and hold the felt force against the model.

    presses : per velocity, usable ones. The force on the finger is binned on the true displacement of
    the cap and held against the model at the speed that was asked for. A press that cannot be used is not
    judged but counted, with its reason; being at its limit is the rig's own doing and is judged.
    progress, session, guide : as in ``compensate``. tuning : of the controller, as it was learned with the
    surface; the device keeps it afterwards.

    Raises DeviceError if the device fails or too many presses in a row cannot be used, InputError on bad
    speeds and on a folder that is no session of this probe, KeyboardInterrupt on Ctrl-C.
    """
    session = session or Session()
    check_force_sensor(device, truth_counts=True)
    plan = ProbePlan(surface, tuple(check_speeds(velocities_mm_s)), presses, tuning)
    settings: dict[str, Any] = {"presses": presses, "surface_sha256": table_digest(surface)}
    if tuning != UNTUNED:
        settings["tuning"] = asdict(tuning)
    manifest = make_manifest(
        "probe", device, model, plan.velocities_mm_s, (method, settings), (session.seed, session.parts)
    )
    with session.begun(manifest) as log:
        course = _course(plan, model, session)
        course = replace(course, progress=progress or course.progress, guide=guide or course.guide)
        found = run(device, course, plan.init(), log)
        result = _result(device, model, method, _all_curves(model, plan, found), log, manifest)
        if session.folder:
            save_receipt(session.folder, result.receipt)
    return result


def _course(plan: ProbePlan, model: FDVVModel, session: Session) -> Course[Found]:
    bounds = replace(session.acceptance, saturated_ratio=1.0)
    return Course(
        "probe",
        plan,
        model.travel_mm,
        lambda press, _pace_ratio: judge(press, model.travel_mm, bounds, true_position=True),
        bounds.patience,
        lambda found: _standings(model, plan, found),
    )


def _all_curves(model: FDVVModel, plan: ProbePlan, found: Found) -> list[ProbeCurve]:
    pairs = zip(plan.velocities_mm_s, found, strict=True)
    curves = [curve for speed, presses in pairs if presses for curve in judged_curves(model, speed, presses)]
    return sorted(curves, key=reading_order)


def _standings(model: FDVVModel, plan: ProbePlan, found: Found) -> tuple[Standing, ...]:
    curves = [curve.outcome for curve in _all_curves(model, plan, found)]
    return tuple(
        Standing(speed, len(made), plan.presses, tuple(c for c in curves if c.velocity_mm_s == speed))
        for speed, made in zip(plan.velocities_mm_s, found, strict=True)
    )


def _result(
    device: Device,
    model: FDVVModel,
    method: str,
    curves: Sequence[ProbeCurve],
    log: PressLog,
    manifest: Manifest,
) -> ProbeResult:
    info = device.info()
    return ProbeResult(
        method,
        model.name,
        info.name,
        (FROM_mm, model.travel_mm - STOP_GUARD_mm),
        tuple(curves),
        len(log.entries),
        tuple(str(entry) for entry in log.entries if not entry.used),
        info.simulated,
        make_receipt(manifest, log.runs, log.entries, [curve.outcome for curve in curves]),
    )

"""Evaluation of a rendering: fresh presses, errors in true displacement."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fdvv.compensation.method import UNTUNED, CurveOutcome, PressCount, Trial, Tuning, error_cN
from fdvv.compensation.presses import FROM_mm, STOP_GUARD_mm, judge_press, mean_speed_mm_s, split_strokes
from fdvv.compensation.tables import bin_force, grid_mm
from fdvv.device.contract import Device
from fdvv.errors import ModelError
from fdvv.model.curve import Stroke, reading_order
from fdvv.model.model import FDVVModel
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.rendering.compensate import check_force_sensor, check_speeds
from fdvv.rendering.run_summary import RunSummary, write_run_summary
from fdvv.rendering.session import Session, table_digest
from fdvv.rendering.session_log import PressLog
from fdvv.rendering.session_run import Guide, Progress, SessionPlan, VelocityProgress, run
from fdvv.units import FloatArray

Found = tuple[tuple[Press, ...], ...]
"""Presses of every velocity, in the order of the plan."""


@dataclass(frozen=True, eq=False)
class ProbePlan:
    """So many presses of one surface under one tuning at every velocity, one velocity after the other."""

    surface: ForceSurface
    velocities_mm_s: tuple[float, ...]
    presses: int
    tuning: Tuning = UNTUNED

    def init(self) -> Found:
        return ((),) * len(self.velocities_mm_s)

    def trial(self, found: Found) -> Trial | None:
        """Return the first velocity that lacks presses; None when none does."""
        at = self._at(found)
        return None if at is None else Trial(self.surface, self.velocities_mm_s[at], self.tuning)

    def step(self, press: Press, found: Found) -> Found:
        """Add a press to those of the velocity that was asked for. ModelError if none was."""
        at = self._at(found)
        if at is None:
            raise ModelError("the probe is finished; no press was asked for")
        return (*found[:at], (*found[at], press), *found[at + 1 :])

    def count(self, found: Found) -> PressCount:
        wanted = (self.presses,) * len(self.velocities_mm_s)
        return PressCount(sum(map(len, found)), sum(wanted), wanted)

    def explain(self, found: Found) -> str:
        return ""

    def _at(self, found: Found) -> int | None:
        return next((i for i, presses in enumerate(found) if len(presses) < self.presses), None)


BIN_mm = 0.05
ALPHA = 0.7
"""Weight of eq. 3, so that the probe's error_k reads like the paper's."""


@dataclass(frozen=True, eq=False)
class ProbeCurve:
    """One stroke at one velocity over several fresh presses.

    Attributes
    ----------
    displacement_mm, target_cN : (n,) bins judged, and what the model asks for at the asked speed.
    rendered_cN : (presses, n) force on the finger; 0 in bins the cap did not reach, where there was none.
    achieved_mm_s : (presses,) mean speed of each stroke.
    at_achieved_cN : (presses, n) what the model asks for at the achieved speed.
    reached_ratio : part of the bins that the cap reached, of the worst press.
    """

    stroke: Stroke
    velocity_mm_s: float
    displacement_mm: FloatArray
    target_cN: FloatArray
    rendered_cN: FloatArray
    achieved_mm_s: FloatArray
    at_achieved_cN: FloatArray
    reached_ratio: float

    @property
    def error_cN(self) -> FloatArray:
        """error_k (eq. 3) of each press, (presses,)."""
        return np.array([error_cN(self.target_cN, row, ALPHA) for row in self.rendered_cN])

    @property
    def mean_errors_cN(self) -> FloatArray:
        """Mean of |target - rendered| over the bins, (presses,)."""
        return np.asarray(np.abs(self.target_cN - self.rendered_cN).mean(axis=1))

    @property
    def max_errors_cN(self) -> FloatArray:
        """Largest |target - rendered|, (presses,)."""
        return np.asarray(np.abs(self.target_cN - self.rendered_cN).max(axis=1))

    def to_dict(self) -> dict[str, Any]:
        """Return medians over the presses with quartiles as spread, and the three quartiles of the force."""
        achieved = np.abs(self.at_achieved_cN - self.rendered_cN).mean(axis=1)
        return {
            "stroke": str(self.stroke),
            "velocity_mm_s": self.velocity_mm_s,
            "error_cN": self.error_cN.tolist(),
            "mean_error_cN": float(np.median(self.mean_errors_cN)),
            "max_error_cN": float(np.median(self.max_errors_cN)),
            "mean_error_quartiles_cN": np.percentile(self.mean_errors_cN, [25, 75]).tolist(),
            "max_error_quartiles_cN": np.percentile(self.max_errors_cN, [25, 75]).tolist(),
            "mean_error_at_achieved_speed_cN": float(np.median(achieved)),
            "achieved_mm_s": float(np.median(self.achieved_mm_s)),
            "reached_ratio": self.reached_ratio,
            "displacement_mm": self.displacement_mm.tolist(),
            "target_cN": self.target_cN.tolist(),
            "rendered_quartiles_cN": np.percentile(self.rendered_cN, [25, 50, 75], axis=0).tolist(),
        }

    @property
    def outcome(self) -> CurveOutcome:
        """error_k of the presses and the medians of their mean and largest errors."""
        medians = float(np.median(self.mean_errors_cN)), float(np.median(self.max_errors_cN))
        return CurveOutcome(self.stroke, self.velocity_mm_s, tuple(self.error_cN.tolist()), *medians, "")


def judged_curves(model: FDVVModel, velocity_mm_s: float, presses: Sequence[Press]) -> list[ProbeCurve]:
    grid = grid_mm(model.travel_mm, BIN_mm)
    # a bin at the very edge counts, however its centre was rounded
    judged = (grid >= FROM_mm - 1e-9) & (grid <= model.travel_mm - STOP_GUARD_mm + 1e-9)
    x, curves = grid[judged], []
    spans = [split_strokes(press.displacement_mm, model.travel_mm) for press in presses]
    for i, stroke in enumerate(Stroke):
        forces, speeds = [], []
        for press, strokes in zip(presses, spans, strict=True):
            rows = strokes[i]
            forces.append(bin_force(press.displacement_mm[rows], press.force_cN[rows], grid)[judged])
            speeds.append(mean_speed_mm_s(press.t_s, press.displacement_mm, rows))
        rendered, achieved = np.stack(forces), np.array(speeds)
        # without a release curve the press serves for both
        served = stroke if model.of(stroke) else Stroke.PRESS
        paces = np.nan_to_num(achieved, nan=velocity_mm_s)[:, None]
        curves.append(
            ProbeCurve(
                stroke,
                velocity_mm_s,
                x,
                model.force_cN(x, velocity_mm_s, served),
                np.nan_to_num(rendered, nan=0.0),
                achieved,
                model.force_cN(x[np.newaxis], paces, served),
                float(np.isfinite(rendered).mean(axis=1).min()),
            )
        )
    return curves


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
    receipt: RunSummary

    def to_dict(self) -> dict[str, Any]:
        """Return the report; errors in cN, true displacement, median over presses."""
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
    """Upload a surface once, press it afresh at every speed, and compare the rendered force with the model.

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
        settings["tuning"] = tuning.to_dict()
    manifest = session.manifest("probe", device, model, plan.velocities_mm_s, method, settings)
    # a rig at its limit is part of what is judged
    bounds = replace(session.acceptance, saturated_ratio=1.0)
    session_plan = SessionPlan(
        "probe",
        plan,
        model.travel_mm,
        lambda press, _pace_ratio: judge_press(press, model.travel_mm, bounds, true_position=True),
        bounds.patience,
        lambda found: _standings(model, plan, found),
        progress or (lambda _done: None),
        guide or Guide(),
    )
    with session.open_log(manifest, PressLog) as log:
        found = run(device, session_plan, plan.init(), log)
        curves = _all_curves(model, plan, found)
        outcomes = [curve.outcome for curve in curves]
        receipt = write_run_summary(session.folder, manifest, log.runs, log.entries, outcomes)
        skipped = tuple(str(entry) for entry in log.entries if not entry.used)
    info, range_mm = device.info(), (FROM_mm, model.travel_mm - STOP_GUARD_mm)
    presses, names = len(log.entries), (method, model.name, info.name)
    return ProbeResult(*names, range_mm, tuple(curves), presses, skipped, info.simulated, receipt)


def _all_curves(model: FDVVModel, plan: ProbePlan, found: Found) -> list[ProbeCurve]:
    pairs = zip(plan.velocities_mm_s, found, strict=True)
    curves = [curve for speed, presses in pairs if presses for curve in judged_curves(model, speed, presses)]
    return sorted(curves, key=reading_order)


def _standings(model: FDVVModel, plan: ProbePlan, found: Found) -> tuple[VelocityProgress, ...]:
    curves = [curve.outcome for curve in _all_curves(model, plan, found)]
    return tuple(
        VelocityProgress(speed, len(made), plan.presses, tuple(c for c in curves if c.velocity_mm_s == speed))
        for speed, made in zip(plan.velocities_mm_s, found, strict=True)
    )

"""Feasibility of a button on an identified rig: intended, achievable and measured force."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fdvv.compensation.feasibility.limits import (
    AchievableStroke,
    Motion,
    RigLimits,
    achievable_stroke,
    minimum_jerk,
    needed_cN,
)
from fdvv.compensation.feasibility.stability import NominalFinger, Stability, stability
from fdvv.compensation.feasibility.thermal import ThermalDose, thermal_dose
from fdvv.compensation.feasibility.verdict import ExpectedError, FollowVerdict, expected_error, follow_verdict
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.device.contract import DeviceInfo
from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.protocol.tables import Settings
from fdvv.rendering.compensate import check_speeds
from fdvv.rendering.probe import ProbeCurve, ProbeResult
from fdvv.report.records import FeasibleCurve, RenderedBand
from fdvv.units import FloatArray

STEP_mm = 0.01


@dataclass(frozen=True, eq=False)
class CurveFeasibility:
    """One stroke at one velocity.

    Attributes
    ----------
    verdict : whether the rig follows, and the reasons why not.
    reached : intended and achievable force over the travel, and the command it takes.
    stable : margins of the sampled loop.
    expected : the error that learning would leave, an estimate.
    measured : what presses showed, if there are any.
    """

    stroke: Stroke
    velocity_mm_s: float
    verdict: FollowVerdict
    reached: AchievableStroke
    stable: Stability
    expected: ExpectedError
    measured: ProbeCurve | None

    def to_dict(self) -> dict[str, Any]:
        reached, measured = self.reached, self.measured
        columns = ("displacement_mm", "intended_cN", "achievable_cN", "command_cN")
        return {
            "stroke": str(self.stroke),
            "velocity_mm_s": self.velocity_mm_s,
            "verdict": str(self.verdict.following),
            "reasons": list(self.verdict.reasons),
            "largest_command_cN": float(np.abs(reached.command_cN).max()),
            "saturated_ratio": float(reached.saturated.mean()),
            "slewed_ratio": float(reached.slewed.mean()),
            "lag_mm": reached.lag_mm,
            "bump_drop_cN": reached.drop_cN,
            "bump_kept_ratio": reached.kept_ratio,
            "stability": self.stable.to_dict(),
            "expected_error": self.expected.to_dict(),
            **{name: getattr(reached, name).tolist() for name in columns},
            "measured": None if measured is None else measured.to_dict(),
        }


@dataclass(frozen=True, eq=False)
class FeasibilityReport:
    """What an identified rig can render of a button. All but ``measured`` is computed, without a press.

    Attributes
    ----------
    curves : by stroke, then by speed.
    doses : of warmth, one per speed.
    rig_presses : that the rig was identified from. simulated : the measured presses come from the twin.
    """

    model_name: str
    travel_mm: float
    velocity_mm_s: tuple[float, ...]
    curves: tuple[CurveFeasibility, ...]
    doses: tuple[ThermalDose, ...]
    rig_presses: int
    device_name: str
    simulated: bool

    def to_dict(self) -> dict[str, Any]:
        """Return the report of ``fdvv feasible --json``."""
        warmth = zip(self.velocity_mm_s, self.doses, strict=True)
        return {
            "model": self.model_name,
            "device": self.device_name,
            "simulated": self.simulated,
            "travel_mm": self.travel_mm,
            "rig_presses": self.rig_presses,
            "curves": [curve.to_dict() for curve in self.curves],
            "thermal": [{"velocity_mm_s": v, **dose.to_dict()} for v, dose in warmth],
        }

    def to_json(self) -> str:
        return json.dumps(self.to_dict(), indent=2, allow_nan=False)


def feasible_curves(report: FeasibilityReport) -> list[FeasibleCurve]:
    """Return the curves for fdvv.report; a measured band is the quartiles of the presses."""
    return [_drawn(curve, report.simulated) for curve in report.curves]


def _drawn(curve: CurveFeasibility, simulated: bool) -> FeasibleCurve:
    reached, found, band = curve.reached, curve.measured, None
    if found is not None:
        low, middle, high = np.percentile(found.rendered_cN, [25, 50, 75], axis=0)
        band = RenderedBand("measured", middle, low, high)
    return FeasibleCurve(
        curve.stroke,
        curve.velocity_mm_s,
        reached.displacement_mm,
        reached.intended_cN,
        reached.achievable_cN,
        reached.saturated | reached.slewed,
        str(curve.verdict),
        None if found is None else found.displacement_mm,
        band,
        simulated and found is not None,
    )


def feasibility(
    model: FDVVModel,
    known: RigModel,
    settings: Settings,
    velocities_mm_s: Sequence[float],
    measured: ProbeResult | None = None,
    info: DeviceInfo | None = None,
    finger: NominalFinger | None = None,
    motions: Mapping[tuple[Stroke, float], Motion] | None = None,
) -> FeasibilityReport:
    """Decide for every stroke and speed whether a rig can render a model, and why not.

    known : as identified from presses (fdvv.compensation.identification.identify.identify), or load_rig
    of its file.
    settings : of the device (Device.settings). info : its name and deepest stop.
    measured : presses of a probe at some of these speeds. finger : who holds the cap still.
    motions : how the cap really goes, by stroke and speed, where that is known; else minimum jerk.
    Raises InputError on speeds that cannot be, ModelError on a rig that cannot be or a model without a press.
    """
    speeds = check_speeds(velocities_mm_s)
    if not model.of(Stroke.PRESS):
        raise ModelError(f"{model.name}: it has no press curve; merge one into it")
    limits = RigLimits.of_settings(settings)
    case = _Case(model, known, limits, measured, info, finger, motions or {})
    rows = [_at_speed(case, speed) for speed in speeds]
    doses = tuple(dose for dose, _ in rows)
    curves = tuple(curves[i] for i in range(len(Stroke)) for _, curves in rows)
    simulated = bool(info and info.simulated) or bool(measured and measured.simulated)
    name = info.name if info else "rig"
    return FeasibilityReport(
        model.name, model.travel_mm, tuple(speeds), curves, doses, known.presses, name, simulated
    )


@dataclass(frozen=True, eq=False)
class _Case:
    """Everything that is common to all speeds."""

    model: FDVVModel
    known: RigModel
    limits: RigLimits
    measured: ProbeResult | None
    info: DeviceInfo | None
    finger: NominalFinger | None
    motions: Mapping[tuple[Stroke, float], Motion]

    def motion(self, stroke: Stroke, speed_mm_s: float) -> Motion:
        known = self.motions.get((stroke, speed_mm_s))
        return known or minimum_jerk(stroke, self.model.travel_mm, speed_mm_s, self.limits.tick_s)


def _at_speed(case: _Case, speed_mm_s: float) -> tuple[ThermalDose, list[CurveFeasibility]]:
    travel_mm = case.model.travel_mm
    x = np.linspace(0.0, travel_mm, 1 + max(2, round(travel_mm / STEP_mm)))
    forces = _forces(case.model, x, speed_mm_s)
    motions = [case.motion(stroke, speed_mm_s) for stroke in Stroke]
    dose = _dose(case.known, case.limits, x, forces, motions)
    curves = []
    for stroke, force, motion in zip(Stroke, forces, motions, strict=True):
        reached = achievable_stroke(case.known, case.limits, motion, x, force)
        # the step between the strokes is reported once, with the release
        over = forces[0] if stroke is Stroke.RELEASE else None
        stable = stability(case.known, case.limits, x, force, over, case.finger)
        stop_mm = case.info.travel_limit_mm if case.info else None
        verdict = follow_verdict(reached, case.limits, stable, dose, stop_mm)
        expected = expected_error(case.known, reached, motion, speed_mm_s)
        found = _measured(case.measured, stroke, speed_mm_s)
        curves.append(CurveFeasibility(stroke, speed_mm_s, verdict, reached, stable, expected, found))
    return dose, curves


def _forces(model: FDVVModel, x: FloatArray, speed_mm_s: float) -> list[FloatArray]:
    """Return press and release; without a release curve the press serves for both."""
    served = [stroke if model.of(stroke) else Stroke.PRESS for stroke in Stroke]
    return [model.force_cN(x, speed_mm_s, stroke) for stroke in served]


def _dose(
    known: RigModel, limits: RigLimits, x: FloatArray, forces: list[FloatArray], motions: list[Motion]
) -> ThermalDose:
    along = [
        needed_cN(known, motion, np.interp(motion.displacement_mm, x, force))
        for motion, force in zip(motions, forces, strict=True)
    ]
    # nothing moves before a press: no friction, drag or inertia counts
    rest = (float(forces[0][0]) + known.weight_cN) / float(known.gain_at(np.array(0.0)))
    return thermal_dose(limits, along[0], along[1], float(motions[0].t_s[-1]), rest)


def _measured(measured: ProbeResult | None, stroke: Stroke, speed_mm_s: float) -> ProbeCurve | None:
    curves = measured.curves if measured else ()
    return next((c for c in curves if c.stroke is stroke and c.velocity_mm_s == speed_mm_s), None)

"""Feasibility of a button on an identified rig: intended, achievable and measured force."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from fdvv.compensation.feasibility.limits import (
    AchievableStroke,
    Motion,
    RigLimits,
    achievable_stroke,
    inverse_dynamics_cN,
    minimum_jerk,
)
from fdvv.compensation.feasibility.stability import NominalFinger, Stability, stability
from fdvv.compensation.feasibility.thermal import ThermalDose, thermal_dose
from fdvv.compensation.feasibility.verdict import ExpectedError, FollowVerdict, estimate_error, follow_verdict
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.device.contract import DeviceInfo
from fdvv.errors import ModelError
from fdvv.model.curve import Stroke, reading_order
from fdvv.model.model import FDVVModel
from fdvv.protocol.tables import Settings
from fdvv.rendering.compensate import check_speeds
from fdvv.rendering.evaluation.probe_curve import ProbeCurve
from fdvv.rendering.probe import ProbeResult
from fdvv.report.records import FeasibleCurve, RenderedBand
from fdvv.units import FloatArray

STEP_mm = 0.01  # a fifth of the 50 um over which the steepest rise is taken (docs/explanation/feasibility.md)


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
            "expected_error": asdict(self.expected),
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
            "thermal": [{"velocity_mm_s": v, **asdict(dose)} for v, dose in warmth],
        }


def feasible_curves(report: FeasibilityReport) -> list[FeasibleCurve]:
    """Return the curves for fdvv.report; a measured band is the quartiles of the presses."""
    drawn = []
    for curve in report.curves:
        reached = curve.reached
        measured: dict[str, Any] = {}
        if probe := curve.measured:
            low, middle, high = np.percentile(probe.rendered_cN, [25, 50, 75], axis=0)
            measured = {"band_mm": probe.displacement_mm, "band": RenderedBand("measured", middle, low, high)}
        columns = reached.displacement_mm, reached.intended_cN, reached.achievable_cN
        cut, text = reached.saturated | reached.slewed, str(curve.verdict)
        simulated = report.simulated and bool(measured)
        place = curve.stroke, curve.velocity_mm_s
        drawn.append(FeasibleCurve(*place, *columns, cut, text, **measured, simulated=simulated))
    return drawn


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
    limits, made = RigLimits.of_settings(settings), motions or {}
    stop_mm = info.travel_limit_mm if info else None
    x = np.linspace(0.0, model.travel_mm, 1 + max(2, round(model.travel_mm / STEP_mm)))
    doses, curves = [], []
    for speed in speeds:
        # without a release curve the press serves for both
        forces = [model.force_cN(x, speed, stroke if model.of(stroke) else Stroke.PRESS) for stroke in Stroke]
        paths = [
            made.get((stroke, speed)) or minimum_jerk(stroke, model.travel_mm, speed, limits.tick_s)
            for stroke in Stroke
        ]
        doses.append(_dose(known, limits, x, forces, paths))
        for stroke, force, motion in zip(Stroke, forces, paths, strict=True):
            reached = achievable_stroke(known, limits, motion, x, force)
            # the step between the strokes is reported once, with the release
            over = forces[0] if stroke is Stroke.RELEASE else None
            stable = stability(known, limits, x, force, over, finger)
            verdict = follow_verdict(reached, limits, stable, doses[-1], stop_mm)
            expected = estimate_error(known, reached, motion, speed)
            seen = _probe_curve(measured, stroke, speed)
            curves.append(CurveFeasibility(stroke, speed, verdict, reached, stable, expected, seen))
    return FeasibilityReport(
        model.name,
        model.travel_mm,
        tuple(speeds),
        tuple(sorted(curves, key=reading_order)),
        tuple(doses),
        known.presses,
        info.name if info else "rig",
        bool(info and info.simulated) or bool(measured and measured.simulated),
    )


def _dose(
    known: RigModel, limits: RigLimits, x: FloatArray, forces: list[FloatArray], motions: list[Motion]
) -> ThermalDose:
    along = [
        inverse_dynamics_cN(known, motion, np.interp(motion.displacement_mm, x, force))
        for motion, force in zip(motions, forces, strict=True)
    ]
    # nothing moves before a press: no friction, drag or inertia counts
    top = np.array(0.0)
    rest = (float(forces[0][0]) - float(known.own_at(top))) / float(known.gain_at(top))
    return thermal_dose(limits, along[0], along[1], float(motions[0].t_s[-1]), rest)


def _probe_curve(measured: ProbeResult | None, stroke: Stroke, speed_mm_s: float) -> ProbeCurve | None:
    curves = measured.curves if measured else ()
    return next((c for c in curves if c.stroke is stroke and c.velocity_mm_s == speed_mm_s), None)

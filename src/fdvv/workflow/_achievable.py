"""What a rig makes of the curves that are being edited, fast enough to follow the hand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from fdvv.compensate import Motion, minimum_jerk
from fdvv.model import FDVVModel, Stroke
from fdvv.units import FloatArray
from fdvv.workflow._feasibility import CurveFeasibility, feasibility
from fdvv.workflow._rig_shelf import RigOnShelf

Limit = Literal["force", "slew"]
UNTOLD_mm_s = 50.0
"""The speed that a curve of unknown velocity is judged at."""
POINTS = 201
"""Places that are told of a curve: 0.02 mm on a button of 4 mm."""
STEPS, STEPS_A_TICK = 2500, 8
"""Most steps of time of a stroke; a report takes eight a tick, which at a bench's pace follows no hand."""


@dataclass(frozen=True)
class LimitedRange:
    """Where a limit cuts: from start to end, mm; limit is "force" (or duty) or "slew"."""

    start_mm: float
    end_mm: float
    limit: Limit


@dataclass(frozen=True, eq=False)
class AchievableCurve:
    """One stroke at one speed, computed: no press was made.

    Attributes
    ----------
    displacement_mm, intended_cN, achievable_cN : (n,) on the same places.
    limited : where force, duty or slew limits cut.
    verdict, reasons : whether the rig follows; per reason one line, the gravest first.
    expected_mean_cN : mean error that learning would leave, an estimate.
    """

    stroke: Stroke
    velocity_mm_s: float
    displacement_mm: FloatArray
    intended_cN: FloatArray
    achievable_cN: FloatArray
    limited: tuple[LimitedRange, ...]
    verdict: str
    reasons: tuple[str, ...]
    expected_mean_cN: float


def achievable(
    model: FDVVModel, rig: RigOnShelf, velocities_mm_s: Sequence[float | None]
) -> tuple[AchievableCurve, ...]:
    """Tell what a rig makes of both strokes of a model at these speeds, some ten milliseconds a speed.

    velocities_mm_s : of the curves touched; None, a curve of unknown velocity, is judged at 50 mm/s.
    Raises InputError on speeds that cannot be, ModelError on a model without a press curve.
    """
    speeds = list(dict.fromkeys(UNTOLD_mm_s if v is None else float(v) for v in velocities_mm_s))
    motions = {(stroke, v): _motion(stroke, model, rig, v) for stroke in Stroke for v in speeds}
    report = feasibility(model, rig.known, rig.settings, speeds, info=rig.info, motions=motions)
    return tuple(_told(curve) for curve in report.curves)


def _motion(stroke: Stroke, model: FDVVModel, rig: RigOnShelf, velocity_mm_s: float) -> Motion:
    """Plan a stroke as a report does, in fewer steps where it is slow."""
    coarse_s = STEPS_A_TICK * model.travel_mm / velocity_mm_s / STEPS
    return minimum_jerk(stroke, model.travel_mm, velocity_mm_s, max(1e-6 * rig.settings.tick_us, coarse_s))


def _told(curve: CurveFeasibility) -> AchievableCurve:
    reached = curve.reached
    x = reached.displacement_mm
    places = np.linspace(x[0], x[-1], min(POINTS, x.size))
    return AchievableCurve(
        curve.stroke,
        curve.velocity_mm_s,
        places,
        np.interp(places, x, reached.intended_cN),
        np.interp(places, x, reached.achievable_cN),
        (*_ranges(x, reached.saturated, "force"), *_ranges(x, reached.slewed, "slew")),
        str(curve.verdict.following),
        curve.verdict.reasons,
        curve.expected.mean_cN,
    )


def _ranges(x: FloatArray, rows: npt.NDArray[np.bool_], limit: Limit) -> list[LimitedRange]:
    """Give the ranges of x, (n,), over which rows, (n,), hold."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], rows, [False]]).astype(np.int8)))
    return [LimitedRange(float(x[a]), float(x[b - 1]), limit) for a, b in edges.reshape(-1, 2)]

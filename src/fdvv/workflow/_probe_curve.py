"""What the presses of a probe say about one curve: errors in true displacement."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fdvv.compensate import (
    CurveOutcome,
    FROM_mm,
    STOP_GUARD_mm,
    bin_force,
    error_cN,
    grid_mm,
    mean_speed_mm_s,
    split_strokes,
)
from fdvv.model import FDVVModel, Press, Stroke
from fdvv.units import FloatArray

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
        """Give error_k (eq. 3) of each press, (presses,)."""
        return np.array([error_cN(self.target_cN, row, ALPHA) for row in self.rendered_cN])

    @property
    def mean_errors_cN(self) -> FloatArray:
        """Give the mean of |target - rendered| over the bins, (presses,)."""
        return np.asarray(np.abs(self.target_cN - self.rendered_cN).mean(axis=1))

    @property
    def max_errors_cN(self) -> FloatArray:
        """Give the largest |target - rendered|, (presses,)."""
        return np.asarray(np.abs(self.target_cN - self.rendered_cN).max(axis=1))

    def to_dict(self) -> dict[str, Any]:
        """Give medians over the presses with quartiles as spread, and the three quartiles of the force."""
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
        """Give error_k of the presses and the medians of their mean and largest errors."""
        medians = float(np.median(self.mean_errors_cN)), float(np.median(self.max_errors_cN))
        return CurveOutcome(self.stroke, self.velocity_mm_s, tuple(self.error_cN.tolist()), *medians, "")


def judged_curves(model: FDVVModel, velocity_mm_s: float, presses: Sequence[Press]) -> list[ProbeCurve]:
    """Judge both strokes of the presses at one speed."""
    grid = grid_mm(model.travel_mm, BIN_mm)
    judged = (grid >= FROM_mm - 1e-9) & (grid <= model.travel_mm - STOP_GUARD_mm + 1e-9)
    curves = []
    spans = [split_strokes(press.displacement_mm, model.travel_mm) for press in presses]
    for i, stroke in enumerate(Stroke):
        rows, speeds = [], []
        for press, strokes in zip(presses, spans, strict=True):
            span = strokes[i]
            felt = bin_force(press.displacement_mm[span.rows], press.force_cN[span.rows], grid)
            rows.append(felt[judged])
            speeds.append(mean_speed_mm_s(press.t_s, press.displacement_mm, span))
        felt_rows, achieved = np.stack(rows), np.array(speeds)
        served = stroke if model.of(stroke) else Stroke.PRESS
        x = grid[judged]
        curves.append(
            ProbeCurve(
                stroke,
                velocity_mm_s,
                x,
                model.force_cN(x, velocity_mm_s, served),
                np.nan_to_num(felt_rows, nan=0.0),
                achieved,
                model.force_cN(x[np.newaxis], np.nan_to_num(achieved, nan=velocity_mm_s)[:, None], served),
                float(np.isfinite(felt_rows).mean(axis=1).min()),
            )
        )
    return curves

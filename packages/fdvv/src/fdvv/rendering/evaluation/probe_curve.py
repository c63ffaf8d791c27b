"""One stroke at one velocity, as fresh presses rendered it: force over displacement, vibration, JNDs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from fdvv.compensation.method import CurveOutcome, error_cN
from fdvv.compensation.presses import FROM_mm, STOP_GUARD_mm, mean_speed_mm_s, split_strokes
from fdvv.compensation.tables import bin_force, grid_mm
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.model.noticeable import LITERATURE, Jnds
from fdvv.model.press import Press
from fdvv.rendering.evaluation.noticed import Noticed, summarize
from fdvv.rendering.evaluation.vibration_presses import (
    NONE_ASKED,
    RenderedVibration,
    judge_vibration,
    shows_vibration,
)
from fdvv.units import FloatArray
from fdvv.vibration.compare import RATE_Hz, ripple_rms

BIN_mm = 0.05
FEWEST_rows = 40
"""Of a record, without which nothing shows whether the force shakes."""
ENTRY_mm = 0.6
"""Up to here the press begins, where a rig has had little time; reported apart from the rest."""
ALPHA = 0.7
"""Weight of eq. 3, so that the probe's error_k reads like the paper's."""


@dataclass(frozen=True, eq=False)
class ProbeCurve:
    """One stroke at one velocity over several fresh presses.

    Attributes
    ----------
    displacement_mm, target_cN : (n,) bins judged, and what the model asks for at the asked speed.
    rendered_cN : (presses, n) force on the finger; 0 in bins that the press did not reach. Above the place
        where the cap rests under the finger it is what the finger rests with, if the target is not less: a
        button gives way to that too.
    achieved_mm_s : (presses,) mean speed of each stroke.
    at_achieved_cN : (presses, n) what the model asks for at the achieved speed.
    reached_ratio : part of the bins that the cap reached, of the worst press.
    ripple_cN : rms from 40 to 800 Hz of the force's error over time, median over presses: what shakes and
        nobody asked for; None if it was not measured.
    vibration : what became of the vibration.
    jnds : what a finger notices, by which errors are judged.
    """

    stroke: Stroke
    velocity_mm_s: float
    displacement_mm: FloatArray
    target_cN: FloatArray
    rendered_cN: FloatArray
    achieved_mm_s: FloatArray
    at_achieved_cN: FloatArray
    reached_ratio: float
    ripple_cN: float | None = None
    vibration: RenderedVibration = NONE_ASKED
    jnds: Jnds = LITERATURE

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

    @cached_property
    def force_JND(self) -> FloatArray:
        """Error of the force in JNDs of the target, (presses, n)."""
        return np.asarray(np.abs(self.rendered_cN - self.target_cN) / self.jnds.force_cN(self.target_cN))

    @cached_property
    def own_speed_JND(self) -> FloatArray:
        """The same against what the model asks for at the speed that each press had, (presses, n)."""
        error_cN = np.abs(self.rendered_cN - self.at_achieved_cN)
        return np.asarray(error_cN / self.jnds.force_cN(self.at_achieved_cN))

    @cached_property
    def total_JND(self) -> FloatArray:
        """Error of force and vibration, (presses, n): squares add up where the vibration should be felt."""
        asked = self.vibration.asked
        if asked is None:
            return self.force_JND
        length_mm = asked.duration_s * self.velocity_mm_s
        start_mm = asked.onset_mm if self.stroke is Stroke.PRESS else asked.onset_mm - length_mm
        x = self.displacement_mm
        felt = (x >= start_mm) & (x <= start_mm + length_mm)
        return np.asarray(np.hypot(self.force_JND, np.where(felt, self.vibration.total_JND, 0.0)))

    @property
    def total(self) -> Noticed:
        return summarize(self.total_JND)

    def noticeable(self) -> dict[str, Any]:
        """Return what a finger could notice of this curve, for a file."""
        entry = self.displacement_mm <= ENTRY_mm + 1e-9
        return {
            "total": self.total.to_dict(),
            "force": summarize(self.force_JND).to_dict(),
            "force_at_achieved_speed": summarize(self.own_speed_JND).to_dict(),
            "force_to_entry": summarize(self.force_JND[:, entry]).to_dict(),
            "force_beyond_entry": summarize(self.force_JND[:, ~entry]).to_dict(),
            "entry_mm": ENTRY_mm,
            "jnd_cN": self.jnds.force_cN(self.target_cN).tolist(),
            "noticed_ratio": (self.total_JND > 1).mean(axis=0).tolist(),
        }

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
            "force_ripple_cN": self.ripple_cN,
            "noticeable": self.noticeable(),
            "vibration": self.vibration.to_dict(),
        }

    @property
    def outcome(self) -> CurveOutcome:
        """error_k of the presses and the medians of their mean and largest errors."""
        medians = float(np.median(self.mean_errors_cN)), float(np.median(self.max_errors_cN))
        return CurveOutcome(self.stroke, self.velocity_mm_s, tuple(self.error_cN.tolist()), *medians, "")


def with_vibrations(
    model: FDVVModel, curves: Sequence[ProbeCurve], silent: Sequence[Press], vibrating: Sequence[Press]
) -> list[ProbeCurve]:
    """Return the curves of one velocity with what became of their vibrations, and with the force's ripple.

    silent, vibrating : presses without the vibrations and with them; none of the latter if none was played.
    """
    return [
        replace(
            c,
            ripple_cN=_ripple_cN(model, c, silent),
            vibration=judge_vibration(model, c.stroke, c.velocity_mm_s, silent, vibrating, c.jnds),
        )
        for c in curves
    ]


def judge_curves(
    model: FDVVModel, velocity_mm_s: float, presses: Sequence[Press], jnds: Jnds = LITERATURE
) -> list[ProbeCurve]:
    """Judge the force of both strokes of the presses of one velocity; jnds : what a finger notices."""
    grid = grid_mm(model.travel_mm, BIN_mm)
    # a bin at the very edge counts, however its centre was rounded
    judged = (grid >= FROM_mm - 1e-9) & (grid <= model.travel_mm - STOP_GUARD_mm + 1e-9)
    x, curves = grid[judged], []
    spans = [split_strokes(press.displacement_mm, model.travel_mm) for press in presses]
    for i, stroke in enumerate(Stroke):
        forces, resting, speeds = [], [], []
        served = _stroke_of_model(model, stroke)
        target = model.force_cN(x, velocity_mm_s, served)
        for press, strokes in zip(presses, spans, strict=True):
            rows = strokes[i]
            forces.append(bin_force(press.displacement_mm[rows], press.force_cN[rows], grid)[judged])
            rests_cN = press.force_cN[0 if stroke is Stroke.PRESS else -1]
            resting.append(_resting_cN(forces[-1], target, float(rests_cN)))
            speeds.append(mean_speed_mm_s(press.t_s, press.displacement_mm, rows))
        rendered, achieved = np.stack(forces), np.array(speeds)
        paces = np.nan_to_num(achieved, nan=velocity_mm_s)[:, None]
        curves.append(
            ProbeCurve(
                stroke,
                velocity_mm_s,
                x,
                target,
                np.nan_to_num(np.stack(resting), nan=0.0),
                achieved,
                model.force_cN(x[np.newaxis], paces, served),
                float(np.isfinite(rendered).mean(axis=1).min()),
                jnds=jnds,
            )
        )
    return curves


def _resting_cN(rendered_cN: FloatArray, target_cN: FloatArray, rests_cN: float) -> FloatArray:
    """Return the force in each bin, (n,), with that of the resting finger above where the cap rests.

    rendered_cN : NaN in bins that were not visited. rests_cN : before a press, and after a release.
    """
    above = np.cumsum(np.isfinite(rendered_cN)) == 0
    if above.all():
        return rendered_cN
    return np.where(above, np.clip(rests_cN, 0.0, target_cN), rendered_cN)


def _stroke_of_model(model: FDVVModel, stroke: Stroke) -> Stroke:
    """Return the stroke whose curve is rendered: without a release curve the press serves for both."""
    return stroke if model.of(stroke) else Stroke.PRESS


def _ripple_cN(model: FDVVModel, curve: ProbeCurve, presses: Sequence[Press]) -> float | None:
    """Return the median over presses of what shakes in the force; None if a record is too coarse for that."""
    if not all(map(shows_vibration, presses)):
        return None
    ripples = []
    for press in presses:
        rows = split_strokes(press.displacement_mm, model.travel_mm)[list(Stroke).index(curve.stroke)]
        t_s, x_mm = press.t_s[rows], press.displacement_mm[rows]
        judged = (x_mm >= FROM_mm) & (x_mm <= model.travel_mm - STOP_GUARD_mm)
        if judged.sum() < FEWEST_rows:
            return None
        target_cN = model.force_cN(x_mm[judged], curve.velocity_mm_s, _stroke_of_model(model, curve.stroke))
        even_s = np.arange(t_s[judged][0], t_s[judged][-1], 1 / RATE_Hz)
        error_cN = press.force_cN[rows][judged] - target_cN
        ripples.append(ripple_rms(np.interp(even_s, t_s[judged], error_cN)))
    return float(np.median(ripples))

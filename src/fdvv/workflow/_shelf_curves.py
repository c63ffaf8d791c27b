"""The curves of a button as a page draws them: sampled evenly, every stroke and speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.model import FDVVModel, Stroke
from fdvv.units import FloatArray

STEP_mm = 0.01
MOST_points = 2000


@dataclass(frozen=True, eq=False)
class SampledStroke:
    """Force of one stroke at one speed.

    Attributes
    ----------
    velocity_mm_s : None if the source tells none.
    start_mm, step_mm, force_cN : force at start + i step, (n,), contact at 0.
    """

    stroke: Stroke
    velocity_mm_s: float | None
    start_mm: float
    step_mm: float
    force_cN: FloatArray


def sample_strokes(model: FDVVModel) -> tuple[SampledStroke, ...]:
    """Sample every curve of a model about every 10 um from its beginning to its end, in reading order."""
    found = []
    for curve in model.curves:
        length = curve.end_mm - curve.start_mm
        x = np.linspace(
            curve.start_mm, curve.end_mm, int(np.clip(round(length / STEP_mm) + 1, 2, MOST_points))
        )
        step = float(x[1] - x[0])
        found.append(SampledStroke(curve.stroke, curve.velocity_mm_s, float(x[0]), step, curve.force_cN(x)))
    return tuple(found)

"""Force between the measured velocities: how curves at several speeds make one surface."""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum

import numpy as np

from fdvv.model._curve import ForceCurve
from fdvv.units import FloatArray


class Interpolation(StrEnum):
    """How force is found at a velocity between two curves; outside their range the end curve holds."""

    NEAREST = "nearest"
    LINEAR = "linear"


def blend(
    curves: Sequence[ForceCurve],
    method: Interpolation,
    velocity_mm_s: FloatArray,
    displacement_mm: FloatArray,
    derivative: int = 0,
) -> FloatArray:
    """Evaluate force (cN) or its displacement derivative (cN/mm) on a surface of curves.

    curves : one stroke, velocities rising; a single curve serves every velocity.
    velocity_mm_s, displacement_mm : arrays of one common shape, which is the result's.
    """
    values = np.stack(
        [c.stiffness_cN_mm(displacement_mm) if derivative else c.force_cN(displacement_mm) for c in curves]
    )
    if len(curves) == 1:
        return np.asarray(values[0])
    speeds = np.array([c.velocity_mm_s for c in curves], dtype=np.float64)
    v = np.clip(velocity_mm_s, speeds[0], speeds[-1])
    upper = np.clip(np.searchsorted(speeds, v), 1, speeds.size - 1)
    part = (v - speeds[upper - 1]) / (speeds[upper] - speeds[upper - 1])
    if method is Interpolation.NEAREST:
        part = np.round(part)
    low = np.take_along_axis(values, (upper - 1)[np.newaxis], axis=0)[0]
    high = np.take_along_axis(values, upper[np.newaxis], axis=0)[0]
    return np.asarray(low + part * (high - low))

"""The samples of one press on an identified rig: motion, force on the finger, and the part the rig adds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.compensation.identification.balance import (
    Sensor,
    Ticks,
    cN_PER_g_m_s2,
    convolve,
    finger_force_cN,
    ticks_of,
    windows,
)
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.compensation.presses import mean_speed_mm_s, split_strokes
from fdvv.model.press import Press
from fdvv.units import FloatArray

TURN_cN_s = 500.0
"""A force that changes faster than this is taken to have crossed the sensor's play in full."""


@dataclass(frozen=True, eq=False)
class StrokeSample:
    """One stroke of a press between the guards, (n,) each, on even ticks.

    Attributes
    ----------
    displacement_mm, velocity_mm_s, acceleration_m_s2 : true motion, as estimated afterwards from both sides.
    rendered_cN : force on the finger, with the sensor's filter, cone and play taken out.
    own_cN : rendered_cN minus the coil's force: friction, weight and inertia.
    tick_s : between rows. speed_mm_s : mean of the stroke.
    """

    displacement_mm: FloatArray
    velocity_mm_s: FloatArray
    acceleration_m_s2: FloatArray
    rendered_cN: FloatArray
    own_cN: FloatArray
    tick_s: float
    speed_mm_s: float


def stroke_samples(
    press: Press, travel_mm: float, rig: RigModel, sensor: Sensor
) -> tuple[StrokeSample, StrokeSample]:
    """Return press and release of a record that reached the stop. Raises FitError on too few ticks."""
    ticks = ticks_of(press, "the press")
    position, *slopes = ticks.motion
    lag = rig.position_lag_s
    x, v, a = (value + lag * rate for value, rate in zip((position, *slopes[:2]), slopes, strict=True))
    a = a / 1000.0  # from mm/s2
    cone_cN = cN_PER_g_m_s2 * sensor.cone_g * a
    rendered = finger_force_cN(ticks, sensor) + _play_cN(ticks, rig.play_cN) - cone_cN
    own = rendered - rig.coil_cN(ticks.t_s, x, v, ticks.commanded_cN)

    def between(rows: slice) -> StrokeSample:
        speed = mean_speed_mm_s(ticks.t_s, x, rows)
        return StrokeSample(x[rows], v[rows], a[rows], rendered[rows], own[rows], ticks.tick_s, speed)

    down, up = split_strokes(x, travel_mm)
    return between(down), between(up)


def _play_cN(ticks: Ticks, play_cN: float) -> FloatArray:
    """Return by how much a changing force leads its reading: half the sensor's hysteresis."""
    slope = convolve(windows(ticks.tick_s)[1], ticks.force_cN)
    return np.asarray(0.5 * play_cN * np.clip(slope / TURN_cN_s, -1.0, 1.0))

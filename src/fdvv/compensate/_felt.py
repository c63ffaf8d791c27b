"""What one press on a known rig tells: motion, force on the finger, and what of it the rig made by itself."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.compensate._balance import Sensor, felt_cN
from fdvv.compensate._known_rig import KnownRig, cN_PER_g_m_s2
from fdvv.compensate._strokes import Span, mean_speed_mm_s, split_strokes
from fdvv.compensate._ticks import Ticks, through, ticks_of, windows
from fdvv.model import Press
from fdvv.units import FloatArray

TURN_cN_s = 500.0
"""A force that changes faster than this stands at the edge of the sensor's play."""


@dataclass(frozen=True, eq=False)
class Pass:
    """One stroke of a press between the guards, (n,) each, on even ticks.

    Attributes
    ----------
    displacement_mm, velocity_mm_s, acceleration_m_s2 : true motion, as estimated afterwards from both sides.
    felt_cN : force on the finger, with the sensor's filter, cone and play taken out.
    own_cN : felt_cN without the coil's force: friction, weight, inertia.
    tick_s : between rows. speed_mm_s : mean of the stroke.
    """

    displacement_mm: FloatArray
    velocity_mm_s: FloatArray
    acceleration_m_s2: FloatArray
    felt_cN: FloatArray
    own_cN: FloatArray
    tick_s: float
    speed_mm_s: float


def passes(press: Press, travel_mm: float, known: KnownRig, sensor: Sensor) -> tuple[Pass, Pass]:
    """Take both strokes from a press that reached the stop. FitError on a record with too few ticks."""
    ticks = ticks_of(press, "the press")
    place, *slopes = ticks.motion
    lag = known.position_lag_s
    x, v, a = (one + lag * next_one for one, next_one in zip((place, *slopes[:2]), slopes, strict=True))
    a = a / 1000.0
    felt = felt_cN(ticks, sensor) + _ahead_cN(ticks, known.play_cN) - cN_PER_g_m_s2 * sensor.cone_g * a
    own = felt - known.coil_cN(ticks.t_s, x, v, ticks.commanded_cN)

    def between(span: Span) -> Pass:
        rows, speed = span.rows, mean_speed_mm_s(ticks.t_s, x, span)
        return Pass(x[rows], v[rows], a[rows], felt[rows], own[rows], ticks.tick_s, speed)

    down, up = split_strokes(x, travel_mm)
    return between(down), between(up)


def _ahead_cN(ticks: Ticks, play_cN: float) -> FloatArray:
    """Give by how much, half the sensor's play, a changing force is ahead of its reading."""
    slope = through(windows(ticks.tick_s)[1], ticks.force_cN)
    return np.asarray(0.5 * play_cN * np.clip(slope / TURN_cN_s, -1.0, 1.0))

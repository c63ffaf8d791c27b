"""How a finger moves a cap through its travel, where nobody has measured it yet."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.model import Stroke
from fdvv.units import FloatArray

FINEST = 8
"""Steps of time per tick."""
MOST_STEPS = 20_000
FULL_SPEED = 30.0
"""Speed of a minimum jerk is 30 s^2 (1 - s)^2 of its mean: 1.875 times it at the middle."""


@dataclass(frozen=True, eq=False)
class Motion:
    """One stroke on even times.

    Attributes
    ----------
    stroke : which way it goes.
    t_s, displacement_mm : (n,); the displacement never turns back.
    velocity_mm_s, acceleration_m_s2 : (n,), positive into the button.
    """

    stroke: Stroke
    t_s: FloatArray
    displacement_mm: FloatArray
    velocity_mm_s: FloatArray
    acceleration_m_s2: FloatArray

    def __post_init__(self) -> None:
        if np.any(self.way * np.diff(self.displacement_mm) < 0) or self.t_s.size < 2:
            raise ModelError(f"a {self.stroke} needs a displacement that never turns back")

    @property
    def way(self) -> float:
        """Give 1 into the button, -1 out of it."""
        return 1.0 if self.stroke is Stroke.PRESS else -1.0

    @property
    def step_s(self) -> float:
        """Time between its points."""
        return float(self.t_s[1] - self.t_s[0])

    def at_places(self, values: FloatArray, displacement_mm: FloatArray) -> FloatArray:
        """Read a column of this motion, (n,), at rising places."""
        order = slice(None, None, int(self.way))
        return np.interp(displacement_mm, self.displacement_mm[order], values[order])


def minimum_jerk(stroke: Stroke, travel_mm: float, velocity_mm_s: float, tick_s: float) -> Motion:
    """Plan a stroke over the whole travel at a mean speed, at rest at both ends.

    x = travel (10 s^3 - 15 s^4 + 6 s^5), s = t velocity / travel. Eight steps per tick, 20 000 at most.
    Source: Flash and Hogan 1985. Raises ModelError unless travel and speed are above 0.
    """
    if not (travel_mm > 0 and velocity_mm_s > 0):
        raise ModelError(f"a stroke needs travel and speed above 0, got {travel_mm:g}, {velocity_mm_s:g}")
    lasts_s = travel_mm / velocity_mm_s
    count = min(MOST_STEPS, max(200, round(FINEST * lasts_s / tick_s)))
    s = np.linspace(0.0, 1.0, count + 1)
    way = 1.0 if stroke is Stroke.PRESS else -1.0
    x = travel_mm * s**3 * (10 - 15 * s + 6 * s**2)
    v = way * velocity_mm_s * FULL_SPEED * s**2 * (1 - s) ** 2
    a = way * 1e-3 * velocity_mm_s / lasts_s * 2 * FULL_SPEED * s * (1 - s) * (1 - 2 * s)
    return Motion(stroke, s * lasts_s, x if way > 0 else travel_mm - x, v, a)

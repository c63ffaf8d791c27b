"""How fast the referent must go for the cap of a real button to go at an asked speed. Simulated."""

from __future__ import annotations

import math

from fdvv.errors import ModelError
from fdvv.twin._button import ButtonPhysics
from fdvv.twin._button_noise import no_button_noise
from fdvv.twin._finger import Finger
from fdvv.twin._gesture import plan
from fdvv.twin._pace import LONGEST_s, SHORTEST_s, mean_speed_mm_s
from fdvv.twin._rig_senses import ForceSensor
from fdvv.twin._simulate_button import simulate_button
from fdvv.units import mm_from_m

TOLERANCE = 0.005
NEVER_mm_s = 1e-3
"""Speed that stands for a press that does not reach the bottom."""
DIVERGED_mm_s = 1e5
"""Speed that stands for a press too sudden for the equations."""


def solve_button_pace(
    button: ButtonPhysics, finger: Finger, velocity_mm_s: float, sensor: ForceSensor | None = None
) -> float:
    """Find the duration of the referent's stroke (s) for a mean speed of the cap, to 0.5 %.

    The person has adapted to this button; nothing varies. Bisection and secants (Brent) on the logarithms of
    duration and speed. Speeds beyond the finger's reach give the shortest or longest duration. A stroke so
    short that its press diverges counts as too fast. Raises ModelError if the longest one diverges too.
    """
    from scipy.optimize import brentq

    if not velocity_mm_s > 0:
        raise ModelError(f"velocity_mm_s must be above 0, got {velocity_mm_s}")

    def miss(log_s: float) -> float:
        try:
            speed = _speed_mm_s(button, finger, math.exp(log_s), sensor)
        except ModelError:
            if log_s >= high:
                raise
            speed = DIVERGED_mm_s
        return math.log(max(speed, NEVER_mm_s) / velocity_mm_s)

    low, high = math.log(SHORTEST_s), math.log(max(8 * mm_from_m(button.curve.travel_m) / velocity_mm_s, 0.1))
    if miss(low) <= 0:
        return SHORTEST_s
    if miss(high) >= 0:
        return min(math.exp(high), LONGEST_s)
    found = brentq(miss, low, high, xtol=0.5 * TOLERANCE)
    while miss(found) >= math.log(DIVERGED_mm_s / velocity_mm_s):
        found += TOLERANCE
    return math.exp(found)


def _speed_mm_s(button: ButtonPhysics, finger: Finger, press_s: float, sensor: ForceSensor | None) -> float:
    gesture = plan(finger, button.curve.travel_m, press_s)
    trace = simulate_button(button, finger, gesture, no_button_noise(gesture), sensor)
    return mean_speed_mm_s(trace.t_s, trace.displacement_mm, float(mm_from_m(button.curve.travel_m)))

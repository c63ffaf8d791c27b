"""Solve for the duration of a stroke that gives the cap a mean speed, on the rig and on a button."""

from __future__ import annotations

import math

import numpy as np

from fdvv.errors import ModelError
from fdvv.protocol.messages import travel_mm_of
from fdvv.protocol.tables import Settings
from fdvv.twin.button import ButtonPhysics
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import plan
from fdvv.twin.noise import silence
from fdvv.twin.rig import ForceSensor, Rig
from fdvv.twin.rig_kernel import LoopConstants
from fdvv.twin.simulate import simulate_program
from fdvv.twin.simulate_button import no_button_noise, simulate_button
from fdvv.units import FloatArray, m_from_mm, mm_from_m

PACE_START_mm = 0.1
SUNK_mm = 0.05
"""A cap that a weak table lets sink under the resting finger starts this much below where it rests."""
TOLERANCE_ratio = 0.005
ROUNDS = 12
SHORTEST_s, LONGEST_s = 0.01, 40.0
"""Of the referent's stroke; the longest takes a stage of 0.5 mm/s over the deepest stop."""
NEVER_mm_s = 1e-3
"""Assigned to a press that does not reach the bottom."""
DIVERGED_mm_s = 1e5
"""Assigned to a press too sudden for the equations."""


def mean_speed_mm_s(t_s: FloatArray, displacement_mm: FloatArray, travel_mm: float) -> float:
    """Return the mean speed of a press between 0.1 mm and bottom-out; 0 if the cap never got there.

    A cap that rests deeper is timed from 0.05 mm below its rest. Both crossings are interpolated between
    rows, the first as the last one before bottom-out.
    """
    start_mm = max(PACE_START_mm, float(displacement_mm[0]) + SUNK_mm)
    bottom = np.flatnonzero(displacement_mm >= travel_mm)
    if not bottom.size or bottom[0] == 0:
        return 0.0
    end = int(bottom[0])
    low = np.flatnonzero(displacement_mm[:end] < start_mm)
    if not low.size:
        return 0.0
    times = [_crossing(t_s, displacement_mm, i, x) for i, x in ((low[-1], start_mm), (end - 1, travel_mm))]
    return (travel_mm - start_mm) / (times[1] - times[0])


def _crossing(t_s: FloatArray, x_mm: FloatArray, i: int, level_mm: float) -> float:
    part = (level_mm - x_mm[i]) / (x_mm[i + 1] - x_mm[i])
    return float(t_s[i] + part * (t_s[i + 1] - t_s[i]))


def solve_program_pace(
    rig: Rig,
    finger: Finger,
    image: bytes,
    velocity_mm_s: float,
    guess_s: float | None = None,
    settings: Settings | None = None,
    loop: LoopConstants | None = None,
) -> float:
    """Find the duration of the referent's stroke (s) for a mean speed of the cap, to 0.5 %.

    image, settings : as simulate_program() takes them. The person has adapted to this program on this rig;
    nothing varies. Secant on the logarithms of duration and speed. Speeds that the finger cannot reach give
    the nearest that was found.
    """
    travel_mm = travel_mm_of(image)

    def miss(log_s: float) -> float:
        gesture = plan(finger, float(m_from_mm(travel_mm)), math.exp(log_s))
        noise = silence(rig, gesture)
        trace = simulate_program(
            rig, finger, gesture, image, noise, velocity_mm_s, settings=settings, loop=loop
        )
        speed = mean_speed_mm_s(trace.t_s, trace.displacement_mm, travel_mm)
        return math.log(speed / velocity_mm_s) if speed else -1.0

    a = math.log(guess_s or 2.0 * travel_mm / velocity_mm_s)
    miss_a = miss(a)
    best = (abs(miss_a), a)
    # at most twice or half as long in one step
    b = a + float(np.clip(miss_a, -0.7, 0.7))
    for _ in range(ROUNDS):
        if best[0] < TOLERANCE_ratio or not math.log(SHORTEST_s) < b < math.log(LONGEST_s):
            break
        miss_b = miss(b)
        best = min(best, (abs(miss_b), b))
        slope = (miss_b - miss_a) / (b - a) if b != a else -1.0
        # longer is slower: any other slope is a kink of the contact, step over it
        slope = min(slope, -0.2)
        a, miss_a, b = b, miss_b, b - float(np.clip(miss_b / slope, -0.7, 0.7))
    return math.exp(best[1])


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
    root = brentq(miss, low, high, xtol=0.5 * TOLERANCE_ratio)
    while miss(root) >= math.log(DIVERGED_mm_s / velocity_mm_s):
        root += TOLERANCE_ratio
    return math.exp(root)


def _speed_mm_s(button: ButtonPhysics, finger: Finger, press_s: float, sensor: ForceSensor | None) -> float:
    gesture = plan(finger, button.curve.travel_m, press_s)
    trace = simulate_button(button, finger, gesture, no_button_noise(gesture), sensor)
    return mean_speed_mm_s(trace.t_s, trace.displacement_mm, float(mm_from_m(button.curve.travel_m)))

"""How fast the referent must go for the cap to go at an asked speed."""

from __future__ import annotations

import math

import numpy as np

from fdvv.model import ForceSurface
from fdvv.protocol import Settings, travel_mm_of
from fdvv.twin._finger import Finger
from fdvv.twin._gesture import plan
from fdvv.twin._image import image_of
from fdvv.twin._noise import silence
from fdvv.twin._rig import Rig
from fdvv.twin._simulate import simulate_program
from fdvv.units import FloatArray, m_from_mm

PACE_START_mm = 0.1
SUNK_mm = 0.05
"""A cap that a weak table lets sink under the resting finger starts this much below where it rests."""
TOLERANCE_ratio = 0.005
ROUNDS = 12
SHORTEST_s, LONGEST_s = 0.01, 40.0
"""Of the referent's stroke; the longest takes a stage of 0.5 mm/s over the deepest stop."""


def mean_speed_mm_s(t_s: FloatArray, displacement_mm: FloatArray, travel_mm: float) -> float:
    """Give the mean speed of a press between 0.1 mm and bottom-out; 0 if the cap never got there.

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


def solve_pace(
    rig: Rig,
    finger: Finger,
    surface: ForceSurface,
    travel_mm: float,
    velocity_mm_s: float,
    guess_s: float | None = None,
) -> float:
    """Find the duration of the referent's stroke (s) for a mean speed of the cap, to 0.5 %.

    The person has adapted to this surface on this rig; nothing varies. Secant on the logarithms of
    duration and speed. Speeds that the finger cannot reach give the nearest that was found.
    """
    return solve_program_pace(rig, finger, image_of(surface, travel_mm).image, velocity_mm_s, guess_s)


def solve_program_pace(
    rig: Rig,
    finger: Finger,
    image: bytes,
    velocity_mm_s: float,
    guess_s: float | None = None,
    settings: Settings | None = None,
) -> float:
    """Find the same for a program (its image, protocol/fdvv.toml) under settings as simulate_program()'s."""
    travel_mm = travel_mm_of(image)

    def miss(log_s: float) -> float:
        gesture = plan(finger, float(m_from_mm(travel_mm)), math.exp(log_s))
        noise = silence(rig, gesture)
        trace = simulate_program(rig, finger, gesture, image, noise, velocity_mm_s, settings=settings)
        speed = mean_speed_mm_s(trace.t_s, trace.displacement_mm, travel_mm)
        return math.log(speed / velocity_mm_s) if speed else -1.0

    a = math.log(guess_s or 2.0 * travel_mm / velocity_mm_s)
    miss_a = miss(a)
    best = (abs(miss_a), a)
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

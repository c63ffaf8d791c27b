"""One planned press, drawn from what a person tends to do."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.twin.finger import Finger

FULL_UNDERSHOOT_m_s = 0.2
TAIL_s = 0.06
"""Time recorded after the finger has gone, for the cap to come back, unless the gesture says otherwise."""


@dataclass(frozen=True)
class Gesture:
    """Where the referent of the finger goes: minimum jerk down, dwell, minimum jerk back.

    Attributes
    ----------
    start_m : before and after the press; negative is above the cap.
    end_m : at the bottom, beyond the stop by what the finger pushes with.
    onset_s, press_s, dwell_s, release_s : durations, in order.
    stiffness_N_m, damping_N_s_m : of the finger in this press.
    tail_s : recorded after the finger has gone.
    """

    start_m: float
    end_m: float
    onset_s: float
    press_s: float
    dwell_s: float
    release_s: float
    stiffness_N_m: float
    damping_N_s_m: float
    tail_s: float = TAIL_s

    def __post_init__(self) -> None:
        if not all(np.isfinite(value) for value in vars(self).values()):
            raise ModelError(f"a gesture needs finite numbers, got {self}")
        if self.press_s <= 0 or self.release_s <= 0 or min(self.onset_s, self.dwell_s, self.tail_s) < 0:
            raise ModelError(f"a gesture needs durations above 0, got {self}")

    @property
    def duration_s(self) -> float:
        """Length of the record."""
        return self.onset_s + self.press_s + self.dwell_s + self.release_s + self.tail_s


def plan(finger: Finger, travel_m: float, press_s: float) -> Gesture:
    """Plan the press of a person who never varies; press and release last equally long."""
    habit, stiffness = finger.habit, finger.impedance.stiffness_N_m
    start = -habit.lift_m if habit.lift_m else depth_m(finger, habit.rest_N, stiffness)
    end = travel_m + depth_m(finger, habit.push_N, stiffness)
    times = (habit.onset_s, press_s, habit.dwell_s, press_s)
    return Gesture(start, end, *times, stiffness, finger.impedance.damping_N_s_m)


def depth_m(finger: Finger, force_N: float, stiffness_N_m: float) -> float:
    """Return the depth of the referent beyond a wall at a static force: joint and relaxed pulp in series."""
    pulp = finger.pulp
    squeeze = math.log1p(force_N / (pulp.relaxed_ratio * pulp.scale_N + pulp.strap_N)) / pulp.exponent_1_m
    return squeeze + (force_N / stiffness_N_m if stiffness_N_m else 0.0)


def vary(
    finger: Finger, travel_m: float, press_s: float, velocity_m_s: float, random: np.random.Generator
) -> Gesture:
    """Draw one press: pace, push, impedance, lift and onset each vary, the pace with its bias."""
    habit = finger.habit
    pace, push, stiff, damp, lift, onset = random.standard_normal(6)

    def scale(spread: float, draw: float) -> float:
        # three spreads either way, so that no draw turns a quantity round
        return 1 + spread * float(np.clip(draw, -3, 3))

    nominal = plan(finger, travel_m, press_s)
    slow = habit.pace_undershoot_ratio * velocity_m_s / FULL_UNDERSHOOT_m_s
    # the least of each factor keeps a press a press, however unlikely the draw
    speed = max(0.3, scale(habit.pace_spread_ratio, pace) - slow)
    stiffness = nominal.stiffness_N_m * max(0.1, scale(habit.impedance_spread_ratio, stiff))
    start = nominal.start_m * max(0.0, scale(habit.lift_spread_ratio, lift))
    beyond = habit.push_N * max(0.1, scale(habit.push_spread_ratio, push))
    damping = nominal.damping_N_s_m * max(0.1, scale(habit.impedance_spread_ratio, damp))
    wait = max(0.0, habit.onset_s + habit.onset_spread_s * float(onset))
    times = (wait, nominal.press_s / speed, habit.dwell_s, nominal.release_s / speed)
    return Gesture(start, travel_m + depth_m(finger, beyond, stiffness), *times, stiffness, damping)

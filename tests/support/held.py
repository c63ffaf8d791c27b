"""A finger that holds a cap still on a table, and whether it stays still. Simulated."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fdvv.model.surface import ForceSurface
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import plan
from fdvv.twin.noise import silence
from fdvv.twin.rig import Rig
from tests.support.table_press import simulate

NUDGE_s = 0.02
"""The finger comes so quickly that the cap arrives with a swing."""
HOLD_s = 0.7


def held_swings_mm(
    rig: Rig, finger: Finger, surface: ForceSurface, travel_mm: float, place_mm: float, force_cN: float
) -> tuple[float, float]:
    """Press to where the table gives force_cN, stay, and return how far the cap swings, early and late.

    The finger of this person without variation; no noise, so that what swings, the loop swings.
    """
    habit = replace(finger.habit.still(), push_N=max(0.0, 0.01 * force_cN), lift_m=0.0)
    gesture = replace(plan(replace(finger, habit=habit), 1e-3 * place_mm, NUDGE_s), dwell_s=HOLD_s)
    trace = simulate(
        rig, replace(finger, habit=habit), gesture, surface, travel_mm, silence(rig, gesture), 50.0
    )
    held = trace.t_s - trace.t_s[0] - gesture.onset_s - gesture.press_s
    thirds = [
        trace.displacement_mm[(held > part * HOLD_s) & (held < (part + 0.3) * HOLD_s)] for part in (0.3, 0.65)
    ]
    return float(np.ptp(thirds[0])), float(np.ptp(thirds[1]))


def swings_held(
    rig: Rig,
    finger: Finger,
    surface: ForceSurface,
    travel_mm: float,
    place_mm: float,
    force_cN: float,
    still_mm: float = 0.01,
) -> bool:
    """Return whether a held cap goes on swinging: by more than still_mm, and without dying away."""
    before, after = held_swings_mm(rig, finger, surface, travel_mm, place_mm, force_cN)
    return min(before, after) > still_mm and after > 0.7 * before

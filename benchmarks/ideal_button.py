"""A button that renders its target exactly, without delay, under many fingers at once.

A cap of a few grams between two stops, a target on it, and the finger of the twin, all integrated here in
numpy, independently of the twin. What swings here too is the target's doing, or the finger's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.model.surface import ForceSurface
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import Gesture
from fdvv.units import FloatArray

CAP_kg = 2.9e-3
"""What a cap of 12 g feels like with the loop closed."""
STEP_s, ROW_s, SETTLE_s = 2e-5, 1e-4, 0.08
STOP_N_m, STOP_LOSS_s_m, DEEPEST_m = 2e5, 6.0, 4e-3


@dataclass(frozen=True, eq=False)
class IdealPress:
    """One finger, its gesture, the row of the target that renders, and its effort, (ticks of ROW_s,)."""

    finger: Finger
    gesture: Gesture
    row: int
    effort_ratio: FloatArray


@dataclass(frozen=True)
class Reversal:
    """The way from one stroke's curve to the other's: over a distance, no steeper, after a play."""

    over_m: float = 1e-4
    steepest_N_m: float = 800.0
    play_m: float = 0.0


def _of(presses: Sequence[IdealPress], part: str, name: str) -> FloatArray:
    owners = [p.gesture if part == "gesture" else getattr(p.finger, part) for p in presses]
    return np.array([getattr(owner, name) for owner in owners])


def _referent(presses: Sequence[IdealPress], t_s: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return equilibrium and its velocity, (times, presses): minimum jerk down, dwell, minimum jerk back."""
    start, end, onset, press, dwell, release = (
        _of(presses, "gesture", name)
        for name in ("start_m", "end_m", "onset_s", "press_s", "dwell_s", "release_s")
    )
    down = np.clip((t_s[:, None] - onset) / press, 0, 1)
    up = np.clip((t_s[:, None] - onset - press - dwell) / release, 0, 1)

    def along(s: FloatArray) -> FloatArray:
        return np.asarray(s**3 * (10 + s * (6 * s - 15)))

    def rate(s: FloatArray) -> FloatArray:
        return np.asarray(30 * s**2 * (1 - s) ** 2)

    return start + (end - start) * (along(down) - along(up)), (end - start) * (
        rate(down) / press - rate(up) / release
    )


def _stop_N(depth_m: FloatArray, rate_m_s: FloatArray) -> FloatArray:
    pushed = STOP_N_m * depth_m * (1 + STOP_LOSS_s_m * rate_m_s)
    return np.asarray(np.where(depth_m > 0, np.maximum(pushed, 0), 0.0))


class _Target:
    """The force of both strokes and the way between them, for many presses."""

    def __init__(self, target: ForceSurface, rows: FloatArray, reversal: Reversal) -> None:
        self._step_m = 1e-3 * float(target.displacement_mm[1])
        self._columns, self._reversal = target.displacement_mm.size, reversal
        self._strokes = 0.01 * target.press_cN.ravel(), 0.01 * target.release_cN.ravel()
        self._first = rows.astype(int) * self._columns
        self._release, self._last_m = np.zeros(rows.size), np.zeros(rows.size)

    def force_N(self, x_m: FloatArray) -> FloatArray:
        """Return the force at these displacements, which follow those of the call before."""
        at = np.clip(x_m / self._step_m, 0, self._columns - 1.000001)
        low = at.astype(int)
        part, low = at - low, low + self._first
        press, release = ((1 - part) * s[low] + part * s[low + 1] for s in self._strokes)
        play = self._reversal.play_m
        moved = x_m - self._last_m
        moved = moved - np.clip(moved, -play, play)
        over = np.maximum(self._reversal.over_m, (press - release) / self._reversal.steepest_N_m)
        self._release = np.clip(self._release - moved / over, 0, 1)
        self._last_m = self._last_m + moved
        return np.asarray(press + self._release * (release - press))


def press_ideal(
    target: ForceSurface, travel_mm: float, presses: Sequence[IdealPress], reversal: Reversal
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Press; return times, (n,), the finger's force in cN and the cap's speed in mm/s, (n, presses)."""
    law = _Target(target, np.array([p.row for p in presses]), reversal)
    kg, N_m, N_s_m = (
        _of(presses, part, name)
        for part, name in (
            ("impedance", "mass_kg"), ("gesture", "stiffness_N_m"), ("gesture", "damping_N_s_m"),
        )
    )  # fmt: skip
    scale, exponent, relaxed, share, fast_s, slow_s = (
        _of(presses, "pulp", name)
        for name in ("scale_N", "exponent_1_m", "relaxed_ratio", "fast_share", "fast_s", "slow_s")
    )
    longest = max(p.gesture.duration_s for p in presses)
    ticks = round((longest + SETTLE_s) / ROW_s)
    effort = np.zeros((ticks, len(presses)))
    for i, press in enumerate(presses):
        known = press.effort_ratio[:ticks]
        effort[: known.size, i] = known
    xf, vf, x, v, fast, slow = np.zeros((6, len(presses)))
    every = round(ROW_s / STEP_s)
    fine_s = np.arange(every, dtype=np.float64) * STEP_s
    forces, speeds = np.empty((2, ticks, len(presses)))
    for i in range(ticks):
        goal, goal_v = _referent(presses, i * ROW_s - SETTLE_s + fine_s)
        for j in range(every):
            depth = np.minimum(xf - x, DEEPEST_m)
            grown = scale * np.exp(exponent * depth)
            pulp = np.maximum(relaxed * (grown - scale) + fast + slow, 0)
            rising = exponent * grown * (vf - v)
            fast += STEP_s * ((1 - relaxed) * share * rising - fast / fast_s)
            slow += STEP_s * ((1 - relaxed) * (1 - share) * rising - slow / slow_s)
            pull = (1 + effort[i]) * (N_m * (goal[j] - xf) + N_s_m * (goal_v[j] - vf))
            held = law.force_N(x) + _stop_N(x - 1e-3 * travel_mm, v) - _stop_N(-x, -v)
            vf += STEP_s * (pull - pulp) / kg
            v += STEP_s * (pulp - held) / CAP_kg
            xf += STEP_s * vf
            x += STEP_s * v
        forces[i], speeds[i] = 100 * pulp, 1e3 * v
    t_s: FloatArray = np.arange(ticks, dtype=np.float64) * ROW_s - SETTLE_s
    return t_s[t_s >= 0], forces[t_s >= 0], speeds[t_s >= 0]

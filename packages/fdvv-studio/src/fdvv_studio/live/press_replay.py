"""Lead a finger so that the cap goes where a key was, or is: along a trace, or reading by reading."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fdvv.twin.gesture import depth_m
from fdvv.units import FloatArray, N_from_cN, mm_from_m
from fdvv_studio.live.press_subject import PressSubject
from fdvv_studio.live.press_trace import PressTrace

REPLAY_STEP_s = 0.004
"""How often a finger that follows a trace is led anew."""
SMOOTH_s = 0.004
"""Of the trace, one standard deviation: keyboards tell places in steps."""
NEAR_1_s = 500.0
TOUCH_mm = 0.1
"""Over so much displacement the finger takes the button's force up."""
REVERSAL_mm = 0.2
"""Over so much displacement the other stroke's force comes in, where nothing says what the key will do."""


class ReferentStep(NamedTuple):
    """What a finger is led by for a while."""

    referent_mm: float
    velocity_mm_s: float
    near_1_s: float
    holds_s: float


@dataclass(frozen=True, eq=False)
class DisplacementPath:
    """Where the referent goes; (n,) columns every STEP_s from start_s on."""

    start_s: float
    referent_mm: FloatArray
    velocity_mm_s: FloatArray

    def at(self, time_s: float) -> ReferentStep | None:
        """Return what leads the finger at a time; None once the path is over."""
        i = int((time_s - self.start_s) / REPLAY_STEP_s + 1e-6)
        if i >= self.referent_mm.size:
            return None
        rest_s = self.start_s + (i + 1) * REPLAY_STEP_s - time_s
        return ReferentStep(float(self.referent_mm[i]), float(self.velocity_mm_s[i]), NEAR_1_s, rest_s)


def path_of(trace: PressTrace, subject: PressSubject, start_s: float) -> DisplacementPath:
    """Have a person who knows the button aim so that its cap would go along the trace.

    The referent is deeper than the trace by what the finger gives way under the button's slow force as it is
    meant: a trace of one button moves the cap of another as a person's hand would, not exactly.
    """
    t = np.arange(int(trace.duration_s / REPLAY_STEP_s) + 1) * REPLAY_STEP_s
    x = _smooth(np.interp(t, trace.t_s, trace.displacement_mm))
    down = np.gradient(x, REPLAY_STEP_s) >= 0
    slow = [np.interp(x, subject.displacement_mm, row) for row in subject.target_cN(0.0)]
    force = np.where(down, *slow)
    referent = _smooth(x + _yields_mm(subject, x, force))
    return DisplacementPath(start_s, referent, np.gradient(referent, REPLAY_STEP_s))


class KeyFollower:
    """Leads a finger by a key that is read while it moves: as path_of does, without knowing what comes.

    The force between the strokes is taken from both: the other one's comes in over REVERSAL_mm, so that
    noise of the reading does not throw the finger to and fro.
    """

    def __init__(self, subject: PressSubject) -> None:
        self._x_mm = subject.displacement_mm
        self._yields_mm = [_yields_mm(subject, self._x_mm, force) for force in subject.target_cN(0.0)]
        self._press_ratio, self._last_mm = 1.0, 0.0

    def step(self, displacement_mm: float, velocity_mm_s: float) -> ReferentStep:
        """Return what leads the finger once the key is at a place (0: at rest) and moves at a speed."""
        moved = (displacement_mm - self._last_mm) / REVERSAL_mm
        self._press_ratio = min(1.0, max(0.0, self._press_ratio + moved))
        self._last_mm = displacement_mm
        referent = self._referent_mm(displacement_mm)
        ahead = self._referent_mm(displacement_mm + velocity_mm_s * REPLAY_STEP_s)
        return ReferentStep(referent, (ahead - referent) / REPLAY_STEP_s, NEAR_1_s, REPLAY_STEP_s)

    def _referent_mm(self, x_mm: float) -> float:
        press, release = (float(np.interp(x_mm, self._x_mm, row)) for row in self._yields_mm)
        return x_mm + self._press_ratio * press + (1.0 - self._press_ratio) * release


def _yields_mm(subject: PressSubject, x_mm: FloatArray, force_cN: FloatArray) -> FloatArray:
    """Return how far finger and pulp give way at places under forces, (n,)."""
    held = np.clip(x_mm / TOUCH_mm, 0.0, 1.0) * np.maximum(force_cN, 0.0)
    stiffness = subject.finger.impedance.stiffness_N_m
    return np.array([mm_from_m(depth_m(subject.finger, float(N_from_cN(f)), stiffness)) for f in held])


def _smooth(x: FloatArray) -> FloatArray:
    # beyond four standard deviations a weight is below a thousandth
    reach = np.arange(-4, 5) * REPLAY_STEP_s
    weights = np.exp(-0.5 * (reach / SMOOTH_s) ** 2)
    padded = np.concatenate([np.full(4, x[0]), x, np.full(4, x[-1])])
    return np.convolve(padded, weights / weights.sum(), mode="valid")

"""Convert a recorded trace of the cap into the path that leads a finger along it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fdvv.live.press_subject import PressSubject
from fdvv.live.press_trace import PressTrace
from fdvv.twin.gesture import depth_m
from fdvv.units import FloatArray, N_from_cN, mm_from_m

REPLAY_STEP_s = 0.004
"""How often a finger that follows a trace is led anew."""
SMOOTH_s = 0.004
"""Of the trace, one standard deviation: keyboards tell places in steps."""
NEAR_1_s = 500.0
TOUCH_mm = 0.1
"""Over so much displacement the finger takes the button's force up."""


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
    slow = [np.interp(x, subject.displacement_mm, row) for row in subject.meant_cN(0.0)]
    force = np.where(down, *slow)
    held = np.clip(x / TOUCH_mm, 0.0, 1.0) * np.maximum(force, 0.0)
    stiffness = subject.finger.impedance.stiffness_N_m
    yielding = [mm_from_m(depth_m(subject.finger, float(N_from_cN(f)), stiffness)) for f in held]
    referent = _smooth(x + np.array(yielding))
    return DisplacementPath(start_s, referent, np.gradient(referent, REPLAY_STEP_s))


def _smooth(x: FloatArray) -> FloatArray:
    # beyond four standard deviations a weight is below a thousandth
    reach = np.arange(-4, 5) * REPLAY_STEP_s
    weights = np.exp(-0.5 * (reach / SMOOTH_s) ** 2)
    padded = np.concatenate([np.full(4, x[0]), x, np.full(4, x[-1])])
    return np.convolve(padded, weights / weights.sum(), mode="valid")

"""Will a curve buzz: its steepest rise and its step between strokes against what the sampled loop bears."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from fdvv.compensate._feasible_limits import RigLimits
from fdvv.compensate._known_rig import KnownRig
from fdvv.compensate._stability_loop import NominalFinger, SampledLoop, stiffness_limit_N_m
from fdvv.errors import ModelError
from fdvv.model import running_mean
from fdvv.units import FloatArray

cN_mm_PER_N_m = 0.1
SPAN_mm = 0.05
"""Slopes are those of the force averaged over this length, the step of a table."""
HUNTS = 0.55
"""A step whose margin is below this may hunt: on most rigs drag and friction quieten a smaller one
(simulated, seeds 300 to 329 of the benchmark)."""
END_mm = 0.1
"""Next to either end of the travel a stop carries the cap."""
ENOUGH, BUZZES = 1.2, 0.5
"""From the first margin on a curve is quiet, below the second it buzzes. Between them decide fingers that
differ from the nominal one, and friction, which can hold what the linear loop cannot."""


@dataclass(frozen=True)
class Slope:
    """The steepest rise and the steepest fall of a curve, and where; cN/mm, both positive."""

    rise_cN_mm: float
    rise_mm: float
    rise_cN: float
    fall_cN_mm: float
    fall_mm: float
    fall_cN: float


@dataclass(frozen=True)
class Stability:
    """One curve's loop at its worst place, against every bound; stiffness in cN/mm.

    Attributes
    ----------
    slope : the curve's steepest rise and fall.
    passive_cN_mm : below it no finger at all can make the loop swing (Colgate-Brown with delay).
    grain_cN_mm : below it friction swallows what the sensor's grain feeds in (Abbott-Okamura).
    alone_cN_mm, finger_cN_mm : exact onset of swinging at the steepest rise, without and with a finger.
    step_cN, step_mm : largest excess of press over release, and where; 0 where only one curve is judged.
    step_limit_cN : up to it a finger that rests on the step is quiet, whatever nudges it.
    """

    slope: Slope
    passive_cN_mm: float
    grain_cN_mm: float
    alone_cN_mm: float
    finger_cN_mm: float
    step_cN: float
    step_mm: float
    step_limit_cN: float

    @property
    def margin(self) -> float:
        """Give the onset with a finger over the steepest rise."""
        return self.finger_cN_mm / max(self.slope.rise_cN_mm, 1e-9)

    @property
    def step_margin(self) -> float:
        """Give the largest quiet step over the curve's."""
        return self.step_limit_cN / max(self.step_cN, 1e-9)

    @property
    def holds(self) -> str:
        """Name the most that can be said, from "passive for every finger" down to "buzzes"."""
        rise = self.slope.rise_cN_mm
        if self.margin < ENOUGH or self.step_margin < HUNTS:
            return "buzzes" if self.margin < BUZZES else "may buzz"
        if rise <= min(self.passive_cN_mm, self.grain_cN_mm):
            return "passive for every finger"
        return "stable even alone" if rise <= self.alone_cN_mm else "stable with a finger on it"

    def to_dict(self) -> dict[str, Any]:
        """Give it as a document."""
        told = {"holds": self.holds, "margin": self.margin, "step_margin": self.step_margin}
        return {**told, **asdict(self)}


def passive_limit_N_m(known: KnownRig, tick_s: float, displacement_mm: float) -> float:
    """Give the stiffness up to which the loop takes energy from any finger: b / (T/2 + t_d).

    b is the drag at that place, t_d what the chain adds to half a tick of holding: computing, the coil's lag,
    the sensed position's age. Without delay it is Colgate and Brown's b > K T/2 + |B| (1994; no damping B is
    rendered): K < 2 b / T. With delay it is the rule to first order in it (Diolaiti et al. 2006); that the
    coil's part of the drag lags too makes it optimistic.
    """
    late_s = max(0.5 * tick_s, known.delay_s) + known.position_lag_s
    return max(0.0, float(known.drag_at(np.array(displacement_mm)))) / late_s


def grain_limit_N_m(known: KnownRig, limits: RigLimits, displacement_mm: float) -> float:
    """Give min(2 b / T, 2 f / grain): above it the position's grain feeds in more than drag, friction take.

    Source: Abbott and Okamura 2005. The grain is one reading's; a mean of noisy readings has a finer one.
    """
    drag = max(0.0, float(known.drag_at(np.array(displacement_mm))))
    return min(2 * drag / limits.tick_s, 1e-2 * 2 * known.friction_cN / (1e-3 * limits.grain_mm))


def steepest(displacement_mm: FloatArray, force_cN: FloatArray) -> Slope:
    """Find the steepest rise and fall of a curve, (n,) over rising places, END_mm from either end.

    At the ends a stop carries the cap, not the loop. Raises ModelError on a curve too short for that.
    """
    slope = np.gradient(running_mean(displacement_mm, force_cN, SPAN_mm), displacement_mm)
    first, last = displacement_mm[[0, -1]]
    free = (displacement_mm >= first + END_mm) & (displacement_mm <= last - END_mm)
    if not free.any():
        raise ModelError(f"a curve of {last - first:g} mm is too short to judge its slopes")
    x, f, slope = displacement_mm[free], force_cN[free], slope[free]
    up, down = int(np.argmax(slope)), int(np.argmin(slope))
    rise, fall = max(0.0, float(slope[up])), max(0.0, -float(slope[down]))
    return Slope(rise, float(x[up]), float(f[up]), fall, float(x[down]), float(f[down]))


def step_limit_cN(
    finger: NominalFinger, held_cN: float, stiffness_N_m: float, reversal_mm: float, friction_cN: float
) -> float:
    """Give the step between press and release up to which a resting finger is quiet, whatever nudges it.

    A cap that comes back by the reversal distance is given the other table. Under the press table it comes to
    rest higher, under the release table lower, (step - 2 friction) / (K finger + K) apart. While that is less
    than the reversal distance, neither rest calls for the other table: 2 friction + reversal (K finger + K).
    Beyond it the cap can hunt between both; whether it does depends on drag and inertia.
    """
    held_N_m = finger.static_N_m(held_cN) + stiffness_N_m
    return 2 * friction_cN + cN_mm_PER_N_m * reversal_mm * held_N_m


def stability(
    known: KnownRig,
    limits: RigLimits,
    displacement_mm: FloatArray,
    force_cN: FloatArray,
    over_cN: FloatArray | None = None,
    finger: NominalFinger | None = None,
) -> Stability:
    """Judge a curve, (n,) over rising places, at its steepest rise and at its largest step.

    over_cN : the press curve above a release, (n,) on the same places: judges the step between them too.
    finger : who holds the cap; a nominal one if None. A steep fall is no buzz: the cap snaps through there,
    as it does on the button (Slope tells how steep). Raises ModelError on a rig or curve that cannot be.
    """
    slope, hand, tick_s = steepest(displacement_mm, force_cN), finger or NominalFinger(), limits.tick_s
    place, held_cN = slope.rise_mm, slope.rise_cN
    alone, onset = (
        stiffness_limit_N_m(SampledLoop.of_known(known, tick_s, place, who, held_cN)) for who in (None, hand)
    )
    bounds = passive_limit_N_m(known, tick_s, place), grain_limit_N_m(known, limits, place), alone, onset
    over = force_cN if over_cN is None else over_cN
    step, step_mm, quiet = _step(known, limits, displacement_mm, over, force_cN, hand)
    passive, grain, bare, hand_on = (cN_mm_PER_N_m * bound for bound in bounds)
    return Stability(slope, passive, grain, bare, hand_on, step, step_mm, quiet)


def _step(
    known: KnownRig,
    limits: RigLimits,
    x: FloatArray,
    over_cN: FloatArray,
    under_cN: FloatArray,
    finger: NominalFinger,
) -> tuple[float, float, float]:
    """Give the largest step between two curves, where it is, and the largest that is quiet there."""
    step, middle = over_cN - under_cN, 0.5 * (over_cN + under_cN)
    free = (x >= x[0] + END_mm) & (x <= x[-1] - END_mm)
    at = int(np.argmax(np.where(free, step, -np.inf)))
    # where both fall the cap snaps through: none of it is held
    flank_N_m = max(0.0, float(np.gradient(running_mean(x, middle, SPAN_mm), x)[at])) / cN_mm_PER_N_m
    quiet = step_limit_cN(finger, float(middle[at]), flank_N_m, limits.reversal_mm, known.friction_cN)
    return max(0.0, float(step[at])), float(x[at]), quiet

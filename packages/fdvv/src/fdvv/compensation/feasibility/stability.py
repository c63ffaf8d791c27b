"""Stability: will a curve buzz? Its steepest rise and its step between strokes against the sampled loop.

The loop is linear: a sampled-data system with a fractional input delay, by matrix exponentials (Astrom and
Wittenmark, Computer-Controlled Systems), of the RigModel without friction, which only stabilizes.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any

import numpy as np

from fdvv.compensation.feasibility.limits import RigLimits
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.errors import ModelError
from fdvv.model.bump import running_mean
from fdvv.units import FloatArray

SHORTEST_s = 1e-5
"""Lower bound of lags: far below a tick, and avoids division by 0."""
LEAST_kg = 5e-4  # half the prior's least (RANGES: 1 g); below it an identification is assumed wrong
PLACE, SPEED, COIL, SEEN, FINGER, FINGER_SPEED, ARM = range(7)


@dataclass(frozen=True)
class NominalFinger:
    """A finger that holds a cap down: mass on a spring and damper, behind a pad that stiffens with force.

    The pad is F = scale (exp(exponent depth) - 1), a part of it relaxing in relax_s; linearized at the force
    held. Figures: middle of the ranges of Hajian and Howe 1997 and Pawluk and Howe 1999, as in the twin.
    """

    mass_kg: float = 0.007
    stiffness_N_m: float = 450.0
    damping_N_s_m: float = 4.5
    pad_1_m: float = 3000.0
    preload_N: float = 0.2
    relaxing_ratio: float = 0.35
    relax_s: float = 0.004

    def pad_N_m(self, force_cN: float) -> float:
        """Return the pad's stiffness at a held force: exponent (force + preload)."""
        return self.pad_1_m * (0.01 * max(force_cN, 0.0) + self.preload_N)

    def static_N_m(self, force_cN: float) -> float:
        """Return the static stiffness: joint and relaxed pad in series."""
        pad = (1 - self.relaxing_ratio) * self.pad_N_m(force_cN)
        return 1 / (1 / self.stiffness_N_m + 1 / pad)


@dataclass(frozen=True)
class SampledLoop:
    """Cap, coil, position sensor and, if named, a finger, under a table of constant slope.

    Attributes
    ----------
    mass_kg, viscous_N_s_m, braking_N_s_m : of the cap; the last passes through the coil's lag.
    lag_s, seen_lag_s : first-order lags of coil and position sensor.
    compute_s : from the reading to the new drive, which is then held for tick_s.
    finger, held_cN : the finger on the cap, and its force.
    """

    mass_kg: float
    viscous_N_s_m: float
    braking_N_s_m: float
    lag_s: float
    seen_lag_s: float
    compute_s: float
    tick_s: float
    finger: NominalFinger | None = None
    held_cN: float = 0.0

    def __post_init__(self) -> None:
        if self.mass_kg < LEAST_kg:
            raise ModelError(
                f"the rig's mass of {1e3 * self.mass_kg:.2g} g is implausible; identify it again"
            )

    @classmethod
    def of_rig(
        cls,
        rig: RigModel,
        tick_s: float,
        displacement_mm: float,
        finger: NominalFinger | None = None,
        held_cN: float = 0.0,
    ) -> SampledLoop:
        """Return the loop of a rig at one displacement; delay_s splits into hold, lag and computing."""
        emf = rig.back_emf_N_s_m * float(rig.gain_at(np.array(displacement_mm))) ** 2
        return cls(
            1e-3 * rig.mass_g,
            max(0.0, rig.drag_N_s_m - rig.back_emf_N_s_m),
            max(0.0, emf),
            max(SHORTEST_s, rig.electric_lag_s),
            max(SHORTEST_s, rig.position_lag_s),
            max(0.0, rig.delay_s - rig.electric_lag_s - 0.5 * tick_s),
            tick_s,
            finger,
            held_cN,
        )

    @cached_property
    def rates(self) -> FloatArray:
        """A of s' = A s + b u: position, speed, coil, sensed position, finger, its speed, relaxation."""
        out = np.zeros((7, 7))
        out[PLACE, SPEED] = 1.0
        out[SPEED, [SPEED, COIL]] = -self.viscous_N_s_m / self.mass_kg, -1 / self.mass_kg
        out[COIL, [SPEED, COIL]] = self.braking_N_s_m / self.lag_s, -1 / self.lag_s
        out[SEEN, [PLACE, SEEN]] = 1 / self.seen_lag_s, -1 / self.seen_lag_s
        return out[:4, :4] if self.finger is None else self._with_finger(out, self.finger)

    def _with_finger(self, out: FloatArray, finger: NominalFinger) -> FloatArray:
        pad = finger.pad_N_m(self.held_cN)
        kept, arm = (1 - finger.relaxing_ratio) * pad, finger.relaxing_ratio * pad
        out[SPEED, [PLACE, FINGER, ARM]] = np.array([-kept, kept, 1.0]) / self.mass_kg
        joint = -finger.stiffness_N_m - kept
        out[FINGER, FINGER_SPEED] = 1.0
        forces = np.array([kept, joint, -finger.damping_N_s_m, -1.0])
        out[FINGER_SPEED, [PLACE, FINGER, FINGER_SPEED, ARM]] = forces / finger.mass_kg
        out[ARM, [SPEED, FINGER_SPEED, ARM]] = -arm, arm, -1 / finger.relax_s
        return out

    @cached_property
    def steps(self) -> tuple[FloatArray, FloatArray, FloatArray, int]:
        """Return (transition of a tick, input of older command, of newer command, whole ticks of delay)."""
        # b of s' = A s + b u: a commanded force, already times the gain, in N
        push = np.zeros(self.rates.shape[0])
        push[COIL] = 1 / self.lag_s
        whole = int(self.compute_s / self.tick_s + 1e-9)
        old_s = max(0.0, self.compute_s - whole * self.tick_s)
        first, older = _discretize(self.rates, push, old_s)
        second, newer = _discretize(self.rates, push, self.tick_s - old_s)
        return second @ first, second @ older, newer, whole


def _discretize(rates: FloatArray, push: FloatArray, span_s: float) -> tuple[FloatArray, FloatArray]:
    """Return transition and input matrix over a span with constant force."""
    from scipy.linalg import expm

    n = rates.shape[0]
    whole = np.zeros((n + 1, n + 1))
    whole[:n, :n], whole[:n, n] = rates * span_s, push * span_s
    out = expm(whole)
    return out[:n, :n], out[:n, n]


def tick_matrix(loop: SampledLoop, stiffness_N_m: float) -> FloatArray:
    """Map state and pending commands, newest first, over one tick, for a table of constant slope."""
    over, older, newer, whole = loop.steps
    n, count = over.shape[0], int(whole) + 1
    out = np.zeros((n + count, n + count))
    out[:n, :n] = over
    now = np.zeros(n + count)
    now[SEEN] = stiffness_N_m
    out[:n, n + count - 1] += older
    if count == 1:
        out[:n] += np.outer(newer, now)
    else:
        out[:n, n + count - 2] += newer
    out[n] = now
    out[n + 1 :, n : n + count - 1] = np.eye(count - 1)
    return out


def spectral_radius(loop: SampledLoop, stiffness_N_m: float) -> float:
    """Return the spectral radius of one tick: the loop is unstable above 1."""
    return float(np.abs(np.linalg.eigvals(tick_matrix(loop, stiffness_N_m))).max())


def stiffness_limit_N_m(loop: SampledLoop, least_N_m: float = 1.0, most_N_m: float = 1e6) -> float:
    """Return the stiffness at which the spectral radius of one tick reaches 1, by bisection.

    Exact for the linear loop; least_N_m if no larger stiffness is stable.
    """
    low, high = least_N_m, most_N_m
    for _ in range(36):
        middle = math.sqrt(low * high)
        low, high = (low, middle) if spectral_radius(loop, middle) > 1 else (middle, high)
    return low


cN_mm_PER_N_m = 0.1
SPAN_mm = 0.05
"""Slopes are those of the force averaged over this length, the step of a table."""
HUNTS = 0.55
"""A step with a smaller margin may limit-cycle: on most rigs drag and friction damp a smaller one
(simulated, seeds 300 to 329 of the benchmark)."""
END_mm = 0.1
"""Within this distance of either end of the travel a stop carries the cap."""
ENOUGH, BUZZES = 1.2, 0.5
"""From the first margin on a curve is stable, below the second it buzzes. In between it depends on fingers
that differ from the nominal one, and on friction, which the linear loop leaves out."""


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
    passive_cN_mm : below it no passive finger can destabilize the loop (Colgate-Brown with delay).
    grain_cN_mm : below it friction dissipates the energy of quantization (Abbott-Okamura).
    alone_cN_mm, finger_cN_mm : onset of instability at the steepest rise, without and with a finger.
    step_cN, step_mm : largest excess of press over release, and where; 0 where only one curve is judged.
    step_limit_cN : up to it a finger that rests on the step is stable under any disturbance.
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
        """Onset of instability with a finger, over the steepest rise."""
        return self.finger_cN_mm / max(self.slope.rise_cN_mm, 1e-9)

    @property
    def step_margin(self) -> float:
        """Largest stable step over that of the curve."""
        return self.step_limit_cN / max(self.step_cN, 1e-9)

    @property
    def holds(self) -> str:
        """Strongest statement that holds, from "passive for every finger" down to "buzzes"."""
        rise = self.slope.rise_cN_mm
        if self.margin < ENOUGH or self.step_margin < HUNTS:
            return "buzzes" if self.margin < BUZZES else "may buzz"
        if rise <= min(self.passive_cN_mm, self.grain_cN_mm):
            return "passive for every finger"
        return "stable even alone" if rise <= self.alone_cN_mm else "stable with a finger on it"

    def to_dict(self) -> dict[str, Any]:
        return {"holds": self.holds, "margin": self.margin, "step_margin": self.step_margin, **asdict(self)}


def passive_limit_N_m(rig: RigModel, tick_s: float, displacement_mm: float) -> float:
    """Return the stiffness up to which the loop is passive: b / (T/2 + t_d).

    b is the drag at that displacement, t_d the delay beyond half a tick: computing, the coil's lag,
    the sensed position's age. Without delay it is Colgate and Brown's b > K T/2 + |B| (1994; no damping B is
    rendered): K < 2 b / T. With delay it is the rule to first order in it (Diolaiti et al. 2006); that the
    coil's part of the drag lags too makes it optimistic.
    """
    late_s = max(0.5 * tick_s, rig.delay_s) + rig.position_lag_s
    return max(0.0, float(rig.drag_at(np.array(displacement_mm)))) / late_s


def grain_limit_N_m(rig: RigModel, limits: RigLimits, displacement_mm: float) -> float:
    """Return min(2 b / T, 2 f / grain): above it quantization adds more energy than is dissipated.

    Source: Abbott and Okamura 2005. The grain is of one reading; a mean of noisy readings has a finer one.
    """
    drag = max(0.0, float(rig.drag_at(np.array(displacement_mm))))
    return min(2 * drag / limits.tick_s, 1e-2 * 2 * rig.friction_cN / (1e-3 * limits.grain_mm))


def steepest(displacement_mm: FloatArray, force_cN: FloatArray) -> Slope:
    """Return the steepest rise and fall of a curve, (n,) over rising displacement, END_mm from either end.

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
    """Return the step between press and release up to which a resting finger is stable.

    A cap that returns by the reversal distance switches to the other table. Its equilibria under press and
    release table are (step - 2 friction) / (K finger + K) apart. While that is less than the reversal
    distance, no switch occurs at rest: 2 friction + reversal (K finger + K). Beyond it the cap can
    limit-cycle between both, depending on drag and inertia.
    """
    held_N_m = finger.static_N_m(held_cN) + stiffness_N_m
    return 2 * friction_cN + cN_mm_PER_N_m * reversal_mm * held_N_m


def stability(
    rig: RigModel,
    limits: RigLimits,
    displacement_mm: FloatArray,
    force_cN: FloatArray,
    over_cN: FloatArray | None = None,
    finger: NominalFinger | None = None,
) -> Stability:
    """Judge a curve, (n,) over rising displacement, at its steepest rise and at its largest step.

    over_cN : the press curve of a release, (n,) at the same displacements: judges the step between them too.
    finger : on the cap; a nominal one if None. A steep fall does not buzz: the cap snaps through there,
    as on the button. Raises ModelError on an implausible rig or a curve that is too short.
    """
    slope, hand, tick_s = steepest(displacement_mm, force_cN), finger or NominalFinger(), limits.tick_s
    place, held_cN = slope.rise_mm, slope.rise_cN
    loops = [SampledLoop.of_rig(rig, tick_s, place, who, held_cN) for who in (None, hand)]
    bounds = [passive_limit_N_m(rig, tick_s, place), grain_limit_N_m(rig, limits, place)]
    bounds += [stiffness_limit_N_m(loop) for loop in loops]
    over = force_cN if over_cN is None else over_cN
    step = _step(rig, limits, displacement_mm, over, force_cN, hand)
    passive, grain, bare, hand_on = (cN_mm_PER_N_m * bound for bound in bounds)
    return Stability(slope, passive, grain, bare, hand_on, *step)


def _step(
    rig: RigModel,
    limits: RigLimits,
    x: FloatArray,
    over_cN: FloatArray,
    under_cN: FloatArray,
    finger: NominalFinger,
) -> tuple[float, float, float]:
    """Return the largest step between two curves, where it is, and the largest stable one there."""
    step, middle = over_cN - under_cN, 0.5 * (over_cN + under_cN)
    free = (x >= x[0] + END_mm) & (x <= x[-1] - END_mm)
    at = int(np.argmax(np.where(free, step, -np.inf)))
    # where both fall the cap snaps through and holds no stiffness
    flank_N_m = max(0.0, float(np.gradient(running_mean(x, middle, SPAN_mm), x)[at])) / cN_mm_PER_N_m
    quiet = step_limit_cN(finger, float(middle[at]), flank_N_m, limits.reversal_mm, rig.friction_cN)
    return max(0.0, float(step[at])), float(x[at]), quiet

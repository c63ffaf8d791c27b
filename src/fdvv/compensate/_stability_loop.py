"""The sampled loop of a known rig as matrices, with or without a nominal finger on the cap.

Sources: sampled-data systems with a fractional input delay by matrix exponentials (Astrom and Wittenmark,
Computer-Controlled Systems); the rig as KnownRig has it, without friction, which only helps.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fdvv.compensate._known_rig import KnownRig
from fdvv.errors import ModelError
from fdvv.units import FloatArray

SHORTEST_s = 1e-5
"""A lag that is shorter, or none, is taken as this long: far below a tick, and no division by 0."""
LEAST_kg = 5e-4
Steps = tuple[FloatArray, FloatArray, FloatArray, int]
PLACE, SPEED, COIL, SEEN, FINGER, FINGER_SPEED, ARM = range(7)


@dataclass(frozen=True)
class NominalFinger:
    """A finger that holds a cap down: mass on a spring and damper, behind a pulp that stiffens with force.

    The pulp is F = scale (exp(exponent depth) - 1), a part of it relaxing in relax_s; linear about the force
    held. Figures: middle of the ranges of Hajian and Howe 1997 and Pawluk and Howe 1999, as the twin has.
    """

    mass_kg: float = 0.007
    stiffness_N_m: float = 450.0
    damping_N_s_m: float = 4.5
    pulp_1_m: float = 3000.0
    preload_N: float = 0.2
    relaxing_ratio: float = 0.35
    relax_s: float = 0.004

    def pulp_N_m(self, force_cN: float) -> float:
        """Give the pulp's stiffness at a held force: exponent (force + preload)."""
        return self.pulp_1_m * (0.01 * max(force_cN, 0.0) + self.preload_N)

    def static_N_m(self, force_cN: float) -> float:
        """Give the stiffness that holds a cap for long: joint and relaxed pulp in series."""
        pulp = (1 - self.relaxing_ratio) * self.pulp_N_m(force_cN)
        return 1 / (1 / self.stiffness_N_m + 1 / pulp)


@dataclass(frozen=True)
class SampledLoop:
    """Cap, coil, position sensor and, if named, a finger, under a table of constant slope.

    Attributes
    ----------
    mass_kg, viscous_N_s_m, braking_N_s_m : of the cap; the last passes through the coil's lag.
    lag_s, seen_lag_s : first-order lags of coil and position sensor.
    compute_s : from the reading to the new drive, which is then held for tick_s.
    finger, held_cN : who holds the cap, and with what force.
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
                f"the known rig's mass of {1e3 * self.mass_kg:.2g} g cannot be; identify it again"
            )

    @classmethod
    def of_known(
        cls,
        known: KnownRig,
        tick_s: float,
        displacement_mm: float,
        finger: NominalFinger | None = None,
        held_cN: float = 0.0,
    ) -> SampledLoop:
        """Give the loop of a known rig at one place; the parts of delay_s are held time, lag and the rest."""
        emf = known.back_emf_N_s_m * float(known.gain_at(np.array(displacement_mm))) ** 2
        return cls(
            1e-3 * known.mass_g,
            max(0.0, known.drag_N_s_m - known.back_emf_N_s_m),
            max(0.0, emf),
            max(SHORTEST_s, known.electric_lag_s),
            max(SHORTEST_s, known.position_lag_s),
            max(0.0, known.delay_s - known.electric_lag_s - 0.5 * tick_s),
            tick_s,
            finger,
            held_cN,
        )

    @property
    def rates(self) -> FloatArray:
        """Give A of s' = A s + b u: place, speed, coil force, place seen, finger, its speed, relaxing arm."""
        out = np.zeros((7, 7))
        out[PLACE, SPEED] = 1.0
        out[SPEED, [SPEED, COIL]] = -self.viscous_N_s_m / self.mass_kg, -1 / self.mass_kg
        out[COIL, [SPEED, COIL]] = self.braking_N_s_m / self.lag_s, -1 / self.lag_s
        out[SEEN, [PLACE, SEEN]] = 1 / self.seen_lag_s, -1 / self.seen_lag_s
        return out[:4, :4] if self.finger is None else self._with_finger(out, self.finger)

    def _with_finger(self, out: FloatArray, finger: NominalFinger) -> FloatArray:
        pulp = finger.pulp_N_m(self.held_cN)
        kept, arm = (1 - finger.relaxing_ratio) * pulp, finger.relaxing_ratio * pulp
        out[SPEED, [PLACE, FINGER, ARM]] = np.array([-kept, kept, 1.0]) / self.mass_kg
        joint = -finger.stiffness_N_m - kept
        out[FINGER, FINGER_SPEED] = 1.0
        out[FINGER_SPEED, [PLACE, FINGER, FINGER_SPEED, ARM]] = (
            np.array([kept, joint, -finger.damping_N_s_m, -1.0]) / finger.mass_kg
        )
        out[ARM, [SPEED, FINGER_SPEED, ARM]] = -arm, arm, -1 / finger.relax_s
        return out

    @property
    def push(self) -> FloatArray:
        """Give b of s' = A s + b u, (states,): a commanded force, already times the gain, in N."""
        out = np.zeros(self.rates.shape[0])
        out[COIL] = 1 / self.lag_s
        return out

    def steps(self) -> Steps:
        """Give (over a tick, effect of the older command, of the newer one, whole ticks of delay)."""
        whole = int(self.compute_s / self.tick_s + 1e-9)
        old_s = max(0.0, self.compute_s - whole * self.tick_s)
        first, older = _held(self.rates, self.push, old_s)
        second, newer = _held(self.rates, self.push, self.tick_s - old_s)
        return second @ first, second @ older, newer, whole


def _held(rates: FloatArray, push: FloatArray, span_s: float) -> tuple[FloatArray, FloatArray]:
    """Give the transition over a span and the effect of a force held in it."""
    from scipy.linalg import expm

    n = rates.shape[0]
    whole = np.zeros((n + 1, n + 1))
    whole[:n, :n], whole[:n, n] = rates * span_s, push * span_s
    out = expm(whole)
    return out[:n, :n], out[:n, n]


def tick_matrix(loop: SampledLoop, stiffness_N_m: float, steps: Steps | None = None) -> FloatArray:
    """Map state and pending commands, newest first, from one tick to the next, for a table of constant slope.

    steps : loop.steps(), if it is known already.
    """
    over, older, newer, whole = steps or loop.steps()
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


def spectral_radius(loop: SampledLoop, stiffness_N_m: float, steps: Steps | None = None) -> float:
    """Give the size of the largest eigenvalue of one tick: above 1 the loop swings up."""
    values: FloatArray = np.abs(np.linalg.eigvals(tick_matrix(loop, stiffness_N_m, steps)))
    return float(values.max())


def stiffness_limit_N_m(loop: SampledLoop, least_N_m: float = 1.0, most_N_m: float = 1e6) -> float:
    """Give the stiffness at which the largest eigenvalue of one tick reaches 1, by bisection.

    Exact for the linear loop; without a stable stiffness above least_N_m, that.
    """
    steps = loop.steps()
    low, high = least_N_m, most_N_m
    for _ in range(36):
        middle = math.sqrt(low * high)
        low, high = (low, middle) if spectral_radius(loop, middle, steps) > 1 else (middle, high)
    return low

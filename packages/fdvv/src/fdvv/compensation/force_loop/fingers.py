"""Fingers that hold a cap, as dynamic stiffness: what the force loop must be stable against."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

from fdvv.units import ComplexArray

HELD_N = (0.05, 0.2, 0.5, 1.0)
DRAWN = 9
"""Drawn fingers; each is held at every force of HELD_N, relaxed and not, stiff and slack in its joint."""

# Hajian and Howe 1997 for the joint, Pawluk and Howe 1999 for the pad: the twin's ranges (docs: twin.md)
LOW = (0.0035, 255.0, 4.0, 2000.0, 0.08, 0.2, 0.3)
HIGH = (0.0087, 1255.0, 7.4, 4000.0, 0.15, 0.4, 0.7)
# a fingernail, and a hand behind a stiff finger
NAIL = (0.0087, 1255.0, 4.0, 15000.0, 0.15, 0.9, 0.5)
HEAVY = (0.05, 1500.0, 15.0, 3000.0, 0.12, 0.3, 0.5)
FAST_s, SLOW_s = 0.004, 0.1
STIFFENED_ratio = 0.22
"""A person stiffens or slackens the joint by this between presses."""


@dataclass(frozen=True)
class HeldFinger:
    """A finger on the cap at one force, linearised: joint behind a pad that stiffens with force.

    Attributes
    ----------
    mass_kg, stiffness_N_m, damping_N_s_m : of the joint, about the tip.
    pad_1_m, pad_N : exponent and force scale of the pad, F = pad_N (exp(pad_1_m depth) - 1).
    relaxed_ratio : part of the pad's stiffness that does not relax.
    fast_ratio : share of what relaxes within FAST_s; the rest takes SLOW_s.
    held_N : force at which it is held.
    fresh : the force has just been reached, so that the pad has not relaxed.
    """

    mass_kg: float
    stiffness_N_m: float
    damping_N_s_m: float
    pad_1_m: float
    pad_N: float
    relaxed_ratio: float
    fast_ratio: float
    held_N: float
    fresh: bool

    def dynamic_stiffness_N_m(self, s: ComplexArray) -> ComplexArray:
        """Return force over displacement at the skin, the shape of s."""
        relaxing = 1 - self.relaxed_ratio
        fast, slow = relaxing * self.fast_ratio, relaxing * (1 - self.fast_ratio)
        # the static force is borne by the arms that have not relaxed yet
        bearing = self.relaxed_ratio + (slow + 0.5 * fast if self.fresh else 0.0)
        tangent = self.pad_1_m * (self.held_N / bearing + self.pad_N)
        arms = fast * s * FAST_s / (1 + s * FAST_s) + slow * s * SLOW_s / (1 + s * SLOW_s)
        pad = tangent * (self.relaxed_ratio + arms)
        joint = self.mass_kg * s**2 + self.damping_N_s_m * s + self.stiffness_N_m
        return pad * joint / (pad + joint)


def in_series(first: ComplexArray, second: ComplexArray) -> ComplexArray:
    """Return the dynamic stiffness of two elements in series."""
    return first * second / (first + second)


@cache
def finger_bank() -> tuple[HeldFinger, ...]:
    """Return drawn fingers over the published ranges, a fingernail, and a heavy hand."""
    from scipy.stats import qmc

    drawn = qmc.scale(qmc.Halton(7, seed=1).random(DRAWN), LOW, HIGH)
    return tuple(finger for row in [*drawn.tolist(), NAIL, HEAVY] for finger in _held(*row))


def _held(mass_kg: float, stiffness_N_m: float, damping_N_s_m: float, *pad: float) -> Iterator[HeldFinger]:
    pad_1_m, pad_N, relaxed_ratio, fast_ratio = pad
    for held_N in HELD_N:
        for fresh in (False, True):
            joint = 1 + STIFFENED_ratio * (1 if fresh else -1)
            impedance = (mass_kg, joint * stiffness_N_m, joint * damping_N_s_m)
            yield HeldFinger(*impedance, pad_1_m, pad_N, relaxed_ratio, fast_ratio, held_N, fresh)

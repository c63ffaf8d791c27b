"""Stability of the force loop over a bank of fingers that hold the cap, and the error that it leaves.

With D the delays of a loop, C the controller, B its damping, Z the cap's dynamic stiffness, H that of finger,
plate and cell, and T' the slope of the target, the loop's transfer function is

    L = D [C (H - m_t s^2) + (1 + C) T' + B] / (Z + H)

and what the finger feels of the cap's own dynamics is -Z x / (1 + C D), whatever the finger.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np

from fdvv.units import ComplexArray, FloatArray

HELD_N = (0.05, 0.2, 0.5, 1.0)
DRAWN = 9
"""Drawn fingers; each is held at every force of HELD_N, relaxed and not, stiff and slack in its joint."""

# Hajian and Howe 1997 for the joint, Pawluk and Howe 1999 for the pad: the twin's ranges (docs: twin.md)
LOW = (0.0035, 255.0, 4.0, 2000.0, 0.08, 0.2, 0.3)
HIGH = (0.0087, 1255.0, 7.4, 4000.0, 0.15, 0.4, 0.7)  # upper ends; the joint as recalled, the pad's assumed
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
    return tuple(finger for row in [*drawn.tolist(), NAIL, HEAVY] for finger in _grips(*row))


def _grips(mass_kg: float, stiffness_N_m: float, damping_N_s_m: float, *pad: float) -> Iterator[HeldFinger]:
    pad_1_m, pad_N, relaxed_ratio, fast_ratio = pad
    for held_N in HELD_N:
        for fresh in (False, True):
            joint = 1 + STIFFENED_ratio * (1 if fresh else -1)
            impedance = (mass_kg, joint * stiffness_N_m, joint * damping_N_s_m)
            yield HeldFinger(*impedance, pad_1_m, pad_N, relaxed_ratio, fast_ratio, held_N, fresh)


SLOPES_N_m = (0.0, 500.0, 1300.0)
"""Of targets: flat, a usual flank, and the steepest of a Cherry MX Blue."""
CELL_ratios = (0.6, 1.0, 1.5)
"""The stiffness of a cell is known to this."""
LOOP_Hz = np.geomspace(4.0, 4900.0, 240)
FELT_Hz = np.array([10.0, 20.0, 40.0, 70.0, 100.0])
LARGEST_PEAK = 2.5
"""Of the sensitivity: a gain margin of at least 1.67 and a phase margin of at least 23 degrees."""
COUNTED_quantile = 0.97  # assumed: 24 of 792 cases may peak higher; a stricter bound takes gain from all


@dataclass(frozen=True)
class LoopPlant:
    """What the loop acts on.

    Attributes
    ----------
    mass_kg : of what moves, without plate_kg, between finger and cell. drag_N_s_m : of the bushing.
    cell_N_m, cell_N_s_m : stiffness and damping of the cell.
    coil_s, cell_s : first-order lags of the coil's force and the cell's reading.
    delay_s : computing, and half a tick of holding.
    """

    mass_kg: float
    plate_kg: float
    drag_N_s_m: float
    cell_N_m: float
    cell_N_s_m: float
    coil_s: float
    cell_s: float
    delay_s: float

    @property
    def age_s(self) -> float:
        """From a force at the finger to the coil's answer."""
        return self.delay_s + self.coil_s + self.cell_s

    def actuator_response(self, s: ComplexArray) -> ComplexArray:
        """Return D, from a force at the finger to the coil's answer, the shape of s."""
        return np.exp(-s * self.delay_s) / (1 + s * self.coil_s) / (1 + s * self.cell_s)


@dataclass(frozen=True)
class LoopController:
    """Gains of the loop, in SI units.

    Fed back are the error of force, times proportional + derivative_s s, twice through a low pass; its
    integral, which leaks in half a second; and the cap's velocity above highpass_Hz, times damping_N_s_m.
    """

    proportional: float
    derivative_s: float
    lowpass_Hz: float
    integral_1_s: float
    damping_N_s_m: float
    highpass_Hz: float

    def on_force(self, s: ComplexArray) -> ComplexArray:
        roll_off = 1 / (1 + s / (2 * np.pi * self.lowpass_Hz)) ** 2
        return (self.proportional + self.derivative_s * s) * roll_off + self.integral_1_s / (s + 2.0)

    def on_motion(self, s: ComplexArray) -> ComplexArray:
        return self.damping_N_s_m * s**2 / (s + 2 * np.pi * self.highpass_Hz)


class FingerBank:
    """A plant under many fingers: responses that do not depend on the controller."""

    def __init__(self, plant: LoopPlant, fingers: tuple[HeldFinger, ...] | None = None) -> None:
        self.plant = plant
        self._fingers = finger_bank() if fingers is None else fingers

    @cached_property
    def _s(self) -> ComplexArray:
        return (2j * np.pi * LOOP_Hz).astype(np.complex128)

    @cached_property
    def _dynamic_stiffness_N_m(self) -> ComplexArray:
        """Dynamic stiffness of finger, plate and cell, (members, frequencies)."""
        s, plant = self._s, self.plant
        plate = plant.plate_kg * s**2
        tops = [plate + finger.dynamic_stiffness_N_m(s) for finger in self._fingers]
        cells = [ratio * plant.cell_N_m + plant.cell_N_s_m * s for ratio in CELL_ratios]
        return np.stack([in_series(cell, top) for cell in cells for top in tops])

    @cached_property
    def _actuator_response(self) -> ComplexArray:
        return self.plant.actuator_response(self._s)

    def loop(self, controller: LoopController) -> ComplexArray:
        """Return the loop's transfer function, (slopes, members, frequencies)."""
        s, plant, held = self._s, self.plant, self._dynamic_stiffness_N_m
        on_force, on_motion = controller.on_force(s), controller.on_motion(s)
        cap = plant.mass_kg * s**2 + plant.drag_N_s_m * s
        fed = on_force * (held - plant.plate_kg * s**2) + on_motion
        slopes = np.array(SLOPES_N_m)[:, None, None]
        transfer: ComplexArray = self._actuator_response * (fed + (1 + on_force) * slopes) / (cap + held)
        return transfer

    def peaks(self, controller: LoopController) -> FloatArray:
        """Return the peak of the sensitivity, (slopes, members); infinite where the loop is unstable."""
        around = 1 + self.loop(controller)
        turned = np.unwrap(np.angle(around), axis=-1)
        encircled = np.abs(turned[..., -1] - turned[..., 0]) > np.pi
        return np.where(encircled, np.inf, 1 / np.abs(around).min(-1))

    def residual_ratio(self, controller: LoopController) -> FloatArray:
        """Return the part of the cap's own dynamics that is felt, at the frequencies FELT_Hz."""
        s, plant = 2j * np.pi * FELT_Hz, self.plant
        motion = np.abs(1 + controller.on_motion(s) / (plant.mass_kg * s**2))
        return np.asarray(motion / np.abs(1 + controller.on_force(s) * plant.actuator_response(s)))

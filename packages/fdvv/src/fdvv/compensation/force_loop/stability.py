"""Stability of the force loop over a bank of fingers, and the error that it leaves.

With D the delays of a loop, C the controller, B its damping, Z the cap's dynamic stiffness, H that of finger,
plate and cell, and T' the slope of the target, the loop's transfer function is

    L = D [C (H - m_t s^2) + (1 + C) T' + B] / (Z + H)

and what the finger feels of the cap's own dynamics is -Z x / (1 + C D), whatever the finger.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fdvv.compensation.force_loop.fingers import HeldFinger, finger_bank, in_series
from fdvv.units import ComplexArray, FloatArray

SLOPES_N_m = (0.0, 500.0, 1300.0)
"""Of targets: flat, a usual flank, and the steepest of a Cherry MX Blue."""
CELL_ratios = (0.6, 1.0, 1.5)
"""The stiffness of a cell is known to this."""
LOOP_Hz = np.geomspace(4.0, 4900.0, 240)
FELT_Hz = np.array([10.0, 20.0, 40.0, 70.0, 100.0])
LARGEST_PEAK = 2.5
"""Of the sensitivity: a gain margin of at least 1.67 and a phase margin of at least 23 degrees."""
COUNTED_quantile = 0.97


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

    def delayed(self, s: ComplexArray) -> ComplexArray:
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
    def _held(self) -> ComplexArray:
        """Dynamic stiffness of finger, plate and cell, (members, frequencies)."""
        s, plant = self._s, self.plant
        plate = plant.plate_kg * s**2
        tops = [plate + finger.dynamic_stiffness_N_m(s) for finger in self._fingers]
        cells = [ratio * plant.cell_N_m + plant.cell_N_s_m * s for ratio in CELL_ratios]
        return np.stack([in_series(cell, top) for cell in cells for top in tops])

    @cached_property
    def _delayed(self) -> ComplexArray:
        return self.plant.delayed(self._s)

    def loop(self, controller: LoopController) -> ComplexArray:
        """Return the loop's transfer function, (slopes, members, frequencies)."""
        s, plant, held = self._s, self.plant, self._held
        on_force, on_motion = controller.on_force(s), controller.on_motion(s)
        cap = plant.mass_kg * s**2 + plant.drag_N_s_m * s
        fed = on_force * (held - plant.plate_kg * s**2) + on_motion
        slopes = np.array(SLOPES_N_m)[:, None, None]
        found: ComplexArray = self._delayed * (fed + (1 + on_force) * slopes) / (cap + held)
        return found

    def peaks(self, controller: LoopController) -> FloatArray:
        """Return the peak of the sensitivity, (slopes, members); infinite where the loop is unstable."""
        around = 1 + self.loop(controller)
        turned = np.unwrap(np.angle(around), axis=-1)
        encircled = np.abs(turned[..., -1] - turned[..., 0]) > np.pi
        return np.where(encircled, np.inf, 1 / np.abs(around).min(-1))

    def left(self, controller: LoopController) -> FloatArray:
        """Return the part of the cap's own dynamics that is felt, at the frequencies FELT_Hz."""
        s, plant = 2j * np.pi * FELT_Hz, self.plant
        motion = np.abs(1 + controller.on_motion(s) / (plant.mass_kg * s**2))
        return np.asarray(motion / np.abs(1 + controller.on_force(s) * plant.delayed(s)))

"""How the force at the finger answers a change of its target, and the filter from error to correction.

A finger gives way to a change of force, and the cap moves with it. With D, C, B, Z and H of `stability`, T'
the slope of the target, and the error taken at the displacement where it is felt,

    R = error taken away / change of the target = 1 / (1 + (Z + D B) / ((H + T') (1 + D C)))

From 100 Hz on a soft finger turns the phase of R beyond 90 degrees. A correction by the error itself grows
there from press to press; one by the error through the inverse of R, which may look ahead, does not.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from fdvv.compensation.force_loop.fingers import HeldFinger, finger_bank, in_series
from fdvv.compensation.force_loop.stability import LoopController, LoopPlant
from fdvv.units import ComplexArray, FloatArray

PRESSING_N = 0.2
"""A finger that presses holds the cap at least with this."""
SLOPE_N_m = 500.0
"""Of a usual flank."""
DOUBT, DOUBT_Hz = 0.3, 600.0
"""The inverse is not trusted where fingers differ, and less with the square of frequency."""
LONGEST_s = 0.025
"""Of the inverse's answer to an impulse, to both sides."""
LOWEST_Hz = 0.5


def pressing_fingers() -> tuple[HeldFinger, ...]:
    """Return the fingers of the bank that press: they hold the cap, and their pads have not relaxed."""
    return tuple(finger for finger in finger_bank() if finger.held_N >= PRESSING_N and finger.fresh)


@dataclass(frozen=True)
class LoopResponse:
    """A plant with its loop closed, under the fingers that may press it."""

    plant: LoopPlant
    controller: LoopController
    fingers: tuple[HeldFinger, ...] = field(default_factory=pressing_fingers)

    def follows(self, frequency_Hz: FloatArray) -> ComplexArray:
        """Return R of every finger, (fingers, frequencies)."""
        s, plant = (2j * np.pi * frequency_Hz).astype(np.complex128), self.plant
        delayed = plant.delayed(s)
        cap = plant.mass_kg * s**2 + delayed * self.controller.on_motion(s)
        felt = cap / (1 + delayed * self.controller.on_force(s))
        cell = plant.cell_N_m + plant.cell_N_s_m * s
        tops = [plant.plate_kg * s**2 + finger.dynamic_stiffness_N_m(s) for finger in self.fingers]
        return np.stack([1 / (1 + felt / (in_series(cell, top) + SLOPE_N_m)) for top in tops])

    def left_N(self, acceleration_m_s2: FloatArray, tick_s: float) -> FloatArray:
        """Return what the loop leaves of the force of the cap's own dynamics, (n,): Z x / (1 + D C)."""
        size = 2 * acceleration_m_s2.size + round(2 * LONGEST_s / tick_s)
        s = 2j * np.pi * np.maximum(np.fft.rfftfreq(size, tick_s), LOWEST_Hz)
        delayed, plant = self.plant.delayed(s), self.plant
        own_kg = plant.mass_kg + plant.plate_kg + delayed * self.controller.on_motion(s) / s**2
        left = own_kg / (1 + delayed * self.controller.on_force(s))
        return np.fft.irfft(left * np.fft.rfft(acceleration_m_s2, size), size)[: acceleration_m_s2.size]

    def correction(self, error: FloatArray, tick_s: float) -> FloatArray:
        """Return the change of the target that takes an error away, (n,) in its unit, on even ticks.

        The least-squares inverse over all fingers: one filter for whoever presses.
        """
        size = 2 * error.size + round(2 * LONGEST_s / tick_s)
        frequency_Hz = np.maximum(np.fft.rfftfreq(size, tick_s), LOWEST_Hz)
        follows = self.follows(frequency_Hz)
        doubt = DOUBT * (frequency_Hz / DOUBT_Hz) ** 4
        inverse = follows.conj().mean(0) / ((np.abs(follows) ** 2).mean(0) + doubt)
        return np.fft.irfft(inverse * np.fft.rfft(error, size), size)[: error.size]

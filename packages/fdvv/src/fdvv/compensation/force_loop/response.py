"""How the force at the finger answers a change of its target, and how errors correct the target.

A finger gives way to a change of force, and the cap moves with it. With D, C, B, Z and H of `stability`, T'
the slope of the target, and the error taken at the displacement where it is felt,

    R = error taken away / change of the target = 1 / (1 + (Z + D B) / ((H + T') (1 + D C)))

From 100 Hz on a soft finger turns the phase of R beyond 90 degrees. A correction by the error itself grows
there from press to press; one by the error through the inverse of R, which may look ahead, does not.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from fdvv.compensation.force_loop.stability import (
    HeldFinger,
    LoopController,
    LoopPlant,
    finger_bank,
    in_series,
)
from fdvv.compensation.method import error_cN
from fdvv.compensation.rig_learning import PressError
from fdvv.compensation.tables import bin_force, smooth
from fdvv.errors import ModelError
from fdvv.units import ComplexArray, FloatArray, cN_from_N

PRESSING_N = 0.2
"""A finger that presses holds the cap at least with this."""
SLOPE_N_m = 500.0
"""Of a usual flank."""
DOUBT, DOUBT_Hz = 0.3, 600.0
"""The inverse is not trusted where fingers differ, and less with the square of frequency."""
LONGEST_s = 0.025
"""Of the inverse's answer to an impulse, to both sides."""
LOWEST_Hz = 0.5  # in place of 0, a divisor; below the transform's steps for strokes under 0.9 s


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
        actuator = plant.actuator_response(s)
        cap = plant.mass_kg * s**2 + actuator * self.controller.on_motion(s)
        felt = cap / (1 + actuator * self.controller.on_force(s))
        cell = plant.cell_N_m + plant.cell_N_s_m * s
        tops = [plant.plate_kg * s**2 + finger.dynamic_stiffness_N_m(s) for finger in self.fingers]
        return np.stack([1 / (1 + felt / (in_series(cell, top) + SLOPE_N_m)) for top in tops])

    def residual_N(self, acceleration_m_s2: FloatArray, tick_s: float) -> FloatArray:
        """Return what the loop leaves of the force of the cap's own dynamics, (n,): Z x / (1 + D C)."""
        size = 2 * acceleration_m_s2.size + round(2 * LONGEST_s / tick_s)
        s = 2j * np.pi * np.maximum(np.fft.rfftfreq(size, tick_s), LOWEST_Hz)
        actuator, plant = self.plant.actuator_response(s), self.plant
        own_kg = plant.mass_kg + plant.plate_kg + actuator * self.controller.on_motion(s) / s**2
        left = own_kg / (1 + actuator * self.controller.on_force(s))
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


SMOOTHED_mm = 0.04
LARGEST_STEP_cN = 15.0
ENTRY_mm, ENTRY_s, FADE_mm = 0.1, 6e-4, 0.1
"""After contact the loop needs this way, and this long, to hold the force: nothing is learned there, and what
is seen fades in over FADE_mm before."""
STOP_mm = 0.08
FORESEEN_ratio = 0.5
"""Part of a foreseen correction that is applied: the finger is none of those it is foreseen for."""
RUN_UP_mm = 0.5
BEYOND_mm, GIVES_mm = 3.0, 1.2
"""An assumed hand turns so much deeper than the stop, 1.5 N on a joint of 600 N/m and the pad, and gives way
so much to the force of a stroke."""


@dataclass(frozen=True, eq=False)
class StrokeCorrection:
    """One stroke at one speed on a closed loop.

    Attributes
    ----------
    grid_mm, target_cN : (n,) bins and intended force. speed_mm_s : asked for. downward : a press.
    travel_mm : position of the bottom stop. response : of the loop. tick_s : its period.
    """

    grid_mm: FloatArray
    target_cN: FloatArray
    speed_mm_s: float
    downward: bool
    travel_mm: float
    response: LoopResponse
    tick_s: float

    @cached_property
    def holding_range_mm(self) -> tuple[float, float]:
        """Between which displacements the loop holds the force at this speed."""
        return ENTRY_mm + ENTRY_s * self.speed_mm_s, self.travel_mm - STOP_mm

    def foreseen_cN(self) -> FloatArray:
        """Return the correction for a hand that moves evenly, (n,): the target leads what follows it late."""
        step_mm = self.speed_mm_s * self.tick_s
        x_mm = np.arange(self.grid_mm[0] - RUN_UP_mm, self.grid_mm[-1] + RUN_UP_mm, step_mm)
        x_mm = x_mm if self.downward else x_mm[::-1]
        target = np.interp(x_mm, self.grid_mm, self.target_cN) - self.target_cN[0]
        late = self.response.correction(target, self.tick_s) - target
        return FORESEEN_ratio * self._in_bins(x_mm, self._fade(x_mm) * late)

    def hand_cN(self) -> FloatArray:
        """Return the correction for the cap's own dynamics under a hand of minimum jerk, (n,).

        The hand turns BEYOND_mm deeper than the stop, and its finger gives way by GIVES_mm.
        """
        x_mm, a_m_s2 = self._hand()
        left_cN = cN_from_N(self.response.residual_N(a_m_s2, self.tick_s))
        needed = self.response.correction(left_cN, self.tick_s)
        return -self._in_bins(x_mm, self._fade(x_mm) * needed)

    def _hand(self) -> tuple[FloatArray, FloatArray]:
        """Return places and accelerations of the cap, downward, each tick from one stop to the other."""
        whole_mm = self.travel_mm + BEYOND_mm
        part = np.linspace(0.0, 1.0, 2001)
        way_mm = whole_mm * part**3 * (10 - 15 * part + 6 * part**2)
        first, last = np.interp([GIVES_mm, GIVES_mm + self.travel_mm], way_mm, part)
        duration_s = self.travel_mm / (self.speed_mm_s * (last - first))
        at = np.arange(first, last, self.tick_s / duration_s)
        x_mm = np.interp(at, part, way_mm) - GIVES_mm
        a_m_s2 = 1e-3 * whole_mm / duration_s**2 * 60 * at * (1 - at) * (1 - 2 * at)
        # a release is the same way back: the same acceleration at each place
        return (x_mm, a_m_s2) if self.downward else (x_mm[::-1], a_m_s2[::-1])

    def press_error(self, x_mm: FloatArray, force_cN: FloatArray, row_cN: FloatArray) -> PressError:
        """Return the error of a stroke, (m,) ticks, pressed with a row. ModelError if it was not recorded."""
        rendered = bin_force(x_mm, force_cN, self.grid_mm)
        judged = self._inside() & np.isfinite(rendered)
        if not judged.any():
            raise ModelError("a stroke was not recorded")
        off = np.abs(self.target_cN - rendered)[judged]
        whole = error_cN(self.target_cN[judged], rendered[judged])
        return PressError(whole, float(off.mean()), float(off.max()), row_cN)

    def step_cN(self, x_mm: FloatArray, force_cN: FloatArray) -> FloatArray:
        """Return the change of the target, (n,), that takes the error of a stroke, (m,) ticks, away."""
        error = self._fade(x_mm) * (np.interp(x_mm, self.grid_mm, self.target_cN) - force_cN)
        needed = self._in_bins(x_mm, self.response.correction(error, self.tick_s))
        return np.clip(needed, -LARGEST_STEP_cN, LARGEST_STEP_cN)

    def _fade(self, x_mm: FloatArray) -> FloatArray:
        low_mm, high_mm = self.holding_range_mm
        into = np.clip((x_mm - low_mm) / FADE_mm + 1.0, 0.0, 1.0)
        return np.asarray(into * np.clip((high_mm - x_mm) / STOP_mm + 1.0, 0.0, 1.0))

    def _in_bins(self, x_mm: FloatArray, force_cN: FloatArray) -> FloatArray:
        """Return the mean force of each bin that the loop holds, smoothed, (n,); 0 elsewhere."""
        binned = bin_force(x_mm, force_cN, self.grid_mm)
        kept = np.where(self._inside() & np.isfinite(binned), binned, 0.0)
        return smooth(kept, SMOOTHED_mm, float(self.grid_mm[1] - self.grid_mm[0]))

    def _inside(self) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        low_mm, high_mm = self.holding_range_mm
        return (self.grid_mm >= low_mm) & (self.grid_mm <= high_mm)

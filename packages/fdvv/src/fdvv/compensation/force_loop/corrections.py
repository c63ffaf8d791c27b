"""Corrections of the target of a closed loop: what its response foresees, and what a stroke leaves."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fdvv.compensation.force_loop.response import LoopResponse
from fdvv.compensation.method import error_cN
from fdvv.compensation.rig_learning import PressError
from fdvv.compensation.tables import bin_force, smooth
from fdvv.errors import ModelError
from fdvv.units import FloatArray, cN_from_N

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
    def held_mm(self) -> tuple[float, float]:
        """Between which displacements the loop holds the force at this speed."""
        return ENTRY_mm + ENTRY_s * self.speed_mm_s, self.travel_mm - STOP_mm

    def foreseen_cN(self) -> FloatArray:
        """Return the correction for a hand that moves evenly, (n,): the target leads what follows it late."""
        step_mm = self.speed_mm_s * self.tick_s
        x_mm = np.arange(self.grid_mm[0] - RUN_UP_mm, self.grid_mm[-1] + RUN_UP_mm, step_mm)
        x_mm = x_mm if self.downward else x_mm[::-1]
        target = np.interp(x_mm, self.grid_mm, self.target_cN) - self.target_cN[0]
        late = self.response.correction(target, self.tick_s) - target
        return FORESEEN_ratio * self._in_bins(x_mm, self._faded(x_mm) * late)

    def hand_cN(self) -> FloatArray:
        """Return the correction for the cap's own dynamics under a hand of minimum jerk, (n,).

        The hand turns BEYOND_mm deeper than the stop, and its finger gives way by GIVES_mm.
        """
        x_mm, a_m_s2 = self._hand()
        left_cN = cN_from_N(self.response.left_N(a_m_s2, self.tick_s))
        needed = self.response.correction(left_cN, self.tick_s)
        return -self._in_bins(x_mm, self._faded(x_mm) * needed)

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
        error = self._faded(x_mm) * (np.interp(x_mm, self.grid_mm, self.target_cN) - force_cN)
        needed = self._in_bins(x_mm, self.response.correction(error, self.tick_s))
        return np.clip(needed, -LARGEST_STEP_cN, LARGEST_STEP_cN)

    def _faded(self, x_mm: FloatArray) -> FloatArray:
        low_mm, high_mm = self.held_mm
        into = np.clip((x_mm - low_mm) / FADE_mm + 1.0, 0.0, 1.0)
        return np.asarray(into * np.clip((high_mm - x_mm) / STOP_mm + 1.0, 0.0, 1.0))

    def _in_bins(self, x_mm: FloatArray, force_cN: FloatArray) -> FloatArray:
        """Return the mean force of each bin that the loop holds, smoothed, (n,); 0 elsewhere."""
        binned = bin_force(x_mm, force_cN, self.grid_mm)
        kept = np.where(self._inside() & np.isfinite(binned), binned, 0.0)
        return smooth(kept, SMOOTHED_mm, float(self.grid_mm[1] - self.grid_mm[0]))

    def _inside(self) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        low_mm, high_mm = self.held_mm
        return (self.grid_mm >= low_mm) & (self.grid_mm <= high_mm)

"""From rig, finger, gesture and table to the record of one press."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.model import ForceSurface, Press
from fdvv.twin._finger import Finger
from fdvv.twin._flatten import STEP_s, grid_of, inputs_of, plant_of
from fdvv.twin._gesture import Gesture
from fdvv.twin._kernel import run
from fdvv.twin._noise import Noise
from fdvv.twin._rig import Rig
from fdvv.units import FloatArray, cN_from_N, mm_from_m

BoolArray = npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Trace:
    """All that the twin knows of one press, simulated; every column (n,) on one 10 kHz clock.

    Attributes
    ----------
    t_s : from 0.
    displacement_mm, cap_velocity_mm_s : of the cap, true.
    force_cN : between cap and sensor cone, true.
    sensed_mm, sensed_cN, commanded_cN, saturated, release : as the controller has them, held between ticks.
    tick : rows at which the controller ran.
    current_A : in the coil.
    finger_mm : of the finger.
    energy_J : energy that the balance cannot account for, 0 if integration were exact; None if not asked.
    """

    t_s: FloatArray
    displacement_mm: FloatArray
    cap_velocity_mm_s: FloatArray
    force_cN: FloatArray
    sensed_mm: FloatArray
    sensed_cN: FloatArray
    commanded_cN: FloatArray
    saturated: BoolArray
    release: BoolArray
    tick: BoolArray
    current_A: FloatArray
    finger_mm: FloatArray
    energy_J: FloatArray | None

    @classmethod
    def of_rows(cls, rows: FloatArray, audit: bool = False) -> Trace:
        """Convert the kernel's rows to record units."""
        t, x, v, force, sensed, felt, command, saturated, release, tick, amps, finger, energy = rows.T.copy()
        return cls(
            t,
            mm_from_m(x),
            mm_from_m(v),
            cN_from_N(force),
            mm_from_m(sensed),
            cN_from_N(felt),
            cN_from_N(command),
            saturated > 0.5,
            release > 0.5,
            tick > 0.5,
            amps,
            mm_from_m(finger),
            energy if audit else None,
        )

    def press(self, velocity_mm_s: float) -> Press:
        """Give the record that devices share, asked for at velocity_mm_s."""
        return Press(
            self.t_s,
            self.displacement_mm,
            self.force_cN,
            velocity_mm_s,
            self.sensed_mm,
            self.sensed_cN,
            self.commanded_cN,
            self.saturated,
            self.tick,
            simulated=True,
        )


def simulate(
    rig: Rig,
    finger: Finger,
    gesture: Gesture,
    surface: ForceSurface,
    travel_mm: float,
    noise: Noise,
    announced_mm_s: float,
    step_s: float = STEP_s,
    audit: bool = False,
) -> Trace:
    """Simulate one press in compiled C.

    surface : the command table (cN), which the controller reads at the displacement it senses.
    travel_mm : where the bottom stop is set.
    announced_mm_s : the speed that the controller takes for granted until it has found its own.
    audit : also account for the energy of the press.

    Raises ModelError if durations of the rig are no multiples of the step, or if rig or finger are too
    stiff for it. Safe to call from threads.
    """
    plant = plant_of(rig, finger, gesture, surface, travel_mm, announced_mm_s)
    grid = replace(grid_of(rig, gesture, surface, step_s), audit=int(audit))
    rows = run(replace(plant, step_s=step_s), grid, inputs_of(surface, noise))
    if not np.isfinite(rows[-1]).all():
        raise ModelError(
            f"the press diverged: rig or finger are too stiff or too light for steps of {step_s:g} s; "
            "raise the lightest mass or lower the largest stiffness, damping or loss"
        )
    return Trace.of_rows(rows, audit)

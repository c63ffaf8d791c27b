from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest

from fdvv.model import ForceSurface
from fdvv.twin import Finger, Gesture, Rig, Trace, plan, silence
from fdvv.twin._flatten import grid_of, inputs_of, plant_of
from fdvv.twin._kernel import Grid, Inputs, Plant, run
from fdvv.units import FloatArray


def tactile_cN(x_mm: FloatArray) -> FloatArray:
    """A bump like a tactile switch's: peak near 1.1 mm, valley near 2 mm."""
    bump = 30 * np.exp(-(((x_mm - 1.1) / 0.45) ** 2)) - 8 * np.exp(-(((x_mm - 2.0) / 0.35) ** 2))
    return np.asarray(34 + 13.3 * x_mm + bump)


def surface_of(press: FloatArray, release: FloatArray, travel_mm: float = 4.0) -> ForceSurface:
    """One curve for two speeds."""
    x = np.linspace(0.0, travel_mm, press.size)
    return ForceSurface(x, np.array([50.0, 200.0]), np.tile(press, (2, 1)), np.tile(release, (2, 1)))


@pytest.fixture
def tactile() -> ForceSurface:
    curve = tactile_cN(np.linspace(0.0, 4.0, 81))
    return surface_of(curve, curve - 6)


def flat(force_cN: float) -> ForceSurface:
    return surface_of(np.full(2, force_cN), np.full(2, force_cN))


@dataclass
class Bench:
    """The kernel with every number open: the default rig without noise or settling, then changed."""

    surface: ForceSurface
    gesture: Gesture
    plant: Plant
    grid: Grid

    @classmethod
    def of(cls, surface: ForceSurface, gesture: Gesture | None = None, **changes: Any) -> Bench:
        rig, finger = Rig(), Finger()
        gesture = gesture or replace(plan(finger, 0.004, 0.1), start_m=-0.02, end_m=-0.02)
        plant = plant_of(rig, finger, gesture, surface, 4.0, 100.0)
        grid = replace(grid_of(rig, gesture, surface), settle_ticks=0, audit=1)
        return cls(surface, gesture, replace(plant, **changes), grid)

    def run(self) -> Trace:
        noise = silence(Rig(), self.gesture)
        n, inputs = self.grid.ticks, inputs_of(self.surface, noise)
        cut = Inputs(
            inputs.speeds_m_s,
            inputs.table_N,
            np.zeros((n, self.grid.reads)),
            inputs.force_noise_N[:n],
            inputs.effort_ratio[: n + 1],
        )
        return Trace.of_rows(run(self.plant, self.grid, cut), audit=True)


FRICTIONLESS: dict[str, Any] = {"coulomb_N": 0.0, "viscous_N_s_m": 0.0}
LOOSE_PULP: dict[str, Any] = {"pulp_scale_N": 1e-12, "strap_N": 0.0, "strap_m": 0.0}
PERFECT_POSITION: dict[str, Any] = {"lvdt_lsb_m": 0.0, "lvdt_linearity_m": 0.0}

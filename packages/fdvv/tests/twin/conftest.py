from __future__ import annotations

import ctypes
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest

from fdvv.model.surface import ForceSurface
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import Gesture, plan
from fdvv.twin.image import image_of
from fdvv.twin.noise import Noise, count_ticks
from fdvv.twin.rig import Rig
from fdvv.twin.rig_kernel import Grid, grid_of, plant_of, run
from fdvv.twin.rig_moves import Exciter
from fdvv.twin.settings import limits_of, settings_of
from fdvv.twin.trace import Trace
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
    """The kernel with every number open: the rig voltage without noise, settling or exciter, then changed."""

    surface: ForceSurface
    gesture: Gesture
    plant: ctypes.Structure
    grid: Grid

    @classmethod
    def of(
        cls, surface: ForceSurface, gesture: Gesture | None = None, travel_m: float = 0.004, **changes: Any
    ) -> Bench:
        gesture = gesture or replace(plan(Finger(), 0.004, 0.1), start_m=-0.02, end_m=-0.02)
        plant = plant_of(BARE, Finger())
        # the pulse is always that of 4 mm: the stop's place is calibrated into the servo
        zero_us = 1600.0 - travel_m / plant.servo_m_us
        for name, value in {"servo_zero_us": zero_us, **changes}.items():
            part = plant.finger if hasattr(plant.finger, name) else plant
            assert hasattr(part, name)
            setattr(part, name, value)
        return cls(surface, gesture, plant, replace(grid_of(BARE), audit=1))

    def run(self) -> Trace:
        n = count_ticks(BARE, self.gesture)
        quiet = Noise(np.zeros((n, self.grid.reads)), *(np.zeros(n) for _ in range(4)))
        image = image_of(self.surface, 4.0).image
        rows = run(
            self.plant, self.grid, (settings_of(BARE), limits_of(BARE)), image, self.gesture, quiet, 0, 100.0
        )
        return Trace.of_rows(rows, audit=True)


BARE = Rig(exciter=Exciter(fitted="no"))
FRICTIONLESS: dict[str, Any] = {"coulomb_N": 0.0, "viscous_N_s_m": 0.0}
LOOSE_PULP: dict[str, Any] = {"pulp_scale_N": 1e-12, "strap_N": 0.0, "strap_m": 0.0}
PERFECT_POSITION: dict[str, Any] = {"lvdt_linearity_m": 0.0}
STIFF_SUPPLY: dict[str, Any] = {"source_ohm": 0.0, "copper_1_K": 0.0, "reluctance_H_m": 0.0}

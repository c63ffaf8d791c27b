"""What a mechanism is to give: the slowest press and release of a model."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.units import FloatArray

STEP_mm = 0.01
STOP_mm = 0.06
"""The last part of the travel, where the bottom stop shapes the curves; no mechanism is judged there."""
SEATED_mm = 0.1
"""From here on the cap has left its top stop; figures are given from 0 and from here."""


@dataclass(frozen=True, eq=False)
class Target:
    """Slow press and release of a button on one axis.

    Attributes
    ----------
    displacement_mm : (n,) from 0, STEP_mm apart, up to STOP_mm before the bottom.
    press_cN, release_cN : (n,) each.
    travel_mm : to the bottom stop.
    close_mm : where the circuit closes on the way down; half of the travel where the model does not say.
    """

    name: str
    displacement_mm: FloatArray
    press_cN: FloatArray
    release_cN: FloatArray
    travel_mm: float
    close_mm: float

    @property
    def middle_cN(self) -> FloatArray:
        """Get the mean of press and release, what is elastic: (n,)."""
        return 0.5 * (self.press_cN + self.release_cN)

    @property
    def half_loop_cN(self) -> FloatArray:
        """Get half of what parts press from release, what rubs: (n,)."""
        return 0.5 * (self.press_cN - self.release_cN)


def target_of(model: FDVVModel) -> Target:
    """Take a model's slowest curves. Raises ModelError if a stroke is missing or the travel too short."""
    missing = [str(stroke) for stroke in Stroke if not model.of(stroke)]
    if missing:
        raise ModelError(f"{model.name}: a mechanism needs press and release, the model has no {missing[0]}")
    if model.travel_mm < 0.5:
        raise ModelError(f"{model.name}: {model.travel_mm:g} mm of travel are fewer than the 0.5 mm needed")
    count = int(np.floor((model.travel_mm - STOP_mm) / STEP_mm)) + 1
    x: FloatArray = np.asarray(STEP_mm * np.arange(count), dtype=np.float64)
    press, release = (_slowest(model, stroke, x) for stroke in Stroke)
    close = 0.5 * model.travel_mm if model.actuation_mm is None else model.actuation_mm
    return Target(model.name, x, press, release, model.travel_mm, close)


def _slowest(model: FDVVModel, stroke: Stroke, x: FloatArray) -> FloatArray:
    curve = min(model.of(stroke), key=lambda c: c.velocity_mm_s or 0.0)
    return np.asarray(curve.force_cN(x), dtype=np.float64)

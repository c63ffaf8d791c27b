"""Force on a grid of displacement and velocity: what a rig is commanded."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.units import FloatArray


@dataclass(frozen=True, eq=False)
class ForceSurface:
    """Tables of force for both strokes, bilinear between the grid points, end values outside.

    Attributes
    ----------
    displacement_mm : (nx,) equal steps, rising, at least 2.
    velocity_mm_s : (nv,) strictly rising, at least 1.
    press_cN, release_cN : (nv, nx).
    """

    displacement_mm: FloatArray
    velocity_mm_s: FloatArray
    press_cN: FloatArray
    release_cN: FloatArray

    def __post_init__(self) -> None:
        for name in ("displacement_mm", "velocity_mm_s", "press_cN", "release_cN"):
            array = np.ascontiguousarray(getattr(self, name), dtype=np.float64)
            if not np.isfinite(array).all():
                raise ModelError(f"{name} must be finite")
            object.__setattr__(self, name, array)
        shape = (self.velocity_mm_s.size, self.displacement_mm.size)
        if self.press_cN.shape != shape or self.release_cN.shape != shape:
            raise ModelError(f"tables must be {shape}, got {self.press_cN.shape}, {self.release_cN.shape}")
        steps = np.diff(self.displacement_mm)
        if steps.size < 1 or steps[0] <= 0 or not np.allclose(steps, steps[0], rtol=1e-6):
            raise ModelError("displacement_mm needs at least 2 points at equal rising steps")
        if self.velocity_mm_s.size < 1 or np.any(np.diff(self.velocity_mm_s) <= 0):
            raise ModelError("velocity_mm_s must rise strictly")

    @classmethod
    def of_model(cls, model: FDVVModel, velocity_mm_s: npt.ArrayLike, step_mm: float = 0.05) -> ForceSurface:
        """Sample a model over its travel; without a release curve the press serves for both strokes.

        Raises ModelError if the model has no press curve.
        """
        count = round(model.travel_mm / step_mm) + 1
        x = np.arange(count, dtype=np.float64) * step_mm
        v = np.asarray(velocity_mm_s, dtype=np.float64)
        strokes = [s if model.of(s) else Stroke.PRESS for s in Stroke]
        press, release = (model.force_cN(x[np.newaxis, :], v[:, np.newaxis], s) for s in strokes)
        return cls(x, v, press, release)

    def table_cN(self, stroke: Stroke | str) -> FloatArray:
        """Return the (nv, nx) table of one stroke."""
        return self.press_cN if Stroke(stroke) is Stroke.PRESS else self.release_cN

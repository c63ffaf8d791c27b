"""A coil that returns a slider, and nothing else: what a linear key with a contactless sensor is."""

from __future__ import annotations

from dataclasses import dataclass

from fdvv.mechanism._coil import Coil
from fdvv.mechanism._guide import Guide
from fdvv.units import FloatArray


@dataclass(frozen=True)
class SpringMechanism:
    """A coil and the guide of its slider."""

    coil: Coil
    guide: Guide

    kind = "spring"

    def strokes_cN(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Give the slow press and release at displacements (mm), each as long as x."""
        spring = self.coil.preload_cN + self.coil.rate_cN_mm * x
        return self.guide.strokes_cN(x, spring, spring)

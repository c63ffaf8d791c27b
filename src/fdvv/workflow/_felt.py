"""What was felt of a press and what was intended, on one grid: for whoever looks on."""

from __future__ import annotations

from dataclasses import dataclass

from fdvv.compensate import FROM_mm, STOP_GUARD_mm, bin_force, grid_mm, split_strokes
from fdvv.model import FDVVModel, Press, Stroke
from fdvv.units import FloatArray

BIN_mm = 0.05
FORCE_JND_ratio = 0.07
"""Just noticeable difference of force, of 2.5 to 10 N at 25 to 160 mm/s (Pang, Tan and Durlach 1991)."""


@dataclass(frozen=True, eq=False)
class FeltPress:
    """Force of both strokes on a grid of true displacement.

    Attributes
    ----------
    displacement_mm : (n,) bins of 0.05 mm over the travel.
    press_cN, release_cN : (n,); NaN where the stroke was not.
    """

    displacement_mm: FloatArray
    press_cN: FloatArray
    release_cN: FloatArray


def felt_press(press: Press, travel_mm: float) -> FeltPress:
    """Bin the force on the finger of both strokes; a press that turned early has what it has."""
    grid = grid_mm(travel_mm, BIN_mm)
    spans = split_strokes(press.displacement_mm, travel_mm)
    down, up = (
        bin_force(press.displacement_mm[span.rows], press.force_cN[span.rows], grid) for span in spans
    )
    return FeltPress(grid, down, up)


def intended_press(model: FDVVModel, velocity_mm_s: float) -> FeltPress:
    """Give what a model asks for at a speed, on the grid of felt_press.

    Where a model tells nothing of the release, the press stands for it, as it does on a device.
    """
    grid = grid_mm(model.travel_mm, BIN_mm)
    down = model.force_cN(grid, velocity_mm_s, Stroke.PRESS)
    served = Stroke.RELEASE if model.of(Stroke.RELEASE) else Stroke.PRESS
    return FeltPress(grid, down, model.force_cN(grid, velocity_mm_s, served))


def noticeable_cN(model: FDVVModel, velocity_mm_s: float) -> tuple[float, float]:
    """Give the just noticeable difference of force, press and release: a part of the mean force judged."""
    wanted = intended_press(model, velocity_mm_s)
    judged = (wanted.displacement_mm >= FROM_mm) & (wanted.displacement_mm <= model.travel_mm - STOP_GUARD_mm)
    down, up = (
        FORCE_JND_ratio * float(abs(row[judged]).mean()) for row in (wanted.press_cN, wanted.release_cN)
    )
    return down, up

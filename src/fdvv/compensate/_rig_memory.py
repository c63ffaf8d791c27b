"""What a rig has taught: its numbers, and what tables need beyond them. Good for every button on that rig."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.compensate._known_rig import KnownRig
from fdvv.errors import ModelError
from fdvv.model import ForceSurface
from fdvv.units import FloatArray


@dataclass(frozen=True, eq=False)
class RigMemory:
    """A known rig and the residual that presses on it taught, whatever the button.

    Attributes
    ----------
    known : the rig's numbers.
    residual : command (cN) on top of what the numbers ask for, per place and speed, press and release.
    travel_mm : of the button it was learned on; on another one, places are scaled by the travels.
    error_cN : (2, s) mean error left at the residual's speeds, press and release, as the rig felt it.
    """

    known: KnownRig
    residual: ForceSurface
    travel_mm: float
    error_cN: FloatArray

    def __post_init__(self) -> None:
        errors = np.ascontiguousarray(self.error_cN, dtype=np.float64)
        object.__setattr__(self, "error_cN", errors)
        shape = (2, self.residual.velocity_mm_s.size)
        if errors.shape != shape or not (np.isfinite(errors).all() and self.travel_mm > 0):
            raise ModelError(f"a rig's memory needs {shape} finite errors and a travel above 0 mm")

    def rows_cN(
        self, grid_mm: FloatArray, speeds_mm_s: FloatArray, travel_mm: float
    ) -> tuple[FloatArray, FloatArray]:
        """Give the residual on another grid, for other speeds and travel: (s, n) press and release."""
        places = grid_mm * self.travel_mm / travel_mm
        own = self.residual.displacement_mm
        press, release = (
            self._between(np.stack([np.interp(places, own, row) for row in table]), speeds_mm_s)
            for table in (self.residual.press_cN, self.residual.release_cN)
        )
        return press, release

    def expected_cN(self, speeds_mm_s: FloatArray) -> FloatArray:
        """Give the mean error to expect at other speeds, (2, s)."""
        own = self.residual.velocity_mm_s
        return np.stack([np.interp(speeds_mm_s, own, row) for row in self.error_cN])

    def _between(self, rows: FloatArray, speeds_mm_s: FloatArray) -> FloatArray:
        """Take rows, (s, n), to other speeds, straight in their square; the last one holds.

        Below the slowest they go to one level at rest, where there is no inertia that varies over places: the
        middle of what remains when the first two rows are drawn on to speed 0.
        """
        squares, wanted = self.residual.velocity_mm_s**2, speeds_mm_s**2
        if squares.size > 1 and wanted.min() < squares[0]:
            still = np.median(rows[0] - (rows[1] - rows[0]) * squares[0] / (squares[1] - squares[0]))
            rows = np.vstack([np.full(rows.shape[1], still), rows])
            squares = np.concatenate([[0.0], squares])
        return np.stack([np.interp(wanted, squares, column) for column in rows.T], axis=1)

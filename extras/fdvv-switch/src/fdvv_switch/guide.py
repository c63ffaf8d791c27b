"""What every mechanism has: a slider that rubs in its guide and a cap that leaves its top stop."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray


@dataclass(frozen=True)
class Guide:
    """Friction of the slider, and the give of cap and top stop.

    Attributes
    ----------
    drag_cN : friction that is always there.
    load_ratio : friction that grows with the force on the slider; a finger never presses quite centred.
    seat_mm : way over which the cap's weight on its top stop gives way (e-fold).
    """

    drag_cN: float
    load_ratio: float
    seat_mm: float

    def __post_init__(self) -> None:
        if not (self.drag_cN >= 0 and self.load_ratio >= 0 and self.seat_mm > 0):
            raise ModelError(f"a guide rubs with 0 or more and its seat gives a little, got {self}")

    def rounded(self) -> Guide:
        """Return it without digits that nobody could make or measure."""
        return Guide(round(self.drag_cN, 2), round(self.load_ratio, 4), max(round(self.seat_mm, 3), 0.001))

    def strokes_cN(
        self, x: FloatArray, down_cN: FloatArray, up_cN: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Add friction to what the mechanism gives downward and upward, and let the cap sit on its stop."""
        press = down_cN + self.drag_cN + self.load_ratio * np.abs(down_cN)
        release = up_cN - self.drag_cN - self.load_ratio * np.abs(up_cN)
        resting = np.exp(-x / self.seat_mm)
        return np.asarray(press - press[0] * resting), np.asarray(release - release[0] * resting)

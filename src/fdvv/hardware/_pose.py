"""Turns and shifts of rigid bodies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.units import FloatArray

Row = tuple[float, float, float]
Turn = tuple[Row, Row, Row]

STRAIGHT: Turn = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
OVER: Turn = ((1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, -1.0))
"""Upside down: half a turn about x."""

X_UP: Turn = ((0.0, 0.0, -1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0))
"""What pointed along x points up."""


@dataclass(frozen=True)
class Pose:
    """A turn about the origin, then a shift in mm."""

    turn: Turn = STRAIGHT
    shift_mm: Row = (0.0, 0.0, 0.0)

    def of(self, points_mm: FloatArray) -> FloatArray:
        """Give points (n, 3) where this pose puts them."""
        moved: FloatArray = points_mm @ np.array(self.turn).T + np.array(self.shift_mm)
        return moved

    @property
    def inverse(self) -> Pose:
        """Get the pose that undoes this one."""
        back = np.array(self.turn).T
        return _pose(back, -back @ np.array(self.shift_mm))

    def after(self, first: Pose) -> Pose:
        """Give the pose that does first, then this one."""
        turn = np.array(self.turn)
        return _pose(turn @ np.array(first.turn), turn @ np.array(first.shift_mm) + np.array(self.shift_mm))

    @property
    def rows(self) -> FloatArray:
        """Get the turn with the shift as fourth column, (3, 4)."""
        return np.column_stack([np.array(self.turn), np.array(self.shift_mm)])


def about_x(angle_deg: float, centre_mm: Row) -> Pose:
    """Give a turn about a line along x through a point; y turns towards z."""
    c, s = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    turn = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    centre = np.array(centre_mm)
    return _pose(turn, centre - turn @ centre)


def _pose(turn: FloatArray, shift: FloatArray) -> Pose:
    rows = tuple((float(a), float(b), float(c)) for a, b, c in turn)
    x, y, z = (float(value) for value in shift)
    return Pose((rows[0], rows[1], rows[2]), (x, y, z))

"""Where each part stands: on its bed, in the rig at a travel and a setting of the limiter, on the jig."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from fdvv.errors import InputError
from fdvv.units import FloatArray
from fdvv_rig.dimensions import Dimensions
from fdvv_rig.layout import Layout
from fdvv_rig.limiter import Limiter

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
        """Return points (n, 3) where this pose puts them."""
        moved: FloatArray = points_mm @ np.array(self.turn).T + np.array(self.shift_mm)
        return moved

    @property
    def inverse(self) -> Pose:
        """Get the pose that undoes this one."""
        back = np.array(self.turn).T
        return _pose(back, -back @ np.array(self.shift_mm))

    def after(self, first: Pose) -> Pose:
        """Return the pose that does first, then this one."""
        turn = np.array(self.turn)
        return _pose(turn @ np.array(first.turn), turn @ np.array(first.shift_mm) + np.array(self.shift_mm))

    @property
    def rows(self) -> FloatArray:
        """Get the turn with the shift as fourth column, (3, 4)."""
        return np.column_stack([np.array(self.turn), np.array(self.shift_mm)])


def about_x(angle_deg: float, centre_mm: Row) -> Pose:
    """Return a turn about a line along x through a point; y turns towards z."""
    c, s = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    turn = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    centre = np.array(centre_mm)
    return _pose(turn, centre - turn @ centre)


def _pose(turn: FloatArray, shift: FloatArray) -> Pose:
    rows = tuple((float(a), float(b), float(c)) for a, b, c in turn)
    x, y, z = (float(value) for value in shift)
    return Pose((rows[0], rows[1], rows[2]), (x, y, z))


class Moves(StrEnum):
    """What a part moves with."""

    FIXED = "fixed"
    SLIDER = "slider"
    LIMITER = "limiter"


MOVES = {
    **dict.fromkeys(("slider-yoke", "keycap-adapter", "cell-holder", "cell-plate"), Moves.SLIDER),
    "limiter-arm": Moves.LIMITER,
}
"""Of printed parts; the others are fixed."""

RIG = (
    *("base", "coil-mount", "lvdt-mount", "slider-yoke", "keycap-adapter", "limiter-arm"),
    *("limiter-bracket", "black-box"),
)
"""The printed parts that stand in the paper's rig."""

CELL_RIG = (*(name for name in RIG if name != "keycap-adapter"), "cell-holder", "cell-plate")
"""Those of the recommended rig: a load cell in place of exciter and keycap."""

POSTS_mm = ((-27.5, 18.0), (27.5, 18.0), (-27.5, -10.0))
"""Where marker posts stand on the jig: three different sides, so that a camera knows which is which."""


@dataclass(frozen=True)
class State:
    """Where the slider is and where the limiter stops it.

    travel_mm : the slider's travel, 0 at rest; stop_mm : the travel at which its foot meets the limiter.
    """

    travel_mm: float = 0.0
    stop_mm: float | None = None

    def angle_deg(self, d: Dimensions) -> float:
        """Return the limiter's angle. Raises InputError where the slider could not be there."""
        stop_mm = d.travel_mm if self.stop_mm is None else self.stop_mm
        if not -d.overtravel_mm <= self.travel_mm <= stop_mm:
            reason = f"{self.travel_mm:g} mm is beyond the limiter's stop at {stop_mm:g} mm"
            raise InputError("state", "travel", reason, "stay above the stop")
        return Limiter(d).angle_deg(stop_mm)


def on_bed(name: str, d: Dimensions) -> Pose:
    """Return the pose that lays a part, drawn where it stands, on the bed; its lowest face is then z = 0."""
    layout = Layout(d)
    match name:
        case "base" | "capture-jig":
            return Pose(OVER)
        case "slider-yoke":
            return Pose(OVER, (0.0, 0.0, layout.yoke_top_mm))
        case "keycap-adapter" | "cell-holder":
            return Pose(shift_mm=(0.0, 0.0, -layout.yoke_top_mm))
        case "cell-plate":
            return Pose(OVER, (0.0, 0.0, layout.plate_low_mm + d.plate_thickness_mm))
        case "limiter-arm":
            return Pose(X_UP, (layout.servo_axis_mm, 0.0, -layout.limiter_in_mm))
        case "limiter-bracket":
            return Pose(X_UP, (layout.servo_axis_mm, 0.0, -layout.bracket_in_mm))
        case "marker-post":
            return Pose(OVER, (0.0, 0.0, d.post_height_mm))
        case "black-box":
            return Pose(OVER, (0.0, 0.0, layout.box_mm[2] - d.base_height_mm + d.box_wall_mm))
        case _:
            return Pose()


def moved(moves: Moves, state: State, d: Dimensions) -> Pose:
    """Return how far a state moves what was drawn at travel 0 with the limiter's angle 0."""
    if moves is Moves.SLIDER:
        return Pose(shift_mm=(0.0, 0.0, -state.travel_mm))
    if moves is Moves.LIMITER:
        return about_x(state.angle_deg(d), (0.0, 0.0, Layout(d).servo_axis_mm))
    return Pose()


def in_rig(name: str, state: State, d: Dimensions) -> Pose:
    """Return the pose that puts a printed part from its bed into the rig."""
    return moved(MOVES.get(name, Moves.FIXED), state, d).after(on_bed(name, d).inverse)


def on_jig(name: str, d: Dimensions) -> tuple[Pose, ...]:
    """Return the poses that put a printed part from its bed on the capture jig: three of the marker post."""
    back = on_bed(name, d).inverse
    places = POSTS_mm if name == "marker-post" else ((0.0, 0.0),)
    return tuple(Pose(shift_mm=(x, y, 0.0)).after(back) for x, y in places)

"""How unlike two buttons feel: force along press and release, shape, landmarks.

All is in just noticeable differences (fdvv.model.noticeable), the literature's or a project's own.
The three parts are mean squares and count alike; docs/explanation/library.md tells how well that works.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple, Protocol

import msgspec
import numpy as np

from fdvv.button.kind import bump_of
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.model.noticeable import LITERATURE, Jnds
from fdvv.units import FloatArray

STOP_cN_mm, STOP_most_cN = 150.0, 100.0
"""Beyond its travel a button is taken to have a stop of this slope, up to this force above its bottom-out."""

GRID_mm = np.arange(0.1, 4.51, 0.1)
"""Where forces are compared, contact at 0; the first tenth of a millimetre is the contact step."""

SHAPE_points = 32  # about every second point of a sketch; assumed fine enough for a shape
_SIZES = (GRID_mm.size, GRID_mm.size, SHAPE_points, SHAPE_points, 5)
_FORCE, _SHAPE, _LANDMARKS = (0, 1), (2, 3), (4,)  # places in _SIZES: press and release, then landmarks
_NO_ROWS: FloatArray = np.empty((0, sum(_SIZES)))

SKETCH_POINTS = 64
"""Per stroke, evenly from contact to the end of the travel."""


class Sketch(msgspec.Struct, frozen=True):
    """The slowest press and its release in tenths of a centinewton, 64 points each; empty if not there."""

    press_dcN: tuple[int, ...] = ()
    release_dcN: tuple[int, ...] = ()


class ComparedButton(Protocol):
    """What buttons are compared by; figures of a bump are None without one."""

    @property
    def travel_mm(self) -> float: ...
    @property
    def peak_mm(self) -> float | None: ...
    @property
    def valley_mm(self) -> float | None: ...
    @property
    def drop_cN(self) -> float | None: ...
    @property
    def release_drop_cN(self) -> float | None: ...
    @property
    def sketch(self) -> Sketch: ...


class ButtonFigures(NamedTuple):
    """A ComparedButton that is in no library."""

    travel_mm: float
    peak_mm: float | None
    valley_mm: float | None
    drop_cN: float | None
    release_drop_cN: float | None
    sketch: Sketch


class LikeTable:
    """What many buttons are compared by; positions count them in the order they were added."""

    def __init__(self) -> None:
        self._rows: list[ComparedButton] = []
        self._jnds, self._table = LITERATURE, _NO_ROWS

    def extend(self, rows: Sequence[ComparedButton]) -> None:
        self._rows += rows

    def parts(self, at: int, jnds: Jnds = LITERATURE) -> FloatArray:
        """Return how far every button is from the one at a position: force, shape, landmarks in JND, (n, 3).

        What either button lacks (a release, a bump's place) is left out; a part of which nothing is left is
        infinite. jnds : what the distance is counted in.
        """
        if jnds != self._jnds:
            self._jnds, self._table = jnds, _NO_ROWS
        if fresh := self._rows[len(self._table) :]:
            self._table = np.vstack([self._table, _vectors(fresh, jnds)])
        gap = (self._table - self._table[at]) ** 2
        ends = np.cumsum((0, *_SIZES))
        means = [_mean(gap[:, a:b]) for a, b in pairwise(ends)]
        parts = [_mean(np.column_stack([means[i] for i in part])) for part in (_FORCE, _SHAPE, _LANDMARKS)]
        found = np.sqrt(np.column_stack(parts))
        return np.where(np.isfinite(found), found, np.inf)


def sketch_of(model: FDVVModel) -> Sketch:
    """Draw the slowest press and its release with 64 points each, contact to end of travel."""
    return Sketch(*(_sketch(model, stroke) for stroke in (Stroke.PRESS, Stroke.RELEASE)))


def _sketch(model: FDVVModel, stroke: Stroke) -> tuple[int, ...]:
    curve = model.nearest(stroke)
    if curve is None:
        return ()
    x = np.linspace(0.0, model.travel_mm, SKETCH_POINTS)
    tenths: Sequence[int] = np.rint(10 * np.clip(curve.force_cN(x), -3000, 3000)).astype(int).tolist()
    return tuple(tenths)


def button_figures(model: FDVVModel) -> ButtonFigures:
    """Return what a model is compared by."""
    bump, back = bump_of(model, Stroke.PRESS), bump_of(model, Stroke.RELEASE)
    peak_mm, valley_mm, drop_cN = (bump.peak_mm, bump.valley_mm, bump.drop_cN) if bump else (None, None, None)
    release_drop_cN = back.drop_cN if back else None
    return ButtonFigures(model.travel_mm, peak_mm, valley_mm, drop_cN, release_drop_cN, sketch_of(model))


def distances(parts: FloatArray) -> FloatArray:
    """Return the root of the mean square of the parts, (n,)."""
    return np.asarray(np.sqrt(np.mean(parts**2, axis=1)))


def _mean(squares: FloatArray) -> FloatArray:
    """Average rows over what is known; NaN where nothing is."""
    known = np.isfinite(squares)
    count = known.sum(axis=1)
    total = np.where(known, squares, 0.0).sum(axis=1)
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)


def _vectors(rows: Sequence[ComparedButton], jnds: Jnds) -> FloatArray:
    """Return what buttons are compared by, a row each; NaN where it is unknown."""
    travel_mm = np.array([[row.travel_mm] for row in rows])
    strokes = [_sketches([row.sketch.press_dcN for row in rows])]
    strokes.append(_sketches([row.sketch.release_dcN for row in rows]))
    forces = [jnds.force_steps(_on_grid(stroke, travel_mm)) for stroke in strokes]
    shapes = [_normalised(stroke) / jnds.force_ratio for stroke in strokes]
    return np.hstack([*forces, *shapes, np.array([_landmarks(row, jnds) for row in rows])])


def _sketches(found_dcN: Sequence[Sequence[int]]) -> FloatArray:
    """Return forces in cN, (n, 64); NaN where a button has no such stroke."""
    none = (np.nan,) * SKETCH_POINTS
    return 0.1 * np.array([dcN or none for dcN in found_dcN], dtype=np.float64)


def _at(force_cN: FloatArray, part: FloatArray) -> FloatArray:
    """Read sketches at parts of the travel from 0 to 1, (n, m), between points by lines."""
    place = np.clip(part, 0.0, 1.0) * (SKETCH_POINTS - 1)
    before = np.minimum(place.astype(np.intp), SKETCH_POINTS - 2)
    low, high = (np.take_along_axis(force_cN, before + k, axis=1) for k in (0, 1))
    return np.asarray(low + (place - before) * (high - low))


def _on_grid(force_cN: FloatArray, travel_mm: FloatArray) -> FloatArray:
    """Return the force at each place of the grid, with the stop beyond the travel."""
    stop = np.clip(STOP_cN_mm * (GRID_mm - travel_mm), 0.0, STOP_most_cN)
    return np.clip(_at(force_cN, GRID_mm / travel_mm) + stop, 0.0, None)


def _normalised(force_cN: FloatArray) -> FloatArray:
    """Return force by its mean on travel by its length."""
    places = np.broadcast_to(np.linspace(0.02, 1.0, SHAPE_points), (len(force_cN), SHAPE_points))
    part = _at(force_cN, places)
    return np.asarray(part / np.maximum(part.mean(axis=1, keepdims=True), 1.0))


def _landmarks(row: ComparedButton, jnds: Jnds) -> list[float]:
    """Return travel, places of peak and valley, drops of press and release; without a bump the drop is 0."""
    places = (row.travel_mm, row.peak_mm, row.valley_mm)
    return [
        *(np.nan if place is None else place / jnds.place_mm for place in places),
        (row.drop_cN or 0.0) / jnds.snap_cN if row.sketch.press_dcN else np.nan,
        (row.release_drop_cN or 0.0) / jnds.snap_cN if row.sketch.release_dcN else np.nan,
    ]

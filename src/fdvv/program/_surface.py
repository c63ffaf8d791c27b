"""Force on displacement and velocity as a designer writes it: straight lines between points."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.model import FDVVModel, ForceSurface, Stroke
from fdvv.units import FloatArray

DIGITS_cN = 4
STEP_mm = 0.02


@dataclass(frozen=True)
class Surface:
    """A named table of force, bilinear between its points, its edges held outside.

    Attributes
    ----------
    name : how states refer to it.
    displacement_mm : rising, at least 2, in any steps.
    force_cN : a row of as many forces per velocity; positive against the finger, negative pulls the cap down.
    velocity_mm_s : rising from 0 or more, one per row.
    """

    name: str
    displacement_mm: tuple[float, ...]
    force_cN: tuple[tuple[float, ...], ...]
    velocity_mm_s: tuple[float, ...] = (0.0,)

    def __post_init__(self) -> None:
        check_name(self.name)
        object.__setattr__(self, "displacement_mm", tuple(map(float, self.displacement_mm)))
        object.__setattr__(self, "velocity_mm_s", tuple(map(float, self.velocity_mm_s)))
        rows = tuple(tuple(map(float, row)) for row in self.force_cN)
        object.__setattr__(self, "force_cN", rows)
        self._check_rising(self.displacement_mm, "displacement_mm", 2)
        self._check_rising(self.velocity_mm_s, "velocity_mm_s", 1)
        if self.velocity_mm_s[0] < 0:
            raise ModelError(f"surface {self.name!r}: velocity_mm_s starts below 0: {self.velocity_mm_s[0]}")
        if len(rows) != len(self.velocity_mm_s):
            raise ModelError(
                f"surface {self.name!r}: one row of force_cN per velocity, "
                f"got {len(rows)} for {len(self.velocity_mm_s)}"
            )
        for row in rows:
            if len(row) != len(self.displacement_mm):
                raise ModelError(
                    f"surface {self.name!r}: one force per displacement, "
                    f"got {len(row)} for {len(self.displacement_mm)}"
                )
        if not np.isfinite(rows).all():
            raise ModelError(f"surface {self.name!r}: force_cN must be finite")

    def _check_rising(self, numbers: tuple[float, ...], field: str, least: int) -> None:
        if len(numbers) < least or not np.isfinite(numbers).all() or np.any(np.diff(numbers) <= 0):
            raise ModelError(f"surface {self.name!r}: {field} must be {least} or more rising numbers")

    @property
    def table_cN(self) -> FloatArray:
        """Give the forces as an array, (velocities, displacements)."""
        return np.array(self.force_cN)

    def row_cN(self, row: int, displacement_mm: FloatArray) -> FloatArray:
        """Evaluate one row at displacements, in their shape."""
        forces: FloatArray = np.interp(displacement_mm, self.displacement_mm, self.force_cN[row])
        return forces

    def force_at_cN(self, displacement_mm: float, velocity_mm_s: float = 0.0) -> float:
        """Evaluate the surface at one place."""
        rows = [self.row_cN(i, np.array([displacement_mm]))[0] for i in range(len(self.velocity_mm_s))]
        return float(np.interp(velocity_mm_s, self.velocity_mm_s, rows))


def check_name(name: str) -> None:
    """Raise ModelError unless name is text of 1 to 40 printable characters without spaces at its ends."""
    if not name or name != name.strip() or len(name) > 40 or not name.isprintable():
        raise ModelError(f"a name is 1 to 40 printable characters without spaces at its ends, got {name!r}")


def line(name: str, *points: tuple[float, float]) -> Surface:
    """Make a surface of (displacement_mm, force_cN) points, the same at every velocity."""
    places, forces = zip(*points, strict=True)
    return Surface(name, places, (forces,))


def flat(name: str, force_cN: float) -> Surface:
    """Make a surface of one force everywhere."""
    return line(name, (0.0, force_cN), (1.0, force_cN))


def of_model(
    model: FDVVModel,
    stroke: Stroke | str,
    name: str | None = None,
    velocity_mm_s: Sequence[float] | None = None,
    step_mm: float = STEP_mm,
) -> Surface:
    """Sample one stroke of a model from 0 to its travel in even steps; without a release the press serves.

    velocity_mm_s are the rows; by default those of the model's curves. Forces are rounded to 1e-4 cN.
    Raises ModelError if the model has no press curve.
    """
    serving = Stroke(stroke) if model.of(stroke) else Stroke.PRESS
    rows = tuple(velocity_mm_s or model.velocities_mm_s(serving) or (0.0,))
    count = max(2, math.ceil(model.travel_mm / step_mm - 1e-9) + 1)
    x_mm = np.round(np.arange(count) * step_mm, 6)
    table = model.force_cN(x_mm[np.newaxis, :], np.array(rows)[:, np.newaxis], serving)
    return _of_table(name or str(Stroke(stroke)), x_mm, np.array(rows), table)


def of_surface(surface: ForceSurface, stroke: Stroke | str, name: str | None = None) -> Surface:
    """Take one stroke of a table, for instance of one that a compensation learned."""
    named = name or str(Stroke(stroke))
    return _of_table(named, surface.displacement_mm, surface.velocity_mm_s, surface.table_cN(stroke))


def _of_table(name: str, x_mm: FloatArray, v_mm_s: FloatArray, table_cN: FloatArray) -> Surface:
    rounded = np.round(table_cN, DIGITS_cN) + 0.0
    return Surface(name, tuple(x_mm.tolist()), tuple(map(tuple, rounded.tolist())), tuple(v_mm_s.tolist()))


def scaled(surface: Surface, name: str, ratio_of_mm_s: Mapping[float, float]) -> Surface:
    """Make the slowest row of a surface depend on velocity: at each given one, so many times itself."""
    row = np.array(surface.force_cN[0])
    speeds = np.array(sorted(ratio_of_mm_s))
    rows = np.array([ratio * row for _, ratio in sorted(ratio_of_mm_s.items())])
    return _of_table(name, np.array(surface.displacement_mm), speeds, rows)


def raised(surface: Surface, name: str, points: Sequence[tuple[float, float]]) -> Surface:
    """Add lines between (displacement_mm, force_cN) points to every row, at the surface's own points."""
    places, forces = (np.array(column, dtype=float) for column in zip(*sorted(points), strict=True))
    x_mm = np.array(surface.displacement_mm)
    table = surface.table_cN + np.interp(x_mm, places, forces, left=0.0, right=0.0)
    return _of_table(name, x_mm, np.array(surface.velocity_mm_s), table)

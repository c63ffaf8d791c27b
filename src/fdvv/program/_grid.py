"""Surfaces on even grids: the coarsest that stays within a bound, exactly measured."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.program._surface import Surface
from fdvv.protocol import SURFACE_DISPLACEMENTS, CN64_PER_cN, MM_S16_PER_mm_s, UM16_PER_mm
from fdvv.units import FloatArray

COARSEST_um16 = 16_000
FINEST_um16 = 16
START_um16 = (-32_000, 102_400)


@dataclass(frozen=True, eq=False)
class Grid:
    """A surface as an image holds it.

    Attributes
    ----------
    start_um16, step_um16 : first column and distance between two, 1/16 µm.
    velocities_mm_s16 : (rows,) 1/16 mm/s.
    forces_cN64 : (rows, columns) 1/64 cN.
    error_cN : largest distance between the surface and the lines between its columns, before rounding.
    rounding_cN : largest distance that rounding moved a column.
    """

    start_um16: int
    step_um16: int
    velocities_mm_s16: tuple[int, ...]
    forces_cN64: tuple[tuple[int, ...], ...]
    error_cN: float
    rounding_cN: float

    @property
    def columns(self) -> int:
        """Count the displacements."""
        return len(self.forces_cN64[0])


def place_um16(place_mm: float) -> int:
    """Give a displacement in 1/16 µm, to the nearest."""
    return round(place_mm * UM16_PER_mm)


def speed_mm_s16(speed_mm_s: float) -> int:
    """Give a velocity in 1/16 mm/s, to the nearest."""
    return round(speed_mm_s * MM_S16_PER_mm_s)


def counts_cN64(force_cN: float) -> int:
    """Give a force in 1/64 cN, to the nearest."""
    return round(force_cN * CN64_PER_cN)


class Candidates:
    """The even grids a surface may be given, and what each costs; measured once, when it is asked for."""

    def __init__(self, surface: Surface) -> None:
        self.surface = surface
        self._points_mm = np.array(surface.displacement_mm)
        self._source_cN = surface.table_cN
        self.start_um16 = place_um16(surface.displacement_mm[0])
        # inner points only: up to the last one, grid and surface hold the same end
        self.span_um16 = max(place_um16(surface.displacement_mm[-1]) - self.start_um16, FINEST_um16)
        fewest = max(2, -(-self.span_um16 // COARSEST_um16) + 1)
        most = min(SURFACE_DISPLACEMENTS, self.span_um16 // FINEST_um16 + 1)
        self.columns = np.arange(fewest, max(fewest, most) + 1)
        self._known_cN: dict[int, float] = {}

    def _step_um16(self, columns: int) -> int:
        return -(-self.span_um16 // (columns - 1))

    def _places_mm(self, columns: int) -> FloatArray:
        step_mm = self._step_um16(columns) / UM16_PER_mm
        return np.asarray(self.start_um16 / UM16_PER_mm + step_mm * np.arange(columns))

    def _table_cN(self, columns: int) -> FloatArray:
        """Evaluate every row at the columns."""
        places = self._places_mm(columns)
        after = np.clip(np.searchsorted(self._points_mm, places), 1, self._points_mm.size - 1)
        before_mm, after_mm = self._points_mm[after - 1], self._points_mm[after]
        part = np.clip((places - before_mm) / (after_mm - before_mm), 0.0, 1.0)
        table: FloatArray = (1 - part) * self._source_cN[:, after - 1] + part * self._source_cN[:, after]
        return table

    def _error_cN(self, columns: int) -> float:
        """Compare at the surface's own points: between straight lines nothing can be worse."""
        if columns not in self._known_cN:
            self._known_cN[columns] = self._measured_cN(columns)
        return self._known_cN[columns]

    def _measured_cN(self, columns: int) -> float:
        places, points = self._places_mm(columns), self._points_mm
        held = [np.interp(points, places, np.interp(places, points, row)) for row in self._source_cN]
        return float(np.max(np.abs(np.array(held) - self._source_cN)))

    def coarsest(self, bound_cN: float) -> int:
        """Give the fewest columns within the bound; where none is, the best there are."""
        within = (n for n in self.columns.tolist() if self._error_cN(n) <= bound_cN)
        found = next(within, None)
        return min(self.columns.tolist(), key=self._error_cN) if found is None else found

    def grid(self, columns: int) -> Grid:
        """Sample the surface on that many columns."""
        exact = self._table_cN(columns) * CN64_PER_cN
        rounded = np.rint(exact)
        return Grid(
            self.start_um16,
            self._step_um16(columns),
            tuple(speed_mm_s16(v) for v in self.surface.velocity_mm_s),
            tuple(tuple(int(f) for f in row) for row in rounded),
            self._error_cN(columns),
            float(np.max(np.abs(rounded - exact))) / CN64_PER_cN,
        )

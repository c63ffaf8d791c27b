"""Surfaces on even grids: the coarsest that stays within a bound, exactly measured."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.program._limits import COUNTS_PER_MM, COUNTS_PER_MM_S, COUNTS_PER_cN
from fdvv.program._surface import Surface
from fdvv.protocol import SURFACE_DISPLACEMENTS
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
    return round(place_mm * COUNTS_PER_MM)


def speed_mm_s16(speed_mm_s: float) -> int:
    """Give a velocity in 1/16 mm/s, to the nearest."""
    return round(speed_mm_s * COUNTS_PER_MM_S)


def counts_cN64(force_cN: float) -> int:
    """Give a force in 1/64 cN, to the nearest."""
    return round(force_cN * COUNTS_PER_cN)


class Candidates:
    """The even grids a surface may be given, and what each costs; measured once."""

    def __init__(self, surface: Surface) -> None:
        self.surface = surface
        self.start_um16 = place_um16(surface.displacement_mm[0])
        # inner points only: up to the last one, grid and surface hold the same end
        self.span_um16 = max(place_um16(surface.displacement_mm[-1]) - self.start_um16, FINEST_um16)
        fewest = max(2, -(-self.span_um16 // COARSEST_um16) + 1)
        most = min(SURFACE_DISPLACEMENTS, self.span_um16 // FINEST_um16 + 1)
        self.columns = np.arange(fewest, max(fewest, most) + 1)
        self.errors_cN = np.array([self._error_cN(int(n)) for n in self.columns])

    def _step_um16(self, columns: int) -> int:
        return -(-self.span_um16 // (columns - 1))

    def _places_mm(self, columns: int) -> FloatArray:
        step = self._step_um16(columns)
        return (self.start_um16 + step * np.arange(columns, dtype=np.float64)) / COUNTS_PER_MM

    def _table_cN(self, columns: int) -> FloatArray:
        places = self._places_mm(columns)
        rows = range(len(self.surface.velocity_mm_s))
        return np.array([self.surface.row_cN(row, places) for row in rows])

    def _error_cN(self, columns: int) -> float:
        """Compare at the surface's own points: between straight lines nothing can be worse."""
        places = self._places_mm(columns)
        points = np.array(self.surface.displacement_mm)
        found = [np.interp(points, places, row) for row in self._table_cN(columns)]
        return float(np.max(np.abs(np.array(found) - self.surface.table_cN)))

    def coarsest(self, bound_cN: float) -> int:
        """Give the fewest columns within the bound; where none is, the best there are."""
        within = np.flatnonzero(self.errors_cN <= bound_cN)
        return int(self.columns[within[0] if within.size else np.argmin(self.errors_cN)])

    def grid(self, columns: int) -> Grid:
        """Sample the surface on that many columns."""
        exact = self._table_cN(columns) * COUNTS_PER_cN
        rounded = np.rint(exact)
        return Grid(
            self.start_um16,
            self._step_um16(columns),
            tuple(speed_mm_s16(v) for v in self.surface.velocity_mm_s),
            tuple(tuple(int(f) for f in row) for row in rounded),
            float(self.errors_cN[columns - self.columns[0]]),
            float(np.max(np.abs(rounded - exact))) / COUNTS_PER_cN,
        )

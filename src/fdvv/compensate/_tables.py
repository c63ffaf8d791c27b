"""Actuation between the learned speeds."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fdvv.model import ForceSurface
from fdvv.units import FloatArray


def _rows(table: FloatArray, known: FloatArray, wanted: FloatArray) -> FloatArray:
    return np.stack([np.interp(wanted, known, column) for column in table.T], axis=1)


def dense_velocities(surface: ForceSurface, velocity_mm_s: npt.ArrayLike) -> ForceSurface:
    """Interpolate the tables linearly to other speeds; outside the learned ones the end table holds."""
    wanted = np.asarray(velocity_mm_s, dtype=np.float64)
    tables = [_rows(t, surface.velocity_mm_s, wanted) for t in (surface.press_cN, surface.release_cN)]
    return ForceSurface(surface.displacement_mm, wanted, *tables)

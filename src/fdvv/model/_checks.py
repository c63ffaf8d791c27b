"""What every record of numbers checks when it is made."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.units import FloatArray

LARGEST_mm, LARGEST_cN = 1e3, 1e6
"""A metre and ten kilonewtons: beyond any button, within what can be tabulated and squared."""


def column(values: npt.ArrayLike, name: str) -> FloatArray:
    """Make a read-only 1-D float column, refusing what is not finite."""
    array = np.array(values, dtype=np.float64)
    if array.ndim != 1:
        raise ModelError(f"{name} must be one column, got {array.shape = }")
    if not np.isfinite(array).all():
        at = int(np.flatnonzero(~np.isfinite(array))[0])
        raise ModelError(f"{name} must be finite, got {array[at]} at index {at}")
    array.setflags(write=False)
    return array


def check_size(values: npt.ArrayLike, limit: float, name: str) -> None:
    """Refuse numbers that no button has."""
    worst = float(np.abs(values).max())
    if worst > limit:
        raise ModelError(f"{name} must stay within {limit:g}, got {worst:g}")


def check_spread(value: float | None, name: str) -> None:
    """Refuse a standard deviation that is none; None means unknown."""
    if value is not None and not (np.isfinite(value) and value >= 0):
        raise ModelError(f"{name} must be at least 0 and finite, got {value}")


def check_presses(presses: int) -> None:
    """Refuse a spread of fewer than two."""
    if presses < 2:
        raise ModelError(f"a spread takes at least 2 presses, got {presses}")

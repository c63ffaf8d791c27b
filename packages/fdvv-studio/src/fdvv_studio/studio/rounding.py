"""Numbers rounded for a screen."""

from __future__ import annotations

import math

from fdvv.units import FloatArray

DIGITS = 3
"""A thousandth of a cN, or a micrometre, is beyond any line's width."""


def finite_or_none(value: float) -> float | None:
    """Round a number; None for one that is not known (NaN, infinite)."""
    return round(value, DIGITS) if math.isfinite(value) else None


def round_row(row: FloatArray, digits: int = DIGITS) -> tuple[float, ...]:
    """Round a row that is known throughout, (n,)."""
    return tuple(row.round(digits).tolist())


def finite_row(row: FloatArray) -> tuple[float | None, ...]:
    """Round a row, (n,); None where it is not known."""
    return tuple(map(finite_or_none, row.tolist()))

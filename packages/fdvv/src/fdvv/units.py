"""Units: records, files and screens use mm, cN, s and Hz; the plant computes in SI.

This is the only place that converts, in both directions.

- displacement: mm, positive into the button, 0 at first contact with the resting cap.
- force: cN (1 cN = 10 mN), positive against the finger.
- velocity: mm/s, the mean speed of a stroke, always positive; the stroke gives the direction.
- time: s on the clock of the device that made the record.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]
"""Numbers of double precision; (n,) where no other shape is stated."""

if TYPE_CHECKING:
    Column = FloatArray
    Table = FloatArray
else:  # as a file holds such a field; its record makes an array of it
    Column, Table = list[float], list[list[float]]

Value = TypeVar("Value", float, FloatArray)
"""One number or an array of them: what is converted stays what it was."""

GRAM_FORCE_cN = 0.980665
"""One gram-force in centinewtons, exact by the definition of standard gravity (9.80665 m/s²)."""


def cN_from_gf(force_gf: Value) -> Value:
    """Convert gram-force to centinewtons."""
    return force_gf * GRAM_FORCE_cN


def gf_from_cN(force_cN: Value) -> Value:
    """Convert centinewtons to gram-force."""
    return force_cN / GRAM_FORCE_cN


def N_from_cN(force_cN: Value) -> Value:
    """Convert centinewtons to newtons."""
    return force_cN * 0.01


def cN_from_N(force_N: Value) -> Value:
    """Convert newtons to centinewtons."""
    return force_N * 100.0


def m_from_mm(length_mm: Value) -> Value:
    """Convert millimetres (or mm/s, mm/s²) to metres (m/s, m/s²)."""
    return length_mm * 0.001


def mm_from_m(length_m: Value) -> Value:
    """Convert metres (or m/s, m/s²) to millimetres (mm/s, mm/s²)."""
    return length_m * 1000.0

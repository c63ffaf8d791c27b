"""How what was measured differs from press to press, as standard deviations.

A standard error is the spread over the root of the presses. It says how well they determine the mean;
what all of them share, such as a sensor's scale or the finger that pressed, is in none of it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import msgspec
import numpy as np
import numpy.typing as npt
from msgspec import Meta

from fdvv.errors import ModelError
from fdvv.model.bspline import (
    ExactlyEqual,
    LARGEST_cN,
    LARGEST_mm,
    check_presses,
    check_size,
    check_spread,
    check_velocity,
    set_columns,
)
from fdvv.units import FloatArray


@dataclass(frozen=True, eq=False)
class CurveSpread(ExactlyEqual):
    """How the presses behind a force curve differ.

    Attributes
    ----------
    displacement_mm : (n,) strictly rising, 2 places or more.
    spread_cN : (n,) standard deviation of the force between presses there.
    presses : how many, 2 or more.
    achieved_mm_s : mean speed they really had, which differs from the velocity that was asked for; None if
        unknown.
    achieved_spread_mm_s : standard deviation of that speed between presses; None if unknown.

    Equality is of all numbers, exactly. Raises ModelError on anything else.
    """

    displacement_mm: FloatArray
    spread_cN: FloatArray
    presses: int
    achieved_mm_s: float | None = None
    achieved_spread_mm_s: float | None = None

    def __post_init__(self) -> None:
        set_columns(self, "displacement_mm", "spread_cN")
        if self.displacement_mm.shape != self.spread_cN.shape or self.displacement_mm.size < 2:
            got = f"{self.displacement_mm.size} and {self.spread_cN.size}"
            raise ModelError(f"a spread needs 2 places or more and a value for each, got {got}")
        if np.any(np.diff(self.displacement_mm) <= 0):
            raise ModelError("displacement_mm of a spread must rise strictly")
        if np.any(self.spread_cN < 0):
            raise ModelError(f"spread_cN must be at least 0, got {self.spread_cN.min():g}")
        check_size(self.displacement_mm, LARGEST_mm, "displacement_mm")
        check_size(self.spread_cN, LARGEST_cN, "spread_cN")
        check_presses(self.presses)
        check_velocity(self.achieved_mm_s, "achieved_mm_s")
        check_spread(self.achieved_spread_mm_s, "achieved_spread_mm_s")

    def at_cN(self, displacement_mm: npt.ArrayLike) -> FloatArray:
        """Return the spread of the force, in the shape of displacement_mm; NaN where it was not measured."""
        x = np.asarray(displacement_mm, dtype=np.float64)
        return np.interp(x, self.displacement_mm, self.spread_cN, left=np.nan, right=np.nan)

    def error_cN(self, displacement_mm: npt.ArrayLike) -> FloatArray:
        """Return the standard error of the mean force, in the shape of displacement_mm; NaN likewise."""
        return np.asarray(self.at_cN(displacement_mm) / np.sqrt(self.presses))


@dataclass(frozen=True)
class PointSpread:
    """How a place in the travel differs: standard deviation between presses, and of how many."""

    spread_mm: float
    presses: int

    def __post_init__(self) -> None:
        check_spread(self.spread_mm, "spread_mm")
        check_presses(self.presses)

    @property
    def error_mm(self) -> float:
        """Return the standard error of the mean; that of a median is a quarter more."""
        return float(self.spread_mm / np.sqrt(self.presses))


@dataclass(frozen=True)
class ModeSpread:
    """Standard deviations between presses of a mode's fields of the same names; None if unknown."""

    frequency_Hz: float | None = None
    amplitude_m_s2: float | None = None
    decay_1_s: float | None = None

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            check_spread(value, f"the spread of {name}")


@dataclass(frozen=True)
class VibrationSpread:
    """How a vibration differs between presses.

    Attributes
    ----------
    presses : how many, 2 or more.
    onset_mm, duration_s : standard deviations of the vibration's fields of the same names; None if unknown.
    modes : one for each mode of the vibration; empty if unknown.
    """

    presses: int
    onset_mm: float | None = None
    duration_s: float | None = None
    modes: tuple[ModeSpread, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "modes", tuple(self.modes))
        check_presses(self.presses)
        for name in ("onset_mm", "duration_s"):
            check_spread(getattr(self, name), f"the spread of {name}")


Presses = Annotated[int, Meta(ge=2, description="how many presses")]

Deviation = Annotated[float, Meta(ge=0)] | None


class PointSpreadRecord(msgspec.Struct, forbid_unknown_fields=True):
    """How a point of the travel differs between presses."""

    spread_mm: Annotated[float, Meta(ge=0, description="standard deviation between presses, mm")]
    presses: Presses


class CurveSpreadRecord(msgspec.Struct, forbid_unknown_fields=True):
    """How the force of a curve differs between presses."""

    presses: Presses
    displacement_mm: Annotated[list[float], Meta(min_length=2, description="places, mm, strictly rising")]
    spread_cN: Annotated[
        list[Annotated[float, Meta(ge=0)]],
        Meta(min_length=2, description="standard deviation between presses at each place, cN"),
    ]
    achieved_mm_s: Annotated[
        Annotated[float, Meta(gt=0)] | None,
        Meta(description="mean speed that the presses really had, mm/s; null if unknown"),
    ] = None
    achieved_spread_mm_s: Annotated[
        Deviation, Meta(description="its standard deviation between presses, mm/s; null if unknown")
    ] = None


class ModeSpreadRecord(msgspec.Struct, forbid_unknown_fields=True):
    """Standard deviations between presses of one mode."""

    frequency_Hz: Annotated[Deviation, Meta(description="of the frequency, Hz; null if unknown")] = None
    amplitude_m_s2: Annotated[Deviation, Meta(description="of the amplitude, m/s²; null if unknown")] = None
    decay_1_s: Annotated[Deviation, Meta(description="of the decay, 1/s; null if unknown")] = None


class VibrationSpreadRecord(msgspec.Struct, forbid_unknown_fields=True):
    """How a vibration differs between presses."""

    presses: Presses
    onset_mm: Annotated[Deviation, Meta(description="of the onset, mm; null if unknown")] = None
    duration_s: Annotated[Deviation, Meta(description="of the duration, s; null if unknown")] = None
    modes: Annotated[list[ModeSpreadRecord], Meta(description="one for each mode; empty if unknown")] = []

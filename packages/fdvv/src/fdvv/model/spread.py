"""How what was measured differs from press to press, as standard deviations.

A standard error is the spread over the root of the presses. It says how well they determine the mean;
what all of them share, such as a sensor's scale or the finger that pressed, is in none of it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

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
from fdvv.units import Column, FloatArray

Presses = Annotated[int, Meta(ge=2)]
Deviation = Annotated[float, Meta(ge=0)]
if TYPE_CHECKING:
    Deviations = FloatArray
else:
    Deviations = list[Deviation]


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

    displacement_mm: Annotated[Column, Meta(min_length=2)]
    spread_cN: Annotated[Deviations, Meta(min_length=2)]
    presses: Presses
    achieved_mm_s: Annotated[float, Meta(gt=0)] | None = None
    achieved_spread_mm_s: Deviation | None = None

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
    """How a place in the travel differs between presses.

    Attributes
    ----------
    spread_mm : standard deviation.
    presses : how many, 2 or more.
    """

    spread_mm: Deviation
    presses: Presses

    def __post_init__(self) -> None:
        check_spread(self.spread_mm, "spread_mm")
        check_presses(self.presses)

    @property
    def error_mm(self) -> float:
        """Return the standard error of the mean; that of a median is a quarter more."""
        return float(self.spread_mm / np.sqrt(self.presses))


@dataclass(frozen=True)
class ModeSpread:
    """How a mode differs between presses.

    Attributes
    ----------
    frequency_Hz, amplitude_m_s2, decay_1_s : standard deviations of the mode's fields of the same names; None
        if unknown.
    """

    frequency_Hz: Deviation | None = None
    amplitude_m_s2: Deviation | None = None
    decay_1_s: Deviation | None = None

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

    presses: Presses
    onset_mm: Deviation | None = None
    duration_s: Deviation | None = None
    modes: tuple[ModeSpread, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "modes", tuple(self.modes))
        check_presses(self.presses)
        for name in ("onset_mm", "duration_s"):
            check_spread(getattr(self, name), f"the spread of {name}")

"""How what was measured differs from press to press, as standard deviations.

A standard error is the spread over the root of the presses. It tells how well these presses tell the mean;
what all of them share, such as a sensor's scale or the finger that pressed, is in none of it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.model._checks import LARGEST_cN, LARGEST_mm, check_presses, check_size, check_spread, column
from fdvv.units import FloatArray


@dataclass(frozen=True, eq=False)
class CurveSpread:
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
        object.__setattr__(self, "displacement_mm", column(self.displacement_mm, "displacement_mm"))
        object.__setattr__(self, "spread_cN", column(self.spread_cN, "spread_cN"))
        if self.displacement_mm.shape != self.spread_cN.shape or self.displacement_mm.size < 2:
            raise ModelError(
                "a spread needs 2 places or more and a value for each, got "
                f"{self.displacement_mm.size} and {self.spread_cN.size}"
            )
        if np.any(np.diff(self.displacement_mm) <= 0):
            raise ModelError("displacement_mm of a spread must rise strictly")
        if np.any(self.spread_cN < 0):
            raise ModelError(f"spread_cN must be at least 0, got {self.spread_cN.min():g}")
        check_size(self.displacement_mm, LARGEST_mm, "displacement_mm")
        check_size(self.spread_cN, LARGEST_cN, "spread_cN")
        check_presses(self.presses)
        if self.achieved_mm_s is not None and not (
            np.isfinite(self.achieved_mm_s) and self.achieved_mm_s > 0
        ):
            raise ModelError(f"achieved_mm_s must be positive and finite, got {self.achieved_mm_s}")
        check_spread(self.achieved_spread_mm_s, "achieved_spread_mm_s")

    def at_cN(self, displacement_mm: npt.ArrayLike) -> FloatArray:
        """Give the spread of the force, in the shape of displacement_mm; NaN where it was not measured."""
        x = np.asarray(displacement_mm, dtype=np.float64)
        return np.interp(x, self.displacement_mm, self.spread_cN, left=np.nan, right=np.nan)

    def error_cN(self, displacement_mm: npt.ArrayLike) -> FloatArray:
        """Give the standard error of the mean force, in the shape of displacement_mm; NaN likewise."""
        return np.asarray(self.at_cN(displacement_mm) / np.sqrt(self.presses))

    def _key(self) -> tuple[object, ...]:
        speeds = (self.achieved_mm_s, self.achieved_spread_mm_s)
        return self.displacement_mm.tobytes(), self.spread_cN.tobytes(), self.presses, *speeds

    def __eq__(self, other: object) -> bool:
        return self._key() == other._key() if isinstance(other, CurveSpread) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._key())


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
        """Get the standard error of the mean; that of a median is a quarter more."""
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

"""What figures need that no other room's record holds: rendered and feasible curves, histories of errors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.model.curve import Stroke
from fdvv.units import FloatArray


def _check_columns(record: object, names: Sequence[str], shape: tuple[int, ...], whose: str = "") -> None:
    for name in names:
        actual = getattr(record, name).shape
        if actual != shape:
            raise ModelError(f"{whose}{name} must match displacement_mm, got {actual} and {shape}")


@dataclass(frozen=True, eq=False)
class RenderedBand:
    """What one method rendered: mean and spread of several presses.

    method : as the legend calls it ("FD only", "FDVV").
    mean_cN, low_cN, high_cN : (n,) at the displacements of the curve; NaN where no press went.
    noticed_ratio : (n,) part of the presses that a finger would notice there; None if nobody asked.
    """

    method: str
    mean_cN: FloatArray
    low_cN: FloatArray
    high_cN: FloatArray
    noticed_ratio: FloatArray | None = None


@dataclass(frozen=True, eq=False)
class RenderedCurve:
    """One stroke at one velocity: what was asked for and what each method rendered.

    Attributes
    ----------
    displacement_mm : (n,) true displacement, strictly rising.
    target_cN : (n,) force that the model asks for.
    bands : one per method, in the order of the legend.
    simulated : the presses come from the twin.
    jnd_cN : (n,) just noticeable difference of the target; None if it is not to be drawn.

    Raises ModelError on columns of different length or displacements that do not rise.
    """

    stroke: Stroke
    velocity_mm_s: float
    displacement_mm: FloatArray
    target_cN: FloatArray
    bands: tuple[RenderedBand, ...] = ()
    simulated: bool = False
    jnd_cN: FloatArray | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "stroke", Stroke(self.stroke))
        object.__setattr__(self, "bands", tuple(self.bands))
        shape = self.displacement_mm.shape
        _check_columns(self, ("target_cN", *(() if self.jnd_cN is None else ("jnd_cN",))), shape)
        for band in self.bands:
            noticed = () if band.noticed_ratio is None else ("noticed_ratio",)
            _check_columns(band, ("mean_cN", "low_cN", "high_cN", *noticed), shape, f"{band.method} ")
        if len(shape) != 1 or shape[0] < 2 or np.any(np.diff(self.displacement_mm) <= 0):
            raise ModelError(f"displacement_mm must be one strictly rising column, got shape {shape}")


@dataclass(frozen=True, eq=False)
class ErrorHistory:
    """The error of one curve over the presses that were used to learn it.

    error_cN : (n,) one per press, in order; NaN where a press gave none.
    simulated : the presses come from the twin.

    Raises ModelError unless error_cN is one column of at least one press.
    """

    stroke: Stroke
    velocity_mm_s: float
    error_cN: FloatArray
    simulated: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "stroke", Stroke(self.stroke))
        object.__setattr__(self, "error_cN", np.array(self.error_cN, dtype=np.float64))
        if self.error_cN.ndim != 1 or self.error_cN.size < 1:
            raise ModelError(f"error_cN must be one column, got shape {self.error_cN.shape}")


@dataclass(frozen=True, eq=False)
class FeasibleCurve:
    """One stroke at one velocity as a rig could render it.

    Attributes
    ----------
    displacement_mm, intended_cN, achievable_cN : (n,), places strictly rising.
    cut : (n,) bool, where a limit cuts the command.
    verdict : in words, below the title.
    band_mm, band : what presses measured, on places of its own; None if nobody pressed.
    simulated : the presses come from the twin.

    Raises ModelError on columns of different length.
    """

    stroke: Stroke
    velocity_mm_s: float
    displacement_mm: FloatArray
    intended_cN: FloatArray
    achievable_cN: FloatArray
    cut: npt.NDArray[np.bool_]
    verdict: str = ""
    band_mm: FloatArray | None = None
    band: RenderedBand | None = None
    simulated: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "stroke", Stroke(self.stroke))
        _check_columns(self, ("intended_cN", "achievable_cN", "cut"), self.displacement_mm.shape)
        if self.band is not None and (self.band_mm is None or self.band.mean_cN.shape != self.band_mm.shape):
            raise ModelError("a measured band needs its places, one each")

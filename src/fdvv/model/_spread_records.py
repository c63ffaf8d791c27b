"""The shape of spreads in a model file, and their way from and to the model's own records."""

from __future__ import annotations

from typing import Annotated, Any

import msgspec
from msgspec import Meta

from fdvv.model._spread import CurveSpread, ModeSpread, PointSpread, VibrationSpread

Presses = Annotated[int, Meta(ge=2, description="how many presses")]
Deviation = Annotated[float, Meta(ge=0)] | None


class PointSpreadRecord(msgspec.Struct, forbid_unknown_fields=True):
    """How a point of the travel differs between presses."""

    spread_mm: Annotated[float, Meta(ge=0, description="standard deviation between presses, mm")]
    presses: Presses

    def read(self) -> PointSpread:
        """Give the model's own record. Raises ModelError."""
        return PointSpread(self.spread_mm, self.presses)


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

    def read(self) -> CurveSpread:
        """Give the model's own record. Raises ModelError."""
        return CurveSpread(**{name: getattr(self, name) for name in self.__struct_fields__})


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

    def read(self) -> VibrationSpread:
        """Give the model's own record. Raises ModelError."""
        modes = tuple(ModeSpread(**msgspec.to_builtins(mode)) for mode in self.modes)
        return VibrationSpread(self.presses, self.onset_mm, self.duration_s, modes)


def written(
    spread: CurveSpread | PointSpread | VibrationSpread | None, name: str = "spread"
) -> dict[str, Any]:
    """Give a spread as a field of a file; no field where there is none, as in files of version 1."""
    if spread is None:
        return {}
    if not isinstance(spread, CurveSpread):
        return {name: msgspec.to_builtins(spread)}
    columns = {"displacement_mm": spread.displacement_mm.tolist(), "spread_cN": spread.spread_cN.tolist()}
    speeds = {n: getattr(spread, n) for n in ("achieved_mm_s", "achieved_spread_mm_s")}
    return {name: {"presses": spread.presses, **columns, **speeds}}

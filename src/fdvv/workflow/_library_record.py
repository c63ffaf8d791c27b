"""What a library keeps of one file: its row and curves, or why it holds no button."""

from __future__ import annotations

import msgspec
import numpy as np
import numpy.typing as npt

from fdvv.model import FDVVModel, ForceCurve, Stroke
from fdvv.workflow._shelf_row import ShelfRow

STEP_mm = 0.02
"""Of the curves: that over which the force of a measured file is averaged before its figures are read."""
MOST_points = 2000


class SampledCurve(msgspec.Struct, frozen=True):
    """Force of one stroke at one speed, evenly sampled; contact is at 0.

    Attributes
    ----------
    velocity_mm_s : None if the file tells none.
    force_cN : at start_mm + i step_mm, (n,), single precision.
    """

    stroke: str
    velocity_mm_s: float | None
    start_mm: float
    step_mm: float
    force_cN: npt.NDArray[np.float32]

    @classmethod
    def of(
        cls,
        stroke: str,
        velocity_mm_s: float | None,
        start_mm: float,
        step_mm: float,
        force_cN: npt.ArrayLike,
    ) -> SampledCurve:
        """Make it of plain values."""
        return cls(stroke, velocity_mm_s, start_mm, step_mm, np.asarray(force_cN, dtype=np.float32))

    def curve(self) -> ForceCurve:
        """Join the samples by lines."""
        x = self.start_mm + self.step_mm * np.arange(self.force_cN.size)
        knots = np.concatenate([x[:1], x, x[-1:]])
        return ForceCurve(Stroke(self.stroke), self.velocity_mm_s, 1, knots, self.force_cN.astype(np.float64))


class LibraryRecord(msgspec.Struct, frozen=True):
    """One file. Without a row it is refused if there is a reason, else a file of fdvv's that is no button.

    Attributes
    ----------
    id, place, stamp, pair, sha256, format, warnings : as in the library's columns.
    """

    id: str
    place: str
    stamp: str
    pair: str | None = None
    sha256: str | None = None
    row: ShelfRow | None = None
    reason: str = ""
    format: str = ""
    warnings: tuple[str, ...] = ()
    curves: tuple[SampledCurve, ...] = ()

    @property
    def state(self) -> str:
        """Get what became of the file."""
        return "button" if self.row else "refused" if self.reason else "other"


def sampled(model: FDVVModel) -> tuple[SampledCurve, ...]:
    """Sample every curve of a model from its beginning to its end, about every 20 um."""
    found = []
    for curve in model.curves:
        length = curve.end_mm - curve.start_mm
        points = int(np.clip(round(length / STEP_mm) + 1, 2, MOST_points))
        x = np.linspace(curve.start_mm, curve.end_mm, points)
        found.append(
            SampledCurve.of(
                str(curve.stroke), curve.velocity_mm_s, float(x[0]), length / (points - 1), curve.force_cN(x)
            )
        )
    return tuple(found)

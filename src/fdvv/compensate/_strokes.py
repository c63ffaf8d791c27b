"""The two strokes in the record of one press."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.units import FloatArray

EDGE_mm = 0.1
"""Guard at both ends: below it the finger meets the cap, within it of the stop the cap bounces."""

SHORT_mm = 0.3
"""A press that ends this far before the stop did not reach it; a servo sets its stop to 0.1 mm."""


@dataclass(frozen=True)
class Span:
    """Rows start to end (end excluded) of one pass between the guards."""

    start: int
    end: int

    @property
    def rows(self) -> slice:
        """Give the rows as a slice."""
        return slice(self.start, self.end)


def why_incomplete(displacement_mm: FloatArray, travel_mm: float) -> str:
    """Tell why a record is not one press and its release; empty text if it is.

    It must reach the last 0.3 mm of the travel and begin and end within 0.1 mm of the top.
    """
    deepest = float(displacement_mm.max())
    if deepest < travel_mm - SHORT_mm:
        return f"the press stopped at {deepest:.2f} of {travel_mm:.2f} mm"
    if displacement_mm[0] > EDGE_mm:
        return f"the record begins at {displacement_mm[0]:.2f} mm, after the press did"
    if displacement_mm[-1] > EDGE_mm:
        return f"the record ends at {displacement_mm[-1]:.2f} mm, before the release did"
    return ""


def split_strokes(
    displacement_mm: FloatArray, travel_mm: float, edge_mm: float = EDGE_mm
) -> tuple[Span, Span]:
    """Find the press and the release in a complete press: one pass each between the guards.

    The press runs from the last time above the upper guard to the first time at the lower one, the
    release from the last time at the lower guard to the next time at the upper one: dwell, impact and
    what came before contact belong to neither. The lower guard lies edge_mm before the stop, or before
    the deepest point where that is less deep.
    """
    deep = np.flatnonzero(displacement_mm >= min(travel_mm, float(displacement_mm.max())) - edge_mm)
    top = displacement_mm <= edge_mm
    first, last = int(deep[0]), int(deep[-1])
    before = np.flatnonzero(top[:first])
    after = np.flatnonzero(top[last:])
    start = int(before[-1]) + 1 if before.size else 0
    end = last + int(after[0]) if after.size else displacement_mm.size
    return Span(start, first), Span(last + 1, end)


def mean_speed_mm_s(t_s: FloatArray, displacement_mm: FloatArray, span: Span) -> float:
    """Give the mean speed of a stroke between the guards, always positive; NaN on fewer than 2 rows."""
    if span.end - span.start < 2:
        return float("nan")
    length = displacement_mm[span.end - 1] - displacement_mm[span.start]
    return float(abs(length) / (t_s[span.end - 1] - t_s[span.start]))

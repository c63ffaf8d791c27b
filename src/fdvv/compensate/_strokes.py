"""The two strokes in the record of one press."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.units import FloatArray

EDGE_mm = 0.1
"""Guard at both ends: below it the finger meets the cap, within it of the stop the cap bounces."""

HOME_mm = 0.1
"""Where a resting cap belongs: above the upper guard, where nothing is learned."""

FROM_mm, STOP_GUARD_mm = 0.3, 0.1
"""Errors count from 0.3 mm, where the finger has met the cap, to 0.1 mm before the stop."""

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
    """Tell why a record is not one press down to the stop; empty text if it is.

    It must begin in the upper half and reach the last 0.3 mm of the travel. A cap that does not come all
    the way back is a fault of the table, not of the press, and is left for the law to correct.
    """
    deepest = float(displacement_mm.max())
    if displacement_mm[0] > 0.5 * travel_mm:
        return f"the cap rested at {displacement_mm[0]:.2f} mm, where it should be up"
    if deepest < travel_mm - SHORT_mm:
        return f"the press stopped at {deepest:.2f} of {travel_mm:.2f} mm"
    return ""


def split_strokes(
    displacement_mm: FloatArray, travel_mm: float, edge_mm: float = EDGE_mm
) -> tuple[Span, Span]:
    """Find the press and the release in a press that reached the stop: one pass each between the guards.

    The press runs from the last time at the upper guard to the first time at the lower one, the release
    from the last time at the lower guard to the next time at the upper one: dwell, impact and what came
    before contact belong to neither. The lower guard lies edge_mm before the stop, or before the deepest
    point where that is less deep; the upper one at edge_mm, or that far below where the cap rests.
    """
    deep = np.flatnonzero(displacement_mm >= min(travel_mm, float(displacement_mm.max())) - edge_mm)
    first, last = int(deep[0]), int(deep[-1])
    before = np.flatnonzero(displacement_mm[:first] <= _upper(displacement_mm[0], edge_mm))
    after = np.flatnonzero(displacement_mm[last:] <= _upper(displacement_mm[-1], edge_mm))
    start = int(before[-1]) + 1 if before.size else 0
    end = last + int(after[0]) if after.size else displacement_mm.size
    return Span(start, first), Span(last + 1, max(last + 1, end))


def _upper(rest_mm: float, edge_mm: float) -> float:
    """Place the upper guard: edge_mm, or that far below a cap that rests deeper."""
    return edge_mm if rest_mm <= edge_mm else rest_mm + edge_mm


def mean_speed_mm_s(t_s: FloatArray, displacement_mm: FloatArray, span: Span) -> float:
    """Give the mean speed of a stroke between the guards, always positive; NaN on fewer than 2 rows."""
    if span.end - span.start < 2:
        return float("nan")
    length = displacement_mm[span.end - 1] - displacement_mm[span.start]
    return float(abs(length) / (t_s[span.end - 1] - t_s[span.start]))

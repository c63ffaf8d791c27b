"""Whether two cycles are repeats of one another.

Two cycles are of one population when, judged on the stroke that begins them (the press if both have it),

- contact, where the force first carries 10 cN, lies within 0.05 mm;
- the stop, where the force last passes half of the lesser of the two greatest forces, lies within
  0.05 mm of contact + travel;
- no stretch of the active travel of either stroke is missing (a jump of more than 0.5 mm);
- both cover the same travel from contact on, to 90 %;
- the median over the active travel of the difference in force, contacts aligned, is within
  max(1 gf, 2 % of the typical force) for each stroke, typical being the median force over that travel.

Levels of force are used, not the start of the stop: on rubber domes, whose stop is soft, its start
wavers by 0.2 mm between repeats that otherwise agree to 0.02 mm.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.capture._types import Cycle
from fdvv.model import Stroke, first_loaded
from fdvv.units import FloatArray, GRAM_FORCE_cN

PLACE_mm = 0.05
FORCE_LEAST_cN = 1.0 * GRAM_FORCE_cN
FORCE_PART = 0.02
GAP_mm = 0.5
STEP_mm = 0.005
TRAVEL_PART = 0.9


@dataclass(frozen=True, eq=False)
class Shape:
    """What the gate compares: strictly rising samples of each stroke, and the contact of the first."""

    strokes: dict[Stroke, tuple[FloatArray, FloatArray]]
    contact_mm: float
    top_cN: float

    def first(self) -> tuple[FloatArray, FloatArray]:
        """Give the stroke that begins the cycle."""
        return self.strokes.get(Stroke.PRESS) or self.strokes[Stroke.RELEASE]

    def last_below_mm(self, level_cN: float) -> float:
        """Give the deepest place where the force is below a level."""
        x, force = self.first()
        below = np.flatnonzero(force < level_cN)
        return float(x[below[-1]]) if below.size else float(x[0])


def shape_of(cycle: Cycle) -> Shape:
    """Take from a cycle what the gate compares."""
    strokes = {
        stroke: curve.by_displacement()[:2]
        for stroke in Stroke
        if (curve := cycle.press if stroke is Stroke.PRESS else cycle.release) is not None
    }
    x, force = strokes.get(Stroke.PRESS) or strokes[Stroke.RELEASE]
    return Shape(strokes, float(x[first_loaded(force)]), float(force.max()))


def how_differs(a: Shape, b: Shape) -> str:
    """Say in which respect b is of another population than a; empty if it is of the same."""
    if a is b:
        return ""
    if set(a.strokes) != set(b.strokes):
        return "it does not hold the same strokes"
    level = 0.5 * min(a.top_cN, b.top_cN)
    stops = a.last_below_mm(level), b.last_below_mm(level)
    contact = min(a.contact_mm, b.contact_mm)
    gap = _gap(a, contact, stops[0]) or _gap(b, contact, stops[1])
    if gap:
        return gap
    if abs(b.contact_mm - a.contact_mm) > PLACE_mm:
        return f"contact is shifted by {b.contact_mm - a.contact_mm:+.2f} mm"
    longer = (stops[1] - b.contact_mm) - (stops[0] - a.contact_mm)
    if abs(longer) > PLACE_mm:
        return f"the stop is shifted by {longer:+.2f} mm"
    apart = next((told for stroke in a.strokes if (told := _extent_differs(stroke, a, b))), "")
    if apart:
        return apart
    travel = min(stops[0] - a.contact_mm, stops[1] - b.contact_mm)
    return next((told for stroke in a.strokes if (told := _force_differs(stroke, a, b, travel))), "")


def _gap(shape: Shape, contact_mm: float, stop_mm: float) -> str:
    """Say how much of the active travel is missing in one jump; empty if none is."""
    for stroke, (x, _) in shape.strokes.items():
        missing = np.minimum(x[1:], stop_mm) - np.maximum(x[:-1], contact_mm)
        widest = float(missing.max())
        if widest > max(GAP_mm, 20.0 * float(np.median(np.diff(x)))):
            return f"{widest:.1f} mm of the {stroke} are missing"
    return ""


def _extent_differs(stroke: Stroke, a: Shape, b: Shape) -> str:
    """Say if two strokes, contacts aligned, do not cover the same travel; empty if they do to 90 %."""
    ends = [
        (max(s.strokes[stroke][0][0] - s.contact_mm, 0.0), s.strokes[stroke][0][-1] - s.contact_mm)
        for s in (a, b)
    ]
    common = min(end for _, end in ends) - max(start for start, _ in ends)
    if common < TRAVEL_PART * max(end - start for start, end in ends) or common <= 2.0 * STEP_mm:
        return (
            f"the {stroke} covers {ends[1][0]:.2f} to {ends[1][1]:.2f} mm from contact, not the same travel"
        )
    return ""


def _force_differs(stroke: Stroke, a: Shape, b: Shape, travel_mm: float) -> str:
    x = np.arange(0.0, max(travel_mm, STEP_mm), STEP_mm)
    mine = np.interp(x + a.contact_mm, *a.strokes[stroke])
    theirs = np.interp(x + b.contact_mm, *b.strokes[stroke])
    off = float(np.median(np.abs(theirs - mine)))
    limit = max(FORCE_LEAST_cN, FORCE_PART * float(np.median(np.abs(mine))))
    if off > limit:
        return f"force of the {stroke} differs by {off:.2f} cN (median), more than {limit:.2f}"
    return ""

"""One curve from repeats, when they are repeats.

The population is the largest set of cycles that agree with one of them. It must be more than half of the
cycles; otherwise the populations are mixed, and only the first is used.

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

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.force_text import force_number, force_text
from fdvv.formats.force.types import Cycle, ForceFile
from fdvv.model.bump import first_loaded
from fdvv.model.curve import MeasuredCurve, Stroke
from fdvv.units import FloatArray, GRAM_FORCE_cN

PLACE_mm = 0.05  # repeats agree to 0.02 mm; more than bump.RESOLUTION_mm would smear a bump in the mean
FORCE_LEAST_cN = 1.0 * GRAM_FORCE_cN
FORCE_PART = 0.02  # assumed; counts above a typical force of 49 cN, below it 1 gf is the larger
GAP_mm = 0.5  # as repair.JUMP_mm, from which on samples are reported missing
STEP_mm = 0.005  # a tenth of bump.RESOLUTION_mm; in a mean the own step of coarser files counts
TRAVEL_PART = 0.9  # assumed; a mean covers what is common to all, so a tenth at most is lost


@dataclass(frozen=True, eq=False)
class Shape:
    """What the gate compares: strictly rising samples of each stroke, and the contact of the first."""

    strokes: dict[Stroke, tuple[FloatArray, FloatArray]]
    contact_mm: float
    top_cN: float

    def last_below_mm(self, level_cN: float) -> float:
        """Return the deepest position where the force is below a level."""
        x, force = self.strokes.get(Stroke.PRESS) or self.strokes[Stroke.RELEASE]
        below = np.flatnonzero(force < level_cN)
        return float(x[below[-1]]) if below.size else float(x[0])


def shape_of(cycle: Cycle) -> Shape:
    strokes = {
        stroke: curve.by_displacement()[:2] for stroke in Stroke if (curve := cycle.of(stroke)) is not None
    }
    x, force = strokes.get(Stroke.PRESS) or strokes[Stroke.RELEASE]
    return Shape(strokes, float(x[first_loaded(x, force)]), float(force.max()))


def how_differs(a: Shape, b: Shape) -> str:
    """Describe how b differs from the population of a; empty if it does not."""
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
    apart = next((reason for stroke in a.strokes if (reason := _extent_differs(stroke, a, b))), "")
    if apart:
        return apart
    travel = min(stops[0] - a.contact_mm, stops[1] - b.contact_mm)
    return next((reason for stroke in a.strokes if (reason := _force_differs(stroke, a, b, travel))), "")


def _gap(shape: Shape, contact_mm: float, stop_mm: float) -> str:
    for stroke, (x, _) in shape.strokes.items():
        missing = np.minimum(x[1:], stop_mm) - np.maximum(x[:-1], contact_mm)
        widest = float(missing.max())
        if widest > max(GAP_mm, 20.0 * float(np.median(np.diff(x)))):
            return f"{widest:.1f} mm of the {stroke} are missing"
    return ""


def _extent_differs(stroke: Stroke, a: Shape, b: Shape) -> str:
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
        return (
            f"force of the {stroke} differs by {force_text(off, '.2f')} (median), more than "
            f"{force_number(limit, '.2f')}"
        )
    return ""


@dataclass(frozen=True, eq=False)
class Averaged:
    """The mean of the cycles of one population.

    Attributes
    ----------
    press, release : the mean on a common grid, aligned at contact; the raw samples if one cycle was used.
    actuation_mm, reset_mm : medians over the cycles used that have one.
    used : labels of the cycles averaged.
    left_out : label and reason of every other cycle.
    warnings : one sentence if the cycles are not one population.
    """

    press: MeasuredCurve | None
    release: MeasuredCurve | None
    actuation_mm: float | None
    reset_mm: float | None
    used: tuple[str, ...]
    left_out: tuple[tuple[str, str], ...] = ()
    warnings: tuple[str, ...] = ()


def average_by_velocity(file: ForceFile) -> tuple[Averaged, ...]:
    """Average the cycles of each velocity, in the order of the file.

    Measured velocities 10 % apart are different ones; stated ones are wherever they differ. Lone presses
    and lone releases are no repeats of each other: each stroke has its own mean.
    """
    groups: list[list[tuple[Cycle, str]]] = []
    for i, cycle in enumerate(file.cycles):
        home = next((group for group in groups if _of_one_velocity(group[0][0], cycle)), None)
        if home is None:
            groups.append(home := [])
        home.append((cycle, cycle.label or f"cycle {i + 1}"))
    return tuple(_average(part) for group in groups for part in _by_stroke(group))


def _by_stroke(group: list[tuple[Cycle, str]]) -> list[list[tuple[Cycle, str]]]:
    """Part a group of lone strokes by stroke; a group with a whole cycle in it stays together."""
    if any(cycle.press and cycle.release for cycle, _ in group):
        return [group]
    parts = [[named for named in group if named[0].of(stroke)] for stroke in Stroke]
    return [part for part in parts if part]


def _velocity(cycle: Cycle) -> float | None:
    return next((curve.velocity_mm_s for curve in (cycle.press, cycle.release) if curve is not None), None)


def _alike(a: float | None, b: float | None) -> bool:
    return a is b if a is None or b is None else abs(a - b) <= 0.1 * max(a, b)


def _of_one_velocity(a: Cycle, b: Cycle) -> bool:
    if a.stated and b.stated:
        return _velocity(a) == _velocity(b)
    return _alike(_velocity(a), _velocity(b))


def _average(named: Sequence[tuple[Cycle, str]]) -> Averaged:
    if len(named) == 1:
        cycle, label = named[0]
        return Averaged(cycle.press, cycle.release, cycle.actuation_mm, cycle.reset_mm, (label,))
    shapes = [shape_of(cycle) for cycle, _ in named]
    reasons = [[how_differs(a, b) for b in shapes] for a in shapes]
    agreeing = [[i for i, reason in enumerate(row) if not reason] for row in reasons]
    # of equally large populations that of the earliest cycle
    centre = max(range(len(named)), key=lambda i: (len(agreeing[i]), -i))
    keep = agreeing[centre]
    warnings: tuple[str, ...] = ()
    if 2 * len(keep) <= len(named):
        warning = (
            f"mixed populations: at most {len(keep)} of {len(named)} cycles agree; only the first was used"
        )
        keep, centre, warnings = [0], 0, (warning,)
    left_out = tuple(
        (label, reasons[centre][i] or "mixed populations")
        for i, (_, label) in enumerate(named)
        if i not in keep
    )
    cycles = [named[i][0] for i in keep]
    return Averaged(
        _mean(cycles, Stroke.PRESS),
        _mean(cycles, Stroke.RELEASE),
        _median([c.actuation_mm for c in cycles if c.actuation_mm is not None]),
        _median([c.reset_mm for c in cycles if c.reset_mm is not None]),
        tuple(named[i][1] for i in keep),
        left_out,
        warnings,
    )


def _median(values: list[float]) -> float | None:
    return float(np.median(values)) if values else None


def _mean(cycles: Sequence[Cycle], stroke: Stroke) -> MeasuredCurve | None:
    if len(cycles) == 1:
        return cycles[0].of(stroke)
    contacts = [shape_of(cycle).contact_mm for cycle in cycles]
    home = float(np.median(contacts))
    curves = [cycle.of(stroke) for cycle in cycles]
    lines = [
        (x - contact + home, force)
        for contact, curve in zip(contacts, curves, strict=True)
        if curve is not None
        for x, force, _ in [curve.by_displacement()]
    ]
    if not lines:
        return None
    step = max(STEP_mm, min(float(np.median(np.diff(x))) for x, _ in lines))
    start, end = max(x[0] for x, _ in lines), min(x[-1] for x, _ in lines)
    grid = step * np.arange(np.ceil(start / step), np.floor(end / step) + 1)
    force = np.mean([np.interp(grid, x, f) for x, f in lines], axis=0)
    speeds = [c.velocity_mm_s for c in curves if c is not None and c.velocity_mm_s is not None]
    return MeasuredCurve(grid, force, stroke, _median(speeds))

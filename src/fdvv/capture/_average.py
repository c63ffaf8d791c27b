"""One curve from repeats, when they are repeats: the replicate gate and the mean.

Two cycles are of one population when each stroke that both hold agrees:

- contact within 0.05 mm;
- bottom-out, measured from contact, within 0.05 mm (where both reached the stop);
- the median over the active travel of the difference in force, contacts aligned, within
  max(1 gf, 2 % of the typical force), typical being the median force over that travel;
- no stretch of the active travel is missing (a jump of more than 0.5 mm).

The population is the largest set of cycles that agree with one of them. It must be more than half of
the cycles; otherwise the populations are mixed, and only the first cycle is used.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fdvv.capture._types import Cycle, ForceFile
from fdvv.model import MeasuredCurve, Stroke, find_bottom_out_mm, find_contact_mm
from fdvv.units import FloatArray, GRAM_FORCE_cN

PLACE_mm = 0.05
FORCE_LEAST_cN = 1.0 * GRAM_FORCE_cN
FORCE_PART = 0.02
GAP_mm = 0.5
STEP_mm = 0.005


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


@dataclass(frozen=True, eq=False)
class _Shape:
    """What the gate compares of one stroke: where it begins and stops, and the force between."""

    contact_mm: float
    bottom_mm: float | None
    x_mm: FloatArray
    force_cN: FloatArray
    gap_mm: float


def average_cycles(file: ForceFile) -> Averaged:
    """Average the cycles of a file that are one population at the velocity of the first one.

    Cycles at other velocities are left out with a reason; ``average_by_velocity`` keeps them.
    """
    groups = _by_velocity(file.cycles)
    result = _average([(file.cycles[i], _label(file.cycles[i], i)) for i in groups[0]])
    others = tuple(
        (_label(file.cycles[i], i), f"measured at {_velocity(file.cycles[i])} mm/s, another velocity")
        for group in groups[1:]
        for i in group
    )
    warnings = result.warnings
    if others:
        warnings += (f"{len(others)} cycles at other velocities than the first were left out of the mean",)
    return replace(result, left_out=result.left_out + others, warnings=warnings)


def average_by_velocity(file: ForceFile) -> tuple[Averaged, ...]:
    """Average the cycles of each velocity (10 % apart is another one), in the order of the file."""
    return tuple(
        _average([(file.cycles[i], _label(file.cycles[i], i)) for i in group])
        for group in _by_velocity(file.cycles)
    )


def _velocity(cycle: Cycle) -> float | None:
    return next((curve.velocity_mm_s for curve in (cycle.press, cycle.release) if curve is not None), None)


def _label(cycle: Cycle, index: int) -> str:
    return cycle.label or f"cycle {index + 1}"


def _by_velocity(cycles: Sequence[Cycle]) -> list[list[int]]:
    groups: list[list[int]] = []
    for i, cycle in enumerate(cycles):
        home = next(
            (group for group in groups if _alike(_velocity(cycles[group[0]]), _velocity(cycle))), None
        )
        if home is None:
            groups.append([i])
        else:
            home.append(i)
    return groups


def _alike(a: float | None, b: float | None) -> bool:
    return a is b if a is None or b is None else abs(a - b) <= 0.1 * max(a, b)


def _average(named: Sequence[tuple[Cycle, str]]) -> Averaged:
    """Gate the cycles and average those that pass."""
    if len(named) == 1:
        cycle, label = named[0]
        return Averaged(cycle.press, cycle.release, cycle.actuation_mm, cycle.reset_mm, (label,))
    shapes = [
        {stroke: _shape(curve) for stroke in Stroke if (curve := _stroke(cycle, stroke)) is not None}
        for cycle, _ in named
    ]
    reasons = [[_differs(a, b) for b in shapes] for a in shapes]
    agreeing = [[i for i, reason in enumerate(row) if not reason] for row in reasons]
    centre = max(range(len(named)), key=lambda i: (len(agreeing[i]), -i))
    keep, warnings = agreeing[centre], ()
    if 2 * len(keep) <= len(named):
        told = f"mixed populations: at most {len(keep)} of {len(named)} cycles agree; only the first was used"
        keep, centre, warnings = [0], 0, (told,)
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


def _stroke(cycle: Cycle, stroke: Stroke) -> MeasuredCurve | None:
    return cycle.press if stroke is Stroke.PRESS else cycle.release


def _shape(curve: MeasuredCurve) -> _Shape:
    contact = find_contact_mm(curve)
    x, force, _ = curve.by_displacement()
    bottom = find_bottom_out_mm(curve, contact)
    end = x[-1] if bottom is None else bottom
    active = x[(x >= contact) & (x <= end)]
    gap = float(np.diff(active).max()) if active.size > 1 else 0.0
    return _Shape(contact, bottom, x, force, gap)


def _differs(a: dict[Stroke, _Shape], b: dict[Stroke, _Shape]) -> str:
    """Say in which respect b is of another population than a; empty if it is of the same."""
    if a is b:
        return ""
    if set(a) != set(b):
        return "it does not hold the same strokes"
    return next((reason for stroke in a if (reason := _stroke_differs(stroke, a[stroke], b[stroke]))), "")


def _stroke_differs(stroke: Stroke, a: _Shape, b: _Shape) -> str:
    for shape in (a, b):
        if shape.gap_mm > max(GAP_mm, 20.0 * float(np.median(np.diff(shape.x_mm)))):
            return f"{stroke}: {shape.gap_mm:.1f} mm of the travel are missing"
    if abs(b.contact_mm - a.contact_mm) > PLACE_mm:
        return f"{stroke}: contact is shifted by {b.contact_mm - a.contact_mm:+.2f} mm"
    if a.bottom_mm is not None and b.bottom_mm is not None:
        longer = (b.bottom_mm - b.contact_mm) - (a.bottom_mm - a.contact_mm)
        if abs(longer) > PLACE_mm:
            return f"{stroke}: bottom-out is shifted by {longer:+.2f} mm"
    return _force_differs(stroke, a, b)


def _force_differs(stroke: Stroke, a: _Shape, b: _Shape) -> str:
    ends = [s.x_mm[-1] if s.bottom_mm is None else s.bottom_mm for s in (a, b)]
    travel = min(ends[0] - a.contact_mm, ends[1] - b.contact_mm)
    x = np.arange(0.0, max(travel, STEP_mm), STEP_mm)
    mine = np.interp(x + a.contact_mm, a.x_mm, a.force_cN)
    theirs = np.interp(x + b.contact_mm, b.x_mm, b.force_cN)
    off, limit = float(np.median(np.abs(theirs - mine))), _force_limit_cN(mine)
    if off > limit:
        return f"{stroke}: force differs by {off:.1f} cN (median), more than {limit:.1f}"
    return ""


def _force_limit_cN(force_cN: FloatArray) -> float:
    return max(FORCE_LEAST_cN, FORCE_PART * float(np.median(np.abs(force_cN))))


def _mean(cycles: Sequence[Cycle], stroke: Stroke) -> MeasuredCurve | None:
    """Average one stroke over its common extent, contacts aligned at their median."""
    curves = [curve for cycle in cycles if (curve := _stroke(cycle, stroke)) is not None]
    if len(curves) < 2:
        return curves[0] if curves else None
    contacts = [find_contact_mm(curve) for curve in curves]
    home = float(np.median(contacts))
    lines = [
        (x - contact + home, force)
        for contact, (x, force, _) in zip(contacts, (c.by_displacement() for c in curves), strict=True)
    ]
    step = max(STEP_mm, min(float(np.median(np.diff(x))) for x, _ in lines))
    start, end = max(x[0] for x, _ in lines), min(x[-1] for x, _ in lines)
    grid = step * np.arange(np.ceil(start / step), np.floor(end / step) + 1)
    force = np.mean([np.interp(grid, x, f) for x, f in lines], axis=0)
    speeds = [curve.velocity_mm_s for curve in curves if curve.velocity_mm_s is not None]
    return MeasuredCurve(grid, force, stroke, _median(speeds))

"""One curve from repeats, when they are repeats.

The population is the largest set of cycles that agree with one of them (``_gate`` says when two do). It
must be more than half of the cycles; otherwise the populations are mixed, and only the first is used.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fdvv.capture._gate import STEP_mm, how_differs, shape_of
from fdvv.capture._types import Cycle, ForceFile
from fdvv.model import MeasuredCurve, Stroke


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
    shapes = [shape_of(cycle) for cycle, _ in named]
    reasons = [[how_differs(a, b) for b in shapes] for a in shapes]
    agreeing = [[i for i, reason in enumerate(row) if not reason] for row in reasons]
    centre = max(range(len(named)), key=lambda i: (len(agreeing[i]), -i))
    keep = agreeing[centre]
    warnings: tuple[str, ...] = ()
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


def _mean(cycles: Sequence[Cycle], stroke: Stroke) -> MeasuredCurve | None:
    """Average one stroke over its common extent, cycles aligned at the median of their contacts."""
    if len(cycles) == 1:
        return _stroke(cycles[0], stroke)
    contacts = [shape_of(cycle).contact_mm for cycle in cycles]
    home = float(np.median(contacts))
    curves = [_stroke(cycle, stroke) for cycle in cycles]
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

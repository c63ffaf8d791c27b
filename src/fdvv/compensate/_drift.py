"""Does a press still belong to the rig that is known, and if not, what changed?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.compensate._balance import (
    BACK_EMF,
    DELAY,
    ELECTRIC,
    FRICTION,
    GAIN,
    LAG,
    MASS,
    NUMBERS,
    PLAY,
    VISCOUS,
    WEIGHT,
)
from fdvv.compensate._identify import numbers_of, residual_cN
from fdvv.compensate._known_rig import KnownRig
from fdvv.compensate._prior import Prior
from fdvv.compensate._problem import Problem
from fdvv.compensate._ticks import ticks_of
from fdvv.model import Press
from fdvv.units import FloatArray

SURE = 4.0
"""Standard deviations beyond which a change is told; presses are many."""
MOST_changes = 3
STRANGE_ratio, STRANGE_cN = 3.0, 2.0
"""A press is strange beyond this many times what the known rig left unexplained, and by this more."""
SHARED_ratio = 0.25
"""Of a standard error counts against a change: errors go together, and a press repeats most of them."""
FREE = 1e6
"""Variance of a change that has been told, in squares of the prior's spread."""
LEAST = {"gain": 0.03, "drag": 0.15, "friction": 1.5, "weight": 3.0, "mass": 2.0, "play": 2.0, "lag": 2e-4}
"""Changes below these are not told: shares of gain and drag, else in the unit of the number."""

LEAST_drag_N_s_m = 0.2
ERRORS = {
    0: "gain",
    VISCOUS: "drag_N_s_m",
    FRICTION: "friction_cN",
    WEIGHT: "weight_cN",
    MASS: "mass_g",
    PLAY: "play_cN",
    LAG: "position_lag_s",
    ELECTRIC: "electric_lag_s",
}
"""Which standard error stands for which number."""


@dataclass(frozen=True, eq=False)
class _Change:
    """What may change: name and unit, along which numbers, from what value; least that is told, lowest."""

    name: str
    unit: str
    along: FloatArray
    was: float
    least: float
    lowest: float = 0.0


def drifted(
    known: KnownRig, press: Press, travel_mm: float = float("inf"), prior: Prior | None = None
) -> str:
    """Tell what of a rig has changed since it was known, from one ordinary press; empty text if nothing has.

    travel_mm : where the bottom stop was set; where the press ended, if not given.
    The press must hold its rig's own columns. FitError, one line, if it tells too little.
    """
    prior = prior or Prior()
    problem = Problem([ticks_of(press, "the press", prior.tick_s)], travel_mm, prior)
    problem.mean = numbers = numbers_of(known)
    runs = problem.runs(numbers)
    gradient, matrix = problem.normal(numbers, runs)
    strange_cN = max(STRANGE_ratio * known.residual_cN, known.residual_cN + STRANGE_cN)
    strange = residual_cN(problem, numbers, runs) > strange_cN
    found = _found(known, problem.spread, gradient, matrix - np.eye(numbers.size), strange)
    told = [_told(change, size) for change, size in found]
    left = residual_cN(problem, numbers + sum(size * change.along for change, size in found), runs)
    if left > strange_cN:
        told.append(f"{left:.1f} cN rms unexplained, {known.residual_cN:.1f} before; identify the rig again")
    return ", ".join(told)


def _found(
    known: KnownRig, spread: FloatArray, gradient: FloatArray, matrix: FloatArray, strange: bool
) -> list[tuple[_Change, float]]:
    """Find one change with its size after the other, the surest first; vectors in spreads of the prior.

    Of a strange press the likeliest change is told even if it is not sure.
    """
    found: list[tuple[_Change, float]] = []
    changes, doubt = _changes(known), np.diag((SHARED_ratio * _errors(known) / spread) ** 2)
    while len(found) < MOST_changes:
        shrunk = np.linalg.inv(np.eye(spread.size) + matrix @ doubt)
        slope, curve = shrunk @ gradient, shrunk @ matrix
        sized = [(change, *_size(change.along / spread, slope, curve)) for change in changes]
        possible = [one for one in sized if one[0].was + one[1] >= min(one[0].lowest, one[0].was)]
        if not possible:
            break
        change, size, sure = max(possible, key=lambda one: one[2])
        if sure < SURE and (found or not strange):
            break
        if abs(size) >= change.least:
            found.append((change, size))
        changes.remove(change)
        doubt = doubt + FREE * np.outer(change.along / spread, change.along / spread)
    return found


def _size(along: FloatArray, slope: FloatArray, curve: FloatArray) -> tuple[float, float]:
    """Give the size that explains most, and how many standard deviations it is."""
    weight = max(float(along @ curve @ along), 1e-12)
    size = float(along @ slope) / weight
    return size, abs(size) * weight**0.5


def _changes(known: KnownRig) -> list[_Change]:
    """List what may change: gain and drag in shares of what they were, the rest in their units."""
    numbers = numbers_of(known)

    def along(*parts: tuple[int | slice, FloatArray | float]) -> FloatArray:
        row = np.zeros(len(NUMBERS))
        for place, share in parts:
            row[place] = share
        return row

    # a warm coil pushes and brakes less, and braking counts at gain 1 with the square of the gain
    coil = along((GAIN, numbers[GAIN]), (BACK_EMF, -numbers[BACK_EMF]))
    least_drag = max(LEAST["drag"] * known.drag_N_s_m, LEAST_drag_N_s_m)
    return [
        _Change("gain", "", coil, 0.0, LEAST["gain"], -1.0),
        _Change("drag", "N s/m", along((VISCOUS, 1.0)), known.drag_N_s_m, least_drag),
        _Change("friction", "cN", along((FRICTION, 1.0)), known.friction_cN, LEAST["friction"]),
        _Change("weight", "cN", along((WEIGHT, 1.0)), known.weight_cN, LEAST["weight"], -np.inf),
        _Change("mass", "g", along((MASS, 1.0)), known.mass_g, LEAST["mass"]),
        _Change("play", "cN", along((PLAY, 0.5)), known.play_cN, LEAST["play"]),
        _Change("position lag", "ms", along((LAG, 1e-3)), 1e3 * known.position_lag_s, 1e3 * LEAST["lag"]),
        _Change("delay", "ms", along((DELAY, 1e-3)), 1e3 * known.delay_s, 1e3 * LEAST["lag"]),
    ]


def _errors(known: KnownRig) -> FloatArray:
    """Give how wrong each number may be, (12,); the gain's error counts for its first coefficient."""
    error = known.error
    found = np.zeros(len(NUMBERS))
    for place, name in ERRORS.items():
        found[place] = error.get(name, 0.0)
    found[PLAY] *= 0.5
    return found


def _told(change: _Change, size: float) -> str:
    moved = "rose" if size > 0 else "fell"
    if not change.unit:
        return f"{change.name} {moved} {abs(size):.0%}"
    digits = 2 if change.unit == "ms" else 1
    to = change.was + size
    share = f" ({size / change.was:+.0%})" if change.was > 0 else ""
    return f"{change.name} {moved} from {change.was:.{digits}f} to {to:.{digits}f} {change.unit}{share}"

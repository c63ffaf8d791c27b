"""The stroke in cells: bounds of each state's force, the transitions that may fire, states of rest."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from itertools import pairwise, product

import numpy as np

from fdvv.program.condition import Condition, Transition, When
from fdvv.program.program import Program, State, Velocity
from fdvv.program.surface import Limits
from fdvv.protocol.messages import UM16_PER_mm
from fdvv.units import FloatArray

SHALLOWEST_mm = -1.0  # assumed; the cap rests at 0 and its top stop holds it there
FASTEST_mm_s = 4000.0  # as condition.LARGEST_mm_s: no condition compares with more
WIDEST_mm = 0.05  # assumed; wider cells bound force less closely, narrower need more time


@dataclass(frozen=True)
class RestAnalysis:
    """A cap held still at a displacement, the velocities being what they are."""

    displacement_mm: float
    velocity_mm_s: dict[Velocity, float]

    def holds(self, condition: Condition, velocity: Velocity) -> bool:
        """Return whether a condition holds in a tick that begins with entering the state.

        Time, risings and fallings have just begun, turns and host events are used up.
        """
        value = condition.value
        match condition.when:
            case When.ALWAYS:
                return True
            case When.DEEPER_THAN:
                return self.displacement_mm > value
            case When.SHALLOWER_THAN:
                return self.displacement_mm < value
            case When.FASTER_THAN:
                return self.velocity_mm_s[velocity] > value
            case When.SLOWER_THAN:
                return self.velocity_mm_s[velocity] < value
            case When.AFTER | When.RISEN_BY | When.FALLEN_BY:
                return value == 0
            case _:
                return False

    def next_state(self, state: State) -> str | None:
        holding = (
            t.to for t in state.transitions if all(self.holds(c, state.velocity) for c in t.conditions)
        )
        return next(holding, None)


def find_hang(program: Program) -> tuple[list[str], RestAnalysis] | None:
    """Find states that follow each other for ever, one per tick, at some displacement and velocities.

    All displacements and velocities are covered: conditions can only change at the values they name, so one
    place within each interval between these, and each of them, represent all.
    """
    for stillness in _stillnesses(program):
        for state in program.states:
            cycle = _cycle(program, state, stillness)
            if cycle:
                return cycle, stillness
    return None


def _cycle(program: Program, start: State, stillness: RestAnalysis) -> list[str]:
    """Follow the states from one on; give those that repeat, if any do."""
    seen = [start.name]
    while True:
        name = stillness.next_state(program.state(seen[-1]))
        if name is None:
            return []
        if name in seen:
            return [*seen[seen.index(name) :], name]
        seen.append(name)


def _stillnesses(program: Program) -> Iterator[RestAnalysis]:
    places = _values(program, (When.DEEPER_THAN, When.SHALLOWER_THAN), None)
    speeds = [_values(program, (When.FASTER_THAN, When.SLOWER_THAN), source) for source in Velocity]
    here = _representatives(SHALLOWEST_mm, places, program.travel_mm)
    for place, *speeds_mm_s in product(here, *(_representatives(0.0, v, FASTEST_mm_s) for v in speeds)):
        yield RestAnalysis(place, dict(zip(Velocity, speeds_mm_s, strict=True)))


def conditions(program: Program) -> Iterator[tuple[State, Condition]]:
    """Yield every condition and guard of a program with its state."""
    for state in program.states:
        for transition in state.transitions:
            yield from ((state, condition) for condition in transition.conditions)


def _values(program: Program, kinds: tuple[When, ...], source: Velocity | None) -> set[float]:
    return {
        c.value for state, c in conditions(program) if c.when in kinds and source in (None, state.velocity)
    }


def _representatives(low: float, values: set[float], high: float) -> list[float]:
    """Return every value within the bounds, and a place between each two of them."""
    edges = sorted({low, high, *(v for v in values if low < v < high)})
    return sorted({*edges, *((a + b) / 2 for a, b in pairwise(edges))})


class Direction(Enum):
    """How the cap moves: down, or up and at rest."""

    DOWN = "down"
    UP = "up"


@dataclass(frozen=True, eq=False)
class Cells:
    """Intervals of displacement from 0 to the bottom stop.

    Attributes
    ----------
    edges_mm : (count + 1,) rising; every displacement that a condition names is one of them.
    least_cN, greatest_cN : (states, count) bounds of a state's force in a cell: both strokes, every velocity,
        the whole way of the bias, and what compiling changed.
    rearm_mm : above it a new press begins.
    """

    edges_mm: FloatArray
    least_cN: FloatArray
    greatest_cN: FloatArray
    rearm_mm: float

    @property
    def count(self) -> int:
        return self.edges_mm.size - 1

    def of(self, place_mm: float) -> int:
        """Return the cell in which a displacement lies; an edge belongs to the cell below it."""
        cell = int(np.searchsorted(self.edges_mm, place_mm, side="right")) - 1
        return min(max(cell, 0), self.count - 1)

    def may_hold(self, condition: Condition, cell: int, way: Direction) -> bool:
        """Return whether a condition may hold somewhere in a cell with the finger off."""
        low, high = self.edges_mm[cell], self.edges_mm[cell + 1]
        match condition.when:
            case When.DEEPER_THAN:
                return bool(high > condition.value)
            case When.SHALLOWER_THAN:
                return bool(low < condition.value)
            case When.TURNED_TO_PRESS:
                return way is Direction.DOWN or bool(low < self.rearm_mm)
            case When.TURNED_TO_RELEASE:
                return way is Direction.UP
            case When.HOST_EVENT:
                # the host's doing, not the program's own
                return False
            case _:
                return True

    def must_hold(self, condition: Condition, cell: int) -> bool:
        """Return whether a condition holds at every tick in a cell."""
        low, high = self.edges_mm[cell], self.edges_mm[cell + 1]
        match condition.when:
            case When.ALWAYS:
                return True
            case When.DEEPER_THAN:
                return bool(low >= condition.value)
            case When.SHALLOWER_THAN:
                return bool(high <= condition.value)
            case When.AFTER | When.RISEN_BY | When.FALLEN_BY:
                return condition.value == 0
            case _:
                return False

    def may_fire(self, transition: Transition, cell: int, way: Direction) -> bool:
        guard = transition.only_if or Condition(When.ALWAYS)
        both = (transition.when, guard)
        if not all(self.may_hold(c, cell, way) for c in both):
            return False
        return all(_fits_way(condition, other, way) for condition, other in (both, both[::-1]))

    def must_fire(self, transition: Transition, cell: int) -> bool:
        return all(self.must_hold(c, cell) for c in transition.conditions)


def _fits_way(condition: Condition, other: Condition, way: Direction) -> bool:
    """A rise begins to count on the way up, a fall on the way down; it may still count on the way back, where
    only another condition, which comes true later, has kept the transition from firing."""
    if condition.value == 0:
        return True
    if condition.when is When.RISEN_BY and other.when in (When.ALWAYS, When.SHALLOWER_THAN):
        return way is Direction.UP
    if condition.when is When.FALLEN_BY and other.when in (When.ALWAYS, When.DEEPER_THAN):
        return way is Direction.DOWN
    return True


def make_cells(program: Program, limits: Limits, margin_cN: float) -> Cells:
    """Cut the stroke at every displacement that a condition names, and no cell wider than 0.05 mm.

    margin_cN : how far the compiled forces may be from the program's.
    """
    named = _values(program, (When.DEEPER_THAN, When.SHALLOWER_THAN), None) | {limits.top_mm}
    even = np.linspace(0.0, program.travel_mm, int(np.ceil(program.travel_mm / WIDEST_mm)) + 1)
    inner = [v for v in named if 0 < v < program.travel_mm]
    edges = np.unique(np.concatenate([even, inner]))
    bounds = [_bounds_cN(program, state, edges) for state in program.states]
    return Cells(
        edges,
        np.array([low for low, _ in bounds]) - margin_cN,
        np.array([high for _, high in bounds]) + margin_cN,
        limits.settings.rearm_um16 / UM16_PER_mm,
    )


def _bounds_cN(program: Program, state: State, edges_mm: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Bound the force of a state in each cell: lines have their extremes at their ends."""
    low = np.full(edges_mm.size - 1, np.inf)
    high = -low
    for name in {state.press, state.release}:
        surface = program.surface(name)
        points = np.union1d(edges_mm, surface.displacement_mm)
        points = points[(points >= 0) & (points <= edges_mm[-1])]
        begins = np.searchsorted(points, edges_mm)
        for row in range(len(surface.velocity_mm_s)):
            force = surface.row_cN(row, points)
            for cell, (first, last) in enumerate(pairwise(begins)):
                low[cell] = min(low[cell], force[first : last + 1].min())
                high[cell] = max(high[cell], force[first : last + 1].max())
    least, most = state.biases_cN()
    return low + least, high + most

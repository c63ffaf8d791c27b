"""Programs that hang: states that follow each other while nothing moves."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise, product

from fdvv.program._condition import Condition, When
from fdvv.program._program import Program, State, Velocity

SHALLOWEST_mm = -1.0
FASTEST_mm_s = 4000.0


@dataclass(frozen=True)
class Stillness:
    """A cap held still at a displacement, the velocities being what they are."""

    displacement_mm: float
    velocity_mm_s: dict[Velocity, float]

    def holds(self, condition: Condition, velocity: Velocity) -> bool:
        """Tell whether a condition holds in a tick that begins with entering the state.

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
        """Give the state that follows at once, or None."""
        for transition in state.transitions:
            conditions = (transition.when, *([transition.only_if] if transition.only_if else []))
            if all(self.holds(c, state.velocity) for c in conditions):
                return transition.to
        return None


def find_hang(program: Program) -> tuple[list[str], Stillness] | None:
    """Find states that follow each other for ever, one per tick, at some displacement and velocities.

    All displacements and velocities are covered: conditions can only change at the values they name, so one
    place within each interval between these, and each of them, stand for all.
    """
    for stillness in _stillnesses(program):
        for state in program.states:
            cycle = _cycle(program, state, stillness)
            if cycle:
                return cycle, stillness
    return None


def _cycle(program: Program, start: State, stillness: Stillness) -> list[str]:
    """Follow the states from one on; give those that repeat, if any do."""
    seen = [start.name]
    while True:
        name = stillness.next_state(program.state(seen[-1]))
        if name is None:
            return []
        if name in seen:
            return [*seen[seen.index(name) :], name]
        seen.append(name)


def _stillnesses(program: Program) -> Iterator[Stillness]:
    places = _values(program, (When.DEEPER_THAN, When.SHALLOWER_THAN), None)
    speeds = [_values(program, (When.FASTER_THAN, When.SLOWER_THAN), source) for source in Velocity]
    here = _representatives(SHALLOWEST_mm, places, program.travel_mm)
    for place, *found in product(here, *(_representatives(0.0, v, FASTEST_mm_s) for v in speeds)):
        yield Stillness(place, dict(zip(Velocity, found, strict=True)))


def conditions(program: Program) -> Iterator[tuple[State, Condition]]:
    """Give every condition and guard of a program with its state."""
    for state in program.states:
        for transition in state.transitions:
            yield state, transition.when
            if transition.only_if:
                yield state, transition.only_if


def _values(program: Program, kinds: tuple[When, ...], source: Velocity | None) -> set[float]:
    return {
        c.value for state, c in conditions(program) if c.when in kinds and source in (None, state.velocity)
    }


def _representatives(low: float, values: set[float], high: float) -> list[float]:
    """Give every value within the bounds, and a place between each two of them."""
    edges = sorted({low, high, *(v for v in values if low < v < high)})
    return sorted({*edges, *((a + b) / 2 for a, b in pairwise(edges))})

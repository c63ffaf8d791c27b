"""Random small programs: some hang, some never come back, some are fine."""

from __future__ import annotations

import numpy as np

from fdvv.program.condition import Condition, Transition, When
from fdvv.program.program import Program, State
from fdvv.program.surface import Surface, line

TRAVEL_mm = 4.0


def random_program(rng: np.random.Generator) -> Program:
    """Draw two to four states with pushing and pulling surfaces and any conditions."""
    names = [f"s{i}" for i in range(rng.integers(2, 5))]
    surfaces = tuple(_surface(rng, i) for i in range(3))
    states = tuple(_state(rng, i, name, names, surfaces) for i, name in enumerate(names))
    return Program("random", TRAVEL_mm, names[0], states, surfaces)


def _surface(rng: np.random.Generator, index: int) -> Surface:
    pulls = index == 2 and rng.random() < 0.5
    low, high = (-60, -10) if pulls else (15, 90)
    places = np.sort(rng.choice(np.arange(1, 20), 3, replace=False)) * 0.2
    points = [(0.0, 30.0), *((float(x), float(rng.uniform(low, high))) for x in places)]
    return line(f"f{index}", *(points if not pulls else points[1:]))


def _state(
    rng: np.random.Generator, index: int, name: str, names: list[str], surfaces: tuple[Surface, ...]
) -> State:
    chosen = surfaces[int(rng.integers(2 if index == 0 else 3))].name
    ways = [_onward(rng, names, index)] if index + 1 < len(names) else []
    if index > 0:
        ways += [_back(rng, names, index) for _ in range(rng.integers(1, 3))]
    order = rng.permutation(len(ways))
    fade_ms = int(rng.choice([0, 0, 20]))
    return State(name, chosen, chosen, tuple(ways[i] for i in order), key=index, fade_ms=fade_ms)


def _onward(rng: np.random.Generator, names: list[str], index: int) -> Transition:
    """Lead on where the cap is deep, deeper for later states as a rule."""
    to, place = names[index + 1], round(float(rng.uniform(0.6, 3.6)), 2)
    guard = Condition(When.DEEPER_THAN, place)
    return (
        Transition(to, guard),
        Transition(to, guard),
        Transition(to, Condition(When.FALLEN_BY, 0.2), guard),
        Transition(to, Condition(When.TURNED_TO_RELEASE), guard),
    )[rng.integers(4)]


def _back(rng: np.random.Generator, names: list[str], index: int) -> Transition:
    """Lead to an earlier state: near the top, in time, or on the way up."""
    to, place = names[int(rng.integers(index))], round(float(rng.uniform(0.15, 2.0)), 2)
    return (
        Transition(to, Condition(When.SHALLOWER_THAN, place)),
        Transition(to, Condition(When.SHALLOWER_THAN, place)),
        Transition(to, Condition(When.AFTER, int(rng.integers(5, 60)))),
        Transition(to, Condition(When.RISEN_BY, 0.3), Condition(When.SHALLOWER_THAN, place)),
    )[rng.integers(4)]

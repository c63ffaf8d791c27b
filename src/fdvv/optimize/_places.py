"""Places of the unit cube that hold the constraints and were not tried yet: what every engine draws from."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from fdvv.errors import BuildError, InputError
from fdvv.optimize._engine import Problem
from fdvv.optimize._space import DesignSpace
from fdvv.optimize._trial import Trial, TrialState
from fdvv.units import FloatArray

SAME = 1e-6
"""Two places nearer than this in every parameter, in parts of its range, are one design."""
ROUNDS, WALKERS = 60, 64
OPEN = (TrialState.SUGGESTED, TrialState.SHOWN)

Draw = Callable[[int], FloatArray]
"""Draws so many more places, (n, d)."""


def generator(problem: Problem, trials: Sequence[object], purpose: int = 0) -> np.random.Generator:
    """Give the random numbers of the next suggestion: of the seed and of how many trials there are."""
    return np.random.default_rng([problem.seed & 0xFFFFFFFF, len(trials), purpose])


def holds(space: DesignSpace, places: FloatArray) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Tell, (n,), which places (n, d) hold every constraint."""
    if not space.constraints:
        return np.ones(len(places), dtype=np.bool_)
    return np.array([not space.broken(design) for design in space.of_unit(places)], dtype=np.bool_)


def fresh(places: FloatArray, tried: FloatArray) -> FloatArray:
    """Leave out places that were tried or come twice; the order stays."""
    places = places[_apart(places, np.reshape(tried, (-1, places.shape[1])))]
    twice = np.zeros(len(places), dtype=np.bool_)
    for i in np.flatnonzero(~_apart_from_others(places)):
        twice[i] = np.any(np.abs(places[:i][~twice[:i]] - places[i]).max(axis=1, initial=0.0) < SAME)
    return np.asarray(places[~twice])


def _apart(places: FloatArray, tried: FloatArray) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Tell, (n,), which places are none of those tried."""
    apart = np.ones(len(places), dtype=np.bool_)
    for one in tried:
        apart &= np.abs(places - one).max(axis=1) >= SAME
    return apart


def _apart_from_others(places: FloatArray) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Tell, (n,), which places surely come once: their first parameter is nobody else's."""
    order = np.argsort(places[:, 0], kind="stable")
    near = np.diff(places[order, 0]) < SAME
    lonely = np.ones(len(places), dtype=np.bool_)
    lonely[order[1:]] &= ~near
    lonely[order[:-1]] &= ~near
    return lonely


def tried_places(space: DesignSpace, trials: Sequence[Trial]) -> FloatArray:
    """Give the places of all trials that may have taught something; of an abandoned one too."""
    return space.to_unit([trial.design for trial in trials])


def draw_feasible(problem: Problem, draw: Draw, tried: FloatArray, count: int) -> FloatArray:
    """Draw until count places hold the constraints and are new, (count, d).

    Where drawing finds too few, places are led towards the constraints. InputError where none is found.
    """
    space, found = problem.space, np.empty((0, len(problem.space.names)))
    for size in (max(2 * count, 16), 256, 1024):
        places = draw(size)
        found = fresh(np.vstack([found, places[holds(space, places)]]), tried)
        if len(found) >= count:
            return found[:count]
    led = lead(space, draw(WALKERS), np.random.default_rng(problem.seed & 0xFFFFFFFF))
    found = fresh(np.vstack([found, led]), tried)
    if not len(found):
        told = "; ".join(one.told for one in space.constraints)
        raise InputError(
            "space", space.name, f"no design was found that holds: {told}", "loosen a constraint"
        )
    return _filled(space, found, tried, count)


def _filled(space: DesignSpace, found: FloatArray, tried: FloatArray, count: int) -> FloatArray:
    """Walk about the few places that were found until there are enough; a single point repeats."""
    rng = np.random.default_rng(len(tried))
    for _ in range(ROUNDS):
        if len(found) >= count:
            break
        around = found[rng.integers(len(found), size=WALKERS)]
        near = np.clip(around + rng.normal(0.0, 0.05, around.shape), 0.0, 1.0)
        found = fresh(np.vstack([found, near[holds(space, near)]]), tried)
    return np.resize(found, (count, found.shape[1])) if len(found) < count else found[:count]


def lead(space: DesignSpace, places: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Walk places downhill in what they miss of the constraints; give those that arrive."""
    missed = missed_by(space, places)
    step = np.full(len(places), 0.3)
    for _ in range(ROUNDS):
        if not np.any(missed > 0):
            break
        moved = np.clip(places + rng.normal(size=places.shape) * step[:, None], 0.0, 1.0)
        there = missed_by(space, moved)
        better = there < missed
        places, missed = np.where(better[:, None], moved, places), np.where(better, there, missed)
        step = np.where(better, step * 1.3, step * 0.85)
    return places[missed <= 0]


def missed_by(space: DesignSpace, places: FloatArray) -> FloatArray:
    """Sum, (n,), what places (n, d) miss of the constraints; infinite where a slack is not a number."""
    rows = [[one.slack(design) for one in space.constraints] for design in space.of_unit(places)]
    missed = -np.minimum(np.array(rows).reshape(len(places), -1), 0.0).sum(axis=1)
    return np.where(np.isnan(missed), np.inf, missed)


def missing(part: str, extra: str, error: ImportError) -> BuildError:
    """Say which extra an engine needs."""
    return BuildError(f"the engine {part} needs {error.name}: pip install 'fdvv[{extra}]'")

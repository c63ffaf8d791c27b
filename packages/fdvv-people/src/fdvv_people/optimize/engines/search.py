"""Places of the unit cube that hold the constraints and were not tried yet: what every engine draws from."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from itertools import islice

import numpy as np

from fdvv.errors import BuildError, InputError
from fdvv.units import FloatArray
from fdvv_people.optimize.problem import Problem, Trial
from fdvv_people.optimize.space import DesignSpace

SAME = 1e-6
"""Two places nearer than this in every parameter, in parts of its range, are one design."""
ROUNDS, WALKERS = 60, 64
Draw = Callable[[int], FloatArray]
"""Draws n more places, (n, d)."""


def generator(problem: Problem, trials: Sequence[object], purpose: int = 0) -> np.random.Generator:
    """Return the random numbers of the next suggestion: of the seed and of how many trials there are."""
    # NumPy takes no seed below 0
    return np.random.default_rng([problem.seed & 0xFFFFFFFF, len(trials), purpose])


def holds(space: DesignSpace, places: FloatArray) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Return, (n,), which places (n, d) hold every constraint."""
    if not space.constraints:
        return np.ones(len(places), dtype=np.bool_)
    return np.array([not space.broken(design) for design in space.of_unit(places)], dtype=np.bool_)


def fresh(places: FloatArray, tried: FloatArray) -> FloatArray:
    """Leave out places that were tried or come twice; the order stays."""
    for one in np.reshape(tried, (-1, places.shape[1])):
        places = places[np.abs(places - one).max(axis=1) >= SAME]
    # only a place whose first parameter is another's too can come twice: not all pairs need a look
    order = np.argsort(places[:, 0], kind="stable")
    near = np.flatnonzero(np.diff(places[order, 0]) < SAME)
    twice = np.zeros(len(places), dtype=np.bool_)
    for i in np.unique(order[[*near, *near + 1]]):
        twice[i] = np.any(np.abs(places[:i][~twice[:i]] - places[i]).max(axis=1, initial=0.0) < SAME)
    return np.asarray(places[~twice])


def tried_places(space: DesignSpace, trials: Sequence[Trial]) -> FloatArray:
    """Return the places, (n, d), of all designs of trials, one after the other; of abandoned ones too."""
    return space.to_unit([design for trial in trials for design in trial.designs])


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
        texts = "; ".join(one.text for one in space.constraints)
        raise InputError(
            "space", space.name, f"no design was found that holds: {texts}", "loosen a constraint"
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
    """Walk places downhill in what they miss of the constraints; return those that arrive."""
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
    """Return the error that names the extra an engine needs."""
    return BuildError(f"the engine {part} needs {error.name}: pip install 'fdvv[{extra}]'")


EVEN, LOCAL = 768, 256
STEPS = (0.2, 0.05, 0.0125)
"""Widths of the local looks, parts of a range."""
FEW = 4
"""Places from which the next, finer look starts."""
Acquisition = Callable[[FloatArray], FloatArray]
"""Worth, (n,), of trying places (n, d); any scale, larger is better."""


def even_net(problem: Problem, seed: int) -> FloatArray:
    """Return an even net of places, (n, d), whether they hold the constraints or not."""
    return sobol_draw(len(problem.space.names), seed)(EVEN)


def most_wanted(
    problem: Problem,
    worth: Acquisition,
    net: FloatArray,
    tried: FloatArray,
    seed: int,
    about: FloatArray,
    shaped: Callable[[FloatArray], FloatArray] = lambda places: places,
    local: int = LOCAL,
) -> FloatArray:
    """Return the new place (d,) of largest worth in a net, around the places about (k, d), then nearer.

    A constraint may cost more than the acquisition: it is asked from the most wanted place on, only until
    some hold it. shaped : what becomes of candidates, (n, d), before they are weighed.
    local : candidates of each finer look; fewer where the acquisition is slow.
    """
    rng, space = np.random.default_rng([seed, 4]), problem.space
    best = _best(space, fresh(shaped(net), tried), worth)
    if not len(best[0]):
        some = draw_feasible(problem, lambda n: rng.random((n, net.shape[1])), tried, FEW)
        best = some, worth(some)
    begin = np.vstack([best[0], about])
    for width in STEPS:
        around = begin[rng.integers(len(begin), size=local)]
        # one parameter alone or all at once: ridges lie along either
        mask = rng.random(around.shape) < rng.choice([1.0, 2.0 / around.shape[1]], size=(local, 1))
        near = np.clip(around + width * mask * rng.normal(size=around.shape), 0.0, 1.0)
        places, value = _best(space, fresh(shaped(near), tried), worth)
        places, value = np.vstack([best[0], places]), np.append(best[1], value)
        order = np.argsort(-value)[:FEW]
        best = places[order], value[order]
        begin = best[0]
    return np.asarray(begin[0])


def _best(space: DesignSpace, places: FloatArray, worth: Acquisition) -> tuple[FloatArray, FloatArray]:
    """Return the few most wanted places that hold the constraints, (k, d), and their worth, (k,)."""
    if not len(places):
        return places, np.empty(0)
    value = worth(places)
    holding = (i for i in np.argsort(-value).tolist() if holds(space, places[i : i + 1])[0])
    found = list(islice(holding, FEW))
    return places[found], value[found]


def log_expected_improvement(mean: FloatArray, sd: FloatArray, least: float) -> FloatArray:
    """Return the log of E[max(least - f, 0)], (n,), of normal f; exact far below zero too.

    Ament et al., Unexpected Improvements to Expected Improvement for Bayesian Optimization (2023), eq. 9.
    """
    from scipy.special import erfcx, ndtr

    z = (least - mean) / sd
    density = np.exp(-0.5 * z**2) / np.sqrt(2 * np.pi)
    near = np.log(np.maximum(density + z * ndtr(z), 1e-300))
    low = np.minimum(z, -1.0)
    # phi(z) + z Phi(z) = phi(z) (1 + z sqrt(pi / 2) erfcx(-z / sqrt 2))
    ratio = np.maximum(1.0 + low * np.sqrt(np.pi / 2) * erfcx(-low / np.sqrt(2)), 1e-300)
    # far out the bracket loses its digits; there it is 1 / z^2
    bracket = np.where(low < -1e3, -2 * np.log(-low), np.log(ratio))
    far = -0.5 * low**2 - 0.5 * np.log(2 * np.pi) + bracket
    return np.asarray(np.where(z > -1.0, near, far) + np.log(sd))


def random_places(problem: Problem, trials: Sequence[Trial], count: int) -> FloatArray:
    """Draw places (count, d) uniformly, new ones that hold the constraints."""
    rng, d = generator(problem, trials), len(problem.space.names)
    return draw_feasible(problem, lambda n: rng.random((n, d)), tried_places(problem.space, trials), count)


def sobol_places(problem: Problem, tried: FloatArray, count: int) -> FloatArray:
    """Return the next places (count, d) of the problem's sequence: the first that were not tried."""
    draw = sobol_draw(len(problem.space.names), problem.seed)
    # those already tried are at its beginning and are skipped
    draw_ahead = len(tried) + count
    return draw_feasible(problem, lambda n: draw(max(n, draw_ahead)), tried, count)


def sobol_draw(dimensions: int, seed: int) -> Draw:
    """Return a scrambled Sobol sequence that is drawn on from call to call."""
    from scipy.stats import qmc

    # a stream of its own: other engines seed their generators with the bare number
    sequence = qmc.Sobol(dimensions, rng=np.random.default_rng([seed & 0xFFFFFFFF, 1]))

    def draw(count: int) -> FloatArray:
        with warnings.catch_warnings():
            # its balance asks for powers of two; here points come one by one
            warnings.simplefilter("ignore", UserWarning)
            return np.asarray(sequence.random(count), dtype=np.float64)

    return draw

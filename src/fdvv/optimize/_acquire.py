"""Where an acquisition is largest: even and local candidates that hold the constraints, then a finer look."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fdvv.optimize._engine import Problem
from fdvv.optimize._places import draw_feasible, fresh, holds
from fdvv.optimize._plain import SobolDraw
from fdvv.optimize._space import DesignSpace
from fdvv.units import FloatArray

EVEN, LOCAL = 768, 256
STEPS = (0.2, 0.05, 0.0125)
"""Widths of the local looks, parts of a range."""
FEW = 4
"""Places from which the next, finer look starts."""

Acquisition = Callable[[FloatArray], FloatArray]
"""Worth, (n,), of trying places (n, d); any scale, larger is better."""


def even_net(problem: Problem, seed: int) -> FloatArray:
    """Give an even net of places, (n, d), whether they hold the constraints or not."""
    return SobolDraw(len(problem.space.names), seed)(EVEN)


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
    """Give the new place (d,) of largest worth in a net, around the places about (k, d), and by finer looks.

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
    """Give the few most wanted places that hold the constraints, (k, d), and their worth, (k,)."""
    if not len(places):
        return places, np.empty(0)
    value = worth(places)
    found: list[int] = []
    for i in np.argsort(-value).tolist():
        if holds(space, places[i : i + 1])[0]:
            found.append(i)
        if len(found) == FEW:
            break
    return places[found], value[found]


def log_expected_improvement(mean: FloatArray, sd: FloatArray, least: float) -> FloatArray:
    """Give the log of E[max(least - f, 0)], (n,), of normal f; exact far below zero too.

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

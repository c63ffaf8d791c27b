"""Engines that look at no score: random designs and an even net of them."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from fdvv.optimize._belief import believed_best
from fdvv.optimize._engine import Problem
from fdvv.optimize._places import draw_feasible, generator, tried_places
from fdvv.optimize._trial import Trial
from fdvv.units import FloatArray


@dataclass(frozen=True)
class RandomEngine:
    """Draw designs at random, uniformly."""

    name: str = field(default="random", init=False)

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        """Suggest, see Engine."""
        rng, space = generator(problem, trials), problem.space
        tried = tried_places(space, trials)
        places = draw_feasible(problem, lambda n: rng.random((n, len(space.names))), tried, count)
        return space.of_unit(places)

    def best(self, problem: Problem, trials: Sequence[Trial]) -> dict[str, float]:
        """Recommend, see Engine."""
        return believed_best(problem, trials)


@dataclass(frozen=True)
class SobolEngine:
    """Take the points of a scrambled Sobol sequence in turn, those that hold the constraints."""

    name: str = field(default="sobol", init=False)

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        """Suggest, see Engine."""
        places = sobol_places(problem, tried_places(problem.space, trials), count)
        return problem.space.of_unit(places)

    def best(self, problem: Problem, trials: Sequence[Trial]) -> dict[str, float]:
        """Recommend, see Engine."""
        return believed_best(problem, trials)


def sobol_places(problem: Problem, tried: FloatArray, count: int) -> FloatArray:
    """Give the next places (count, d) of the problem's sequence: the first that were not tried."""
    draw = SobolDraw(len(problem.space.names), problem.seed)
    # those already tried stand at its beginning and are passed over
    draw_ahead = len(tried) + count
    return draw_feasible(problem, lambda n: draw(max(n, draw_ahead)), tried, count)


class SobolDraw:
    """A scrambled Sobol sequence in d dimensions that is drawn on from call to call."""

    def __init__(self, dimensions: int, seed: int) -> None:
        from scipy.stats import qmc

        # a stream of its own: other engines seed their generators with the bare number
        self._sequence = qmc.Sobol(dimensions, rng=np.random.default_rng([seed & 0xFFFFFFFF, 1]))

    def __call__(self, count: int) -> FloatArray:
        """Draw the next count places, (count, d)."""
        with warnings.catch_warnings():
            # its balance asks for powers of two; here points come one by one
            warnings.simplefilter("ignore", UserWarning)
            return np.asarray(self._sequence.random(count), dtype=np.float64)

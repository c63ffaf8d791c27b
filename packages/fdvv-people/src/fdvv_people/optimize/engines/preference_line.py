"""What a person likes best, from lines: they feel the stops of a line and choose the best of them.

Koyama, Sato, Sakamoto and Igarashi, Sequential Line Search for efficient visual design optimization by crowds
(2017): the search in many dimensions is cut into lines that a person can walk along. Here the next line is
that of some random ones through the favourite whose best stop is expected to be worth most, as qEUBO
(Astudillo et al. 2023) chooses its designs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import islice

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.optimize.engines.preference import PreferenceBelief, believe_choices, favourite
from fdvv_people.optimize.engines.search import FEW, draw_feasible, generator, holds
from fdvv_people.optimize.problem import Problem, Trial

REACH = (1.0, 0.5, 0.25)
"""Parts of the way from the favourite to the bounds that a line goes."""
SAMPLES = 64  # a mean's error is 1/8 of the spread; all lines share the draws, so most of it cancels


@dataclass(frozen=True)
class PreferenceLineEngine:
    """Suggest the line through the favourite whose best stop is expected to be worth most.

    Stops that do not hold the constraints are left out.

    Parameters
    ----------
    stops : of a line, evenly spaced. lines : random ones that the next is chosen from.
    """

    stops: int = 9
    lines: int = 48
    name: str = field(default="preference-line", init=False)

    def __post_init__(self) -> None:
        if self.stops < 2 or self.lines < 1:
            raise ModelError(f"a line needs 2 stops or more and is chosen from 1 or more, got {self}")

    @property
    def trial_size(self) -> int:
        return self.stops

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        rng, d = generator(problem, trials, 10), len(problem.space.names)
        belief = believe_choices(problem.space, trials, of_lines=True)
        middle = np.full(d, 0.5) if belief is None else belief.most_liked(belief.places)
        ways = self._ways(rng, middle, 1.0 if belief is None else rng.choice(REACH, size=self.lines))
        worth = np.zeros(self.lines) if belief is None else expected_best(belief, ways, rng)
        found = self._holding(problem, ways[np.argsort(-worth, kind="stable")], belief, rng)
        return problem.space.of_unit(found)

    def _ways(self, rng: np.random.Generator, middle: FloatArray, reach: FloatArray | float) -> FloatArray:
        """Draw lines through a place, each towards a random one and back, (lines, stops, d)."""
        towards = rng.random((self.lines, len(middle))) - middle
        with np.errstate(divide="ignore"):
            low, high = -middle / towards, (1.0 - middle) / towards
        part = np.broadcast_to(reach, self.lines)
        back, on = np.minimum(low, high).max(axis=1), np.maximum(low, high).min(axis=1)
        steps = np.linspace(part * back, part * on, self.stops, axis=1)
        return np.clip(middle + steps[:, :, None] * towards[:, None, :], 0.0, 1.0)

    def _holding(
        self, problem: Problem, ways: FloatArray, belief: PreferenceBelief | None, rng: np.random.Generator
    ) -> FloatArray:
        """Return the stops that hold the constraints, of the line where most is expected of them."""
        held = (way[holds(problem.space, way)] for way in ways)
        some = list(islice((way for way in held if len(way) > 1), FEW if problem.space.constraints else 1))
        if not some:
            return self._between(problem, belief, rng)
        if belief is None:
            return max(some, key=len)
        return max(some, key=lambda way: float(expected_best(belief, way[None], rng)[0]))

    def _between(
        self, problem: Problem, belief: PreferenceBelief | None, rng: np.random.Generator
    ) -> FloatArray:
        """Return a line between two places that hold the constraints, where no other line was found."""
        known = np.empty((0, len(problem.space.names))) if belief is None else belief.places
        ends = draw_feasible(problem, lambda n: rng.random((n, known.shape[1])), known, 2)
        if belief is not None:
            ends[0] = belief.most_liked(known)
        way = np.linspace(ends[0], ends[1], self.stops)
        inside = holds(problem.space, way)
        # rounding may push an end over a constraint that it lies on
        inside[[0, -1]] = True
        return way[inside]

    def best(self, problem: Problem, trials: Sequence[Trial]) -> dict[str, float]:
        return favourite(believe_choices(problem.space, trials, of_lines=True), problem.space)


def expected_best(belief: PreferenceBelief, ways: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Return the expected worth, (n,), of the best stop of each line (n, stops, d), from samples."""
    normal = rng.standard_normal((SAMPLES, ways.shape[1]))
    found = np.empty(len(ways))
    for number, way in enumerate(ways):
        mean, cov = belief.predict(way)
        root = np.linalg.cholesky(cov + 1e-6 * np.eye(len(way)))
        found[number] = (mean + normal @ root.T).max(axis=1).mean()
    return found

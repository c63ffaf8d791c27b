"""Find what a person likes best from comparisons of two designs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from fdvv.errors import ModelError
from fdvv.optimize._engine import Problem
from fdvv.optimize._places import draw_feasible, generator
from fdvv.optimize._preference_belief import believe_answers
from fdvv.optimize._trial import Comparison
from fdvv.units import FloatArray

Pair = tuple[dict[str, float], dict[str, float]]


@dataclass(frozen=True)
class PreferenceEngine:
    """Compare the favourite so far with the most promising of some designs drawn at random.

    A person always compares with what they know; chance in the draw is what explores. In few answers and
    eight dimensions this found more than looking everywhere for the largest expected worth of the better
    one, which leads to the corners, where least is known (docs/explanation/optimisation.md).

    Parameters
    ----------
    drawn : designs that the challenger is chosen from; more of them trust the belief more.
    """

    drawn: int = 128
    name: str = field(default="preference", init=False)

    def pair(self, problem: Problem, comparisons: Sequence[Comparison]) -> Pair:
        """Suggest, see PairEngine."""
        rng, d = generator(problem, comparisons, 9), len(problem.space.names)
        tried = compared_places(problem, comparisons)
        belief = believe_answers(problem.space, comparisons)
        count = 2 if belief is None else self.drawn
        net = draw_feasible(problem, lambda n: rng.random((n, d)), tried, count)
        if belief is not None:
            favourite = belief.places[int(np.argmax(belief.mean(belief.places)))]
            net = np.vstack([favourite, net[int(np.argmax(belief.mean(net)))]])
        first, second = problem.space.of_unit(net)
        # neither place of the two is always the favourite's
        return (first, second) if rng.random() < 0.5 else (second, first)

    def best(self, problem: Problem, comparisons: Sequence[Comparison]) -> dict[str, float]:
        """Recommend the most liked design that was compared, see PairEngine."""
        belief = believe_answers(problem.space, comparisons)
        if belief is None:
            raise ModelError("no comparison is answered yet, so there is no favourite")
        return problem.space.of_unit(belief.places[int(np.argmax(belief.mean(belief.places)))])[0]


def compared_places(problem: Problem, comparisons: Sequence[Comparison]) -> FloatArray:
    """Give the places, (2 n, d), of compared designs, pair by pair."""
    return problem.space.to_unit([design for one in comparisons for design in (one.first, one.second)])

"""Does the preference mode find a person's hidden favourite region in ten comparisons? Simulated.

A person has a hidden utility over the paper's eight parameters, of one of three kinds: an ideal button with a
weight for every parameter, the same along turned axes, or that with waves on it. They answer "equal" where
utilities differ by less than 0.15 of its standard deviation over the space, and err with noise of 0.3 of it.
The region is the tenth (fifth) of all designs that they like best; it is found if the design recommended lies
in it. "champion" keeps the preferred of a random pair and compares it with another random design.

    python -m benchmarks.preference_regions [--people 80] [--comparisons 10] [--engines preference,champion]
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.optimize.engines.registry import pair_engine_of
from fdvv.optimize.paper_space import paper_space
from fdvv.optimize.problem import Answer, Comparison, PairEngine, Problem
from fdvv.task.score import Objective
from fdvv.units import FloatArray

SPACE = paper_space()
DIMENSIONS = len(SPACE.names)
KINDS = ("ideal", "turned", "waves")
EQUAL, NOISE = 0.15, 0.3
Utility = Callable[[FloatArray], FloatArray]


def person(seed: int, kind: str) -> Utility:
    rng = np.random.default_rng([seed, KINDS.index(kind), 7001])
    ideal, weights = rng.random(DIMENSIONS), rng.dirichlet(np.ones(DIMENSIONS))
    axes = np.eye(DIMENSIONS) if kind == "ideal" else np.linalg.qr(rng.normal(size=(DIMENSIONS,) * 2))[0]
    waves, phase = rng.normal(size=(10, DIMENSIONS)) * 2.5, rng.uniform(0, 2 * np.pi, 10)
    height = 0.08 * rng.normal(size=10) if kind == "waves" else np.zeros(10)

    def utility(places: FloatArray) -> FloatArray:
        bowl = -(((places - ideal) @ axes) ** 2) @ weights
        return np.asarray(bowl + np.cos(places @ waves.T + phase) @ height)

    return utility


@dataclass(frozen=True)
class Champion:
    name: str = "champion"

    def pair(
        self, problem: Problem, comparisons: Sequence[Comparison]
    ) -> tuple[dict[str, float], dict[str, float]]:
        rng = np.random.default_rng([problem.seed, len(comparisons), 7002])
        first, second = problem.space.of_unit(rng.random((2, DIMENSIONS)))
        return (self.best(problem, comparisons) if comparisons else first), second

    def best(self, problem: Problem, comparisons: Sequence[Comparison]) -> dict[str, float]:
        last = comparisons[-1]
        return last.second if last.answer is Answer.SECOND else last.first


def rank(engine: PairEngine, seed: int, kind: str, count: int) -> float:
    """Return the part of all designs that a person likes better than the one recommended."""
    utility, rng = person(seed, kind), np.random.default_rng([seed, 7003])
    everywhere = utility(np.random.default_rng(7004).random((4000, DIMENSIONS)))
    problem, comparisons = Problem(SPACE, (Objective("liking"),), seed), list[Comparison]()
    for number in range(count):
        first, second = engine.pair(problem, comparisons)
        a, b = utility(SPACE.to_unit([first, second]))
        gap = (a - b) / everywhere.std() + NOISE * rng.normal()
        answer = Answer.EQUAL if abs(gap) < EQUAL else Answer.FIRST if gap > 0 else Answer.SECOND
        comparisons.append(Comparison(number, first, second, answer))
    return float((everywhere > utility(SPACE.to_unit([engine.best(problem, comparisons)]))).mean())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--people", type=int, default=80)
    parser.add_argument("--comparisons", type=int, default=10)
    parser.add_argument("--engines", default="preference,champion")
    options = parser.parse_args()
    print(f"simulated: {options.people} people of each kind, {options.comparisons} comparisons")
    for name in options.engines.split(","):
        engine = Champion() if name == Champion.name else pair_engine_of(name)
        for kind in KINDS:
            ranks = np.array([rank(engine, s, kind, options.comparisons) for s in range(options.people)])
            low, middle, high = np.percentile(ranks, [5, 50, 95])
            print(
                f"{name:20s} {kind:7s} best tenth {np.mean(ranks <= 0.1):4.0%}, best fifth"
                f" {np.mean(ranks <= 0.2):4.0%}; better designs: median {middle:.1%},"
                f" 5-95 % {low:.1%}-{high:.1%}",
                flush=True,
            )


if __name__ == "__main__":
    main()

"""Does the preference mode find a person's hidden favourite region in a few answers? Simulated.

A person has a hidden utility over the paper's eight parameters, of one of three kinds: an ideal button with a
weight for every parameter, the same along turned axes, or that with waves on it. They answer "equal" where
utilities differ by less than 0.15 of its standard deviation over the space, and err with noise of 0.3 of it.
The region is the tenth (fifth) of all designs that they like best; it is found if the design recommended lies
in it. "champion" keeps the preferred of a random pair and compares it with another random design.

A line is one answer: a person feels every stop, each with that noise, and chooses the best. "champion-line"
goes on in a random direction from the stop that was chosen last.

    python -m benchmarks.preference_regions [--people 80] [--comparisons 10] [--first 0]
        [--engines preference,champion,preference-line,champion-line]

Engines are chosen with people whose numbers (--first) are 100000 or more, and judged with those from 0 on.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fdvv.units import FloatArray
from fdvv_people.optimize.engines.preference_line import PreferenceLineEngine
from fdvv_people.optimize.engines.registry import engine_of
from fdvv_people.optimize.paper_space import paper_space
from fdvv_people.optimize.problem import Engine, Problem, Trial, TrialState
from fdvv_people.stats.share import share
from fdvv_people.task.score import Objective

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
    trial_size: ClassVar[int] = 2

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        rng = np.random.default_rng([problem.seed, len(trials), 7002])
        first, second = problem.space.of_unit(rng.random((2, DIMENSIONS)))
        return [self.best(problem, trials) if trials else first, second]

    def best(self, problem: Problem, trials: Sequence[Trial]) -> dict[str, float]:
        last = trials[-1]
        return last.designs[last.best[0] if last.best else 0]


@dataclass(frozen=True)
class ChampionLine(Champion):
    name: str = "champion-line"
    trial_size: ClassVar[int] = 9

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        rng = np.random.default_rng([problem.seed, len(trials), 7005])
        middle = SPACE.to_unit([self.best(problem, trials)])[0] if trials else np.full(DIMENSIONS, 0.5)
        (way,) = PreferenceLineEngine(lines=1)._ways(rng, middle, 1.0)
        return SPACE.of_unit(way)


CHAMPIONS = {"champion": Champion, "champion-line": ChampionLine}
Feel = Callable[[Sequence[dict[str, float]]], FloatArray]
"""Worth of designs to a person, in SD over the space."""


def answered(
    engine: Engine, problem: Problem, feel: Feel, rng: np.random.Generator, count: int
) -> dict[str, float]:
    """Return the design that is recommended after count comparisons or lines."""
    trials = list[Trial]()
    for number in range(count):
        design, *beside = engine.suggest(problem, trials)
        best = _best(feel([design, *beside]), rng)
        trials.append(Trial(number, design, TrialState.DONE, beside=tuple(beside), best=best))
    return engine.best(problem, trials)


def _best(worth: FloatArray, rng: np.random.Generator) -> tuple[int, ...]:
    """Return which of some designs a person says is best; of two also both."""
    if len(worth) > 2:
        return (int((worth + NOISE * rng.normal(size=len(worth))).argmax()),)
    gap = worth[0] - worth[1] + NOISE * rng.normal()
    return (0, 1) if abs(gap) < EQUAL else (0,) if gap > 0 else (1,)


def rank(name: str, seed: int, kind: str, count: int) -> float:
    """Return the part of all designs that a person likes better than the one recommended."""
    utility, rng = person(seed, kind), np.random.default_rng([seed, 7003])
    everywhere = utility(np.random.default_rng(7004).random((4000, DIMENSIONS)))
    problem = Problem(SPACE, (Objective("liking"),), seed)

    def feel(designs: Sequence[dict[str, float]]) -> FloatArray:
        return np.asarray(utility(SPACE.to_unit(designs)) / everywhere.std())

    engine = CHAMPIONS[name]() if name in CHAMPIONS else engine_of(name)
    best = answered(engine, problem, feel, rng, count)
    return float((everywhere > utility(SPACE.to_unit([best]))).mean())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--people", type=int, default=80)
    parser.add_argument("--comparisons", type=int, default=10)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--engines", default="preference,champion,preference-line,champion-line")
    options = parser.parse_args()
    print(f"simulated: {options.people} people of each kind, {options.comparisons} answers")
    people = range(options.first, options.first + options.people)
    for name in options.engines.split(","):
        for kind in KINDS:
            ranks = np.array([rank(name, s, kind, options.comparisons) for s in people])
            low, middle, high = np.percentile(ranks, [5, 50, 95])
            found = share(int(np.sum(ranks <= 0.1)), len(ranks))
            print(
                f"{name:20s} {kind:7s} best tenth {found.share:4.0%} (95 % {found.low:.0%}-{found.high:.0%}),"
                f" best fifth {np.mean(ranks <= 0.2):4.0%}; better designs: median {middle:.1%},"
                f" 5-95 % {low:.1%}-{high:.1%}",
                flush=True,
            )


if __name__ == "__main__":
    main()

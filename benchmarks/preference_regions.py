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

import numpy as np

from fdvv.optimize.engines.preference_line import PreferenceLineEngine
from fdvv.optimize.engines.registry import LINE_ENGINES, line_engine_of, pair_engine_of
from fdvv.optimize.paper_space import paper_space
from fdvv.optimize.problem import Answer, Comparison, Line, LineEngine, PairEngine, Problem
from fdvv.stats.share import share
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


@dataclass(frozen=True)
class ChampionLine:
    name: str = "champion-line"

    def line(self, problem: Problem, lines: Sequence[Line]) -> tuple[dict[str, float], ...]:
        rng = np.random.default_rng([problem.seed, len(lines), 7005])
        middle = SPACE.to_unit([self.best(problem, lines)])[0] if lines else np.full(DIMENSIONS, 0.5)
        (way,) = PreferenceLineEngine(lines=1)._ways(rng, middle, 1.0)
        return tuple(SPACE.of_unit(way))

    def best(self, problem: Problem, lines: Sequence[Line]) -> dict[str, float]:
        return lines[-1].stops[lines[-1].best or 0]


Feel = Callable[[Sequence[dict[str, float]]], FloatArray]
"""Worth of designs to a person, in SD over the space."""


def compared(
    engine: PairEngine, problem: Problem, feel: Feel, rng: np.random.Generator, count: int
) -> dict[str, float]:
    """Return the design that is recommended after count comparisons."""
    comparisons = list[Comparison]()
    for number in range(count):
        first, second = engine.pair(problem, comparisons)
        a, b = feel([first, second])
        gap = a - b + NOISE * rng.normal()
        answer = Answer.EQUAL if abs(gap) < EQUAL else Answer.FIRST if gap > 0 else Answer.SECOND
        comparisons.append(Comparison(number, first, second, answer))
    return engine.best(problem, comparisons)


def walked(
    engine: LineEngine, problem: Problem, feel: Feel, rng: np.random.Generator, count: int
) -> dict[str, float]:
    """Return the design that is recommended after count lines."""
    lines = list[Line]()
    for number in range(count):
        stops = engine.line(problem, lines)
        felt = feel(stops) + NOISE * rng.normal(size=len(stops))
        lines.append(Line(number, stops, int(felt.argmax())))
    return engine.best(problem, lines)


def rank(name: str, seed: int, kind: str, count: int) -> float:
    """Return the part of all designs that a person likes better than the one recommended."""
    utility, rng = person(seed, kind), np.random.default_rng([seed, 7003])
    everywhere = utility(np.random.default_rng(7004).random((4000, DIMENSIONS)))
    problem = Problem(SPACE, (Objective("liking"),), seed)

    def feel(designs: Sequence[dict[str, float]]) -> FloatArray:
        return np.asarray(utility(SPACE.to_unit(designs)) / everywhere.std())

    if name in LINE_ENGINES or name == ChampionLine.name:
        on_lines = ChampionLine() if name == ChampionLine.name else line_engine_of(name)
        best = walked(on_lines, problem, feel, rng, count)
    else:
        engine = Champion() if name == Champion.name else pair_engine_of(name)
        best = compared(engine, problem, feel, rng, count)
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

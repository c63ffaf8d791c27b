"""Do the options of the engine gp help: what a change costs, and a person who learns? Simulated.

Scores come from smooth functions over the paper's eight parameters (a bowl in four of them, with waves), read
with noise of 7.5 ms and standard errors of 20 presses; no simulated person is in it. Shown is the true value
of the recommended design above the best of 4000 random ones: median and 5-95 % over seeds.

cost: a new force takes 180 s to compensate, a trial 60 s; both ways have the same 45 minutes.
learn: the person starts slower by 25 ms, which fades with a time constant of 8 trials; 27 trials.
still: the same without any learning: what the option costs where it is not needed.
others: 60 finished trials of others whose function differs by a share of its own; 13 trials.

    python -m benchmarks.optimize_options [--seeds 20] [--cases cost,learn,still,others]
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from fdvv.units import FloatArray
from fdvv_people.optimize.engines.gp import ChangeCost
from fdvv_people.optimize.engines.registry import engine_of
from fdvv_people.optimize.paper_space import paper_space
from fdvv_people.optimize.problem import Problem, Trial, TrialState
from fdvv_people.optimize.space import LENGTH
from fdvv_people.task.score import Objective, Score

# no person smooths these functions
SPACE = replace(paper_space(), length=LENGTH)
DIMENSIONS = len(SPACE.names)
NOISE_ms, PRESSES = 7.5, 20
BUDGET_s, TRIALS = 2700.0, 27
BUILD_s = {name: 180.0 for name in SPACE.names if name[0] in "xy"}
Truth = Callable[[FloatArray], FloatArray]
Drift = Callable[[int], float]


def function(seed: int) -> Truth:
    """Make a function of places, (n, d) to (n,), in ms."""
    rng = np.random.default_rng([seed, 8001])
    ideal, weights = rng.uniform(0.2, 0.8, DIMENSIONS), np.zeros(DIMENSIONS)
    weights[rng.permutation(DIMENSIONS)[:4]] = rng.uniform(0.5, 2.0, 4)
    waves, phase = 3.0 * rng.normal(size=(12, DIMENSIONS)), rng.uniform(0, 2 * np.pi, 12)
    height = 3.0 * rng.normal(size=12)

    def truth(places: FloatArray) -> FloatArray:
        bowl = ((places - ideal) ** 2) @ weights / weights.sum()
        return np.asarray(60.0 + 120.0 * bowl + np.cos((places - 0.5) @ waves.T + phase) @ height)

    return truth


def run(
    options: dict[str, Any], seed: int, drift: Drift, prior: tuple[Trial, ...] = (), trials: int = TRIALS
) -> float:
    """Return how far the recommended design is above the best of many, ms."""
    truth, engine = function(seed), engine_of("gp", options)
    least = float(truth(np.random.default_rng(8002).random((4000, DIMENSIONS))).min())
    problem, found = Problem(SPACE, (Objective("asynchrony_ms"),), seed, prior), list[Trial]()
    spent_s, cost = 0.0, ChangeCost(60.0, BUILD_s)
    while len(found) < trials:
        (design,) = engine.suggest(problem, found)
        places = SPACE.to_unit([trial.design for trial in found])
        if trials > TRIALS:
            spent_s += float(cost.seconds(SPACE, SPACE.to_unit([design]), places)[0])
            if spent_s > BUDGET_s:
                break
        found.append(scored(len(found), design, truth, seed, drift(len(found))))
    return float(truth(SPACE.to_unit([engine.best(problem, found)]))[0]) - least


def scored(number: int, design: dict[str, float], truth: Truth, seed: int, more_ms: float) -> Trial:
    rng = np.random.default_rng([seed, number, 8003])
    value = float(truth(SPACE.to_unit([design]))[0]) + more_ms + NOISE_ms * rng.normal()
    error = NOISE_ms * float(np.sqrt(rng.chisquare(PRESSES - 1) / (PRESSES - 1)))
    return Trial(number, design, TrialState.DONE, {"asynchrony_ms": Score(value, error)})


def others(seed: int, share: float) -> tuple[Trial, ...]:
    """Return trials of somebody whose function is another one by a share."""
    own, alien = function(seed), function(seed + 500)

    def theirs(places: FloatArray) -> FloatArray:
        return np.asarray((1 - share) * own(places) + share * alien(places))

    designs = engine_of("sobol").suggest(Problem(SPACE, (Objective("asynchrony_ms"),), seed + 9), [], 60)
    return tuple(scored(i, design, theirs, seed + 700, 0.0) for i, design in enumerate(designs))


def still(number: int) -> float:
    return 0.0


def learns(number: int) -> float:
    return 25.0 * float(np.exp(-number / 8.0))


def report(name: str, values: list[float]) -> None:
    low, middle, high = np.percentile(values, [5, 50, 95])
    print(
        f"{name:42s} median {middle:5.1f} ms, 5-95 % {low:5.1f} to {high:5.1f}, mean {np.mean(values):5.1f}",
        flush=True,
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--cases", default="cost,learn,still,others")
    options = parser.parse_args()
    seeds, cases = range(options.seeds), options.cases.split(",")
    print(f"simulated: {options.seeds} functions, above the best of 4000 random designs")
    if "cost" in cases:
        for name, given in (("cost unknown", {}), ("cost known", {"build_s": BUILD_s})):
            report(f"{name}, 45 minutes", [run(given, s, still, trials=99) for s in seeds])
    ways: dict[str, dict[str, Any]] = {"plain": {}, "trend": {"trend": True}, "forget 15": {"forget": 15.0}}
    for case, drift in (("learn", learns), ("still", still)):
        for name, given in ways.items() if case in cases else ():
            report(f"{case}: {name}", [run(given, s, drift) for s in seeds])
    for share in (0.0, 0.3, 1.0) if "others" in cases else ():
        report(f"others differ by {share:.0%}", [run({}, s, still, others(s, share), 13) for s in seeds])
    if "others" in cases:
        report("nobody else, 13 trials", [run({}, s, still, trials=13) for s in seeds])


if __name__ == "__main__":
    main()

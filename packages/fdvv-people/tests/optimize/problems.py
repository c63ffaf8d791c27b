"""Problems whose answer is known, for tests of engines."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from fdvv_people.optimize.problem import Engine, Problem, Trial, TrialState
from fdvv_people.optimize.space import Constraint, Design, DesignSpace, Parameter
from fdvv_people.task.score import Objective, Score

BOWL = DesignSpace("bowl", tuple(Parameter(f"p{i}_mm", -2.0, 4.0) for i in range(3)))
LIMIT = Constraint("sum", "the sum stays below 2 mm", lambda d: 2.0 - sum(d.values()))
HELD = DesignSpace("held bowl", BOWL.parameters, (LIMIT,))
NOISE_ms = 3.0


def bowl_ms(design: Design) -> float:
    """Return a score whose minimum, 60 ms, is where every parameter is 1 mm."""
    return 60.0 + sum(4.0 * (value - 1.0) ** 2 for value in design.values())


def problem(space: DesignSpace = BOWL, seed: int = 0, prior: tuple[Trial, ...] = ()) -> Problem:
    return Problem(space, (Objective("asynchrony_ms"),), seed, prior)


def scored(number: int, design: Design, value: float, error: float | None = NOISE_ms) -> Trial:
    return Trial(number, dict(design), TrialState.DONE, {"asynchrony_ms": Score(value, error)})


def run(
    engine: Engine,
    case: Problem,
    count: int,
    truth: Callable[[Design], float] = bowl_ms,
    noise_ms: float = NOISE_ms,
    trials: Sequence[Trial] = (),
) -> list[Trial]:
    """Let an engine try count designs, each scored with noise of its own."""
    found = list(trials)
    for _ in range(count):
        (design,) = engine.suggest(case, found)
        rng = np.random.default_rng([case.seed, len(found)])
        found.append(scored(len(found), design, truth(design) + noise_ms * rng.normal(), noise_ms))
    return found

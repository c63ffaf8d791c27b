"""What engines are compared with and the project does not ship: scikit-optimize, and a fixed design.

scikit-optimize is no dependency: ``pip install scikit-optimize`` where the comparison is to have it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from fdvv.units import FloatArray
from fdvv_people.optimize.engines.gp_model import finished
from fdvv_people.optimize.engines.search import random_places
from fdvv_people.optimize.problem import Problem, Trial


@dataclass
class ScikitOptimize:
    """The GP with expected improvement of scikit-optimize, as ``gp_minimize`` makes it by default.

    Ten random designs, a fitted noise, the best score seen as its answer. Its search weighs 10,000 random
    places that hold the constraints; they are drawn from a pool, because it would ask the constraints 70,000
    times a suggestion (25 s). Of one run: it remembers what it was given.

    Parameters
    ----------
    pool : places of the unit cube that hold the constraints, (n, d). startup : random designs.
    """

    pool: FloatArray
    trial_size: ClassVar[int] = 1
    startup: int = 10
    name: str = field(default="scikit-optimize", init=False)
    _optimizer: Any = field(default=None, init=False, repr=False)
    _given: int = field(default=0, init=False, repr=False)

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        if len(trials) < self.startup:
            return problem.space.of_unit(random_places(problem, trials, count))
        if self._optimizer is None:
            self._optimizer = _optimizer(problem, self.startup, self.pool)
        for trial in trials[self._given :]:
            place = problem.space.to_unit([trial.design])[0].tolist()
            self._optimizer.tell(place, trial.scores[problem.objectives[0].name].value)
        self._given = len(trials)
        return problem.space.of_unit([self._optimizer.ask() for _ in range(count)])

    def best(self, problem: Problem, trials: Sequence[Trial]) -> dict[str, float]:
        return dict(min(trials, key=lambda trial: trial.scores[problem.objectives[0].name].value).design)


def _optimizer(problem: Problem, startup: int, pool: FloatArray) -> Any:
    from skopt import Optimizer, Space
    from skopt.utils import cook_estimator

    ranges = [(0.0, 1.0)] * len(problem.space.names)
    # numbers of 32 bits, as RandomState takes
    seed = problem.seed & 0x7FFFFFFF
    estimator = cook_estimator("GP", space=Space(ranges), random_state=seed, noise="gaussian")
    # with a constraint it samples too instead of following the gradient, which knows none
    optimizer = Optimizer(
        ranges,
        estimator,
        acq_func="EI",
        acq_optimizer="sampling",
        n_initial_points=startup,
        random_state=seed,
    )

    def drawn(n_samples: int = 1, random_state: Any = None) -> list[list[float]]:
        rows: list[list[float]] = pool[random_state.randint(len(pool), size=n_samples)].tolist()
        return rows

    optimizer.space.rvs = drawn
    return optimizer


@dataclass(frozen=True)
class FixedDesign:
    """The design that others scored best on average: no trial changes it."""

    trial_size: ClassVar[int] = 1
    name: str = field(default="fixed design", init=False)

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        return [self.best(problem, trials)] * count

    def best(self, problem: Problem, trials: Sequence[Trial]) -> dict[str, float]:
        del trials
        name, others = problem.objectives[0].name, finished(problem, problem.prior)
        return dict(others[int(np.argmin([trial.scores[name].value for trial in others]))].design)

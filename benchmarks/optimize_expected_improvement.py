"""The plain baseline of engines: expected improvement by a Gaussian process, errors of scores unknown to it.

It is the default of GPyOpt 1.2, the paper's library: one Matern-5/2 length for all parameters, a fitted
noise, improvement on the best score seen, five random designs first, and the best score seen as the answer.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from fdvv.units import FloatArray
from fdvv_people.optimize.engines.gp_model import believed_best, best_of, finished, fitted_process, observed
from fdvv_people.optimize.engines.search import (
    even_net,
    generator,
    log_expected_improvement,
    most_wanted,
    random_places,
    tried_places,
)
from fdvv_people.optimize.problem import Problem, Trial


@dataclass(frozen=True)
class GPExpectedImprovement:
    """Expected improvement on the best score seen, errors of scores unknown to it.

    All options but the first are there to tune the baseline as hard as what is compared with it.

    Parameters
    ----------
    smoothed : recommend by the posterior mean instead of the best score seen.
    startup : random designs before the process may learn.
    jitter : of the scores' standard deviation, by which improvement must exceed.
    ard : a length per parameter instead of one for all.
    plug_in : improve on the best posterior mean of a tried design instead of the best score seen.
    """

    trial_size: ClassVar[int] = 1
    smoothed: bool = False
    startup: int = 5
    jitter: float = 0.0
    ard: bool = False
    plug_in: bool = False
    name: str = field(default="gp-ei", init=False)

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        """Suggest, see Engine. Raises ModelError on several objectives."""
        if len(finished(problem, trials)) < self.startup:
            return problem.space.of_unit(random_places(problem, trials, count))
        done = best_of(problem, trials)
        scores = observed(problem.space, problem.objectives[0], done)
        centre, scale = float(np.mean(scores.values)), float(np.std(scores.values)) or 1.0
        y = (scores.values - centre) / scale
        model = _fitted(scores.places, y, self.ard)
        least = model.predict(scores.places).min() if self.plug_in else y.min()
        tried = tried_places(problem.space, trials)
        seed = int(generator(problem, trials, 8).integers(2**31))
        net = even_net(problem, seed)
        chosen = np.empty((0, tried.shape[1]))

        def worth(places: FloatArray) -> FloatArray:
            mean, sd = model.predict(places, return_std=True)
            return log_expected_improvement(mean, np.maximum(sd, 1e-9), float(least) - self.jitter)

        about = scores.places[np.argsort(y)[:2]]
        for i in range(count):
            place = most_wanted(problem, worth, net, np.vstack([tried, chosen]), seed + i, about)
            chosen = np.vstack([chosen, place])
        return problem.space.of_unit(chosen)

    def best(self, problem: Problem, trials: Sequence[Trial]) -> dict[str, float]:
        """Recommend the design of the best score, see Engine."""
        if self.smoothed:
            return believed_best(problem, trials)
        done = best_of(problem, trials)
        values = observed(problem.space, problem.objectives[0], done).values
        return dict(done[int(np.argmin(values))].design)


def _fitted(X: FloatArray, y: FloatArray, ard: bool) -> Any:
    lengths = np.full(X.shape[1] if ard else 1, 0.5)
    numbers = (1.0, (1e-3, 1e3)), (lengths, (1e-2, 1e2)), (0.1, (1e-6, 1e1))
    model = fitted_process("gp-ei", X, y, *numbers, n_restarts_optimizer=4, random_state=0)
    # what is improved upon is the function, not the next noisy score
    model.kernel_.k2.noise_level = 1e-12
    return model

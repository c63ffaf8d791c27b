"""The plain baseline: what the paper's library did by default.

GPyOpt 1.2: a Gaussian process with one Matern-5/2 length for all parameters and a fitted noise, expected
improvement on the best score seen, five random designs first, and the best score seen as the answer.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from fdvv.errors import InputError
from fdvv.optimize._acquire import even_net, log_expected_improvement, most_wanted
from fdvv.optimize._belief import believed_best, best_of, finished, observed
from fdvv.optimize._engine import Problem
from fdvv.optimize._places import generator, missing, tried_places
from fdvv.optimize._plain import RandomEngine
from fdvv.optimize._trial import Trial
from fdvv.units import FloatArray


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

    smoothed: bool = False
    startup: int = 5
    jitter: float = 0.0
    ard: bool = False
    plug_in: bool = False
    name: str = field(default="gp-ei", init=False)

    def __post_init__(self) -> None:
        if self.startup < 1:
            raise InputError("engine", "startup", f"is {self.startup}", "give at least one random design")

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        """Suggest, see Engine. ModelError on several objectives."""
        if len(finished(problem, trials)) < self.startup:
            return RandomEngine().suggest(problem, trials, count)
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
    try:
        from sklearn.gaussian_process import GaussianProcessRegressor
        from sklearn.gaussian_process.kernels import ConstantKernel, Matern, WhiteKernel
    except ImportError as error:
        raise missing("gp-ei", "optimize", error) from error
    length = np.full(X.shape[1] if ard else 1, 0.5)
    kernel = ConstantKernel(1.0, (1e-3, 1e3)) * Matern(length, (1e-2, 1e2), nu=2.5)
    kernel += WhiteKernel(0.1, (1e-6, 1e1))
    model = GaussianProcessRegressor(kernel, n_restarts_optimizer=4, random_state=0)
    with warnings.catch_warnings():
        # a length at its bound is a parameter that does not matter, which is no fault
        warnings.simplefilter("ignore")
        model.fit(X, y)
    # what is improved upon is the function, not the next noisy score
    model.kernel_.k2.noise_level = 1e-12
    return model

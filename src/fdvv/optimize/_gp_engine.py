"""A Gaussian process that knows how noisy scores are: the strong engine without torch."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from fdvv.errors import InputError
from fdvv.optimize._acquire import even_net, log_expected_improvement, most_wanted
from fdvv.optimize._avoid import log_success
from fdvv.optimize._belief import best_of, finished, observed
from fdvv.optimize._change_cost import ChangeCost
from fdvv.optimize._engine import Problem
from fdvv.optimize._gp import Basis, Belief, believe
from fdvv.optimize._places import OPEN, generator, tried_places
from fdvv.optimize._plain import sobol_places
from fdvv.optimize._prior import prior_basis
from fdvv.optimize._scalar import scalar_problem
from fdvv.optimize._trial import Trial
from fdvv.units import FloatArray

STARTUP = 5
"""Designs of an even net before the process may learn; the paper's library began with as many."""


@dataclass(frozen=True)
class GPEngine:
    """Expected improvement over the posterior mean's best, by a Gaussian process with known errors.

    Trials under way are taken to come out as expected; near failed ones success is doubted; trials of others
    are a mean function whose weight the person's own scores decide. Several objectives become one by random
    weights that change from trial to trial (ParEGO).

    Parameters
    ----------
    trend : the person learns or tires: scores have a part that runs with the log of the trial's number.
    forget : trials after which an old score's variance counts double; None: all count alike.
    trial_s, build_s : seconds of a trial, and of a new value by parameter (`ChangeCost`); with them
        improvement is sought per second.
    """

    trend: bool = False
    forget: float | None = None
    trial_s: float = 60.0
    build_s: Mapping[str, float] = field(default_factory=dict)
    name: str = field(default="gp", init=False)

    def __post_init__(self) -> None:
        if self.forget is not None and not self.forget > 0:
            raise InputError("engine", "forget", f"is {self.forget}", "give a number of trials above 0")

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        """Suggest, see Engine."""
        tried = tried_places(problem.space, trials)
        case, done = scalar_problem(problem, trials)
        expected = prior_basis(case)
        if not done and expected:
            return problem.space.of_unit(self._expected_best(case, expected, tried, count))
        if len(done) < (1 if expected else STARTUP):
            return problem.space.of_unit(sobol_places(problem, tried, count))
        belief = self._believed(case, done, len(trials))
        for trial in trials:
            if trial.state in OPEN:
                belief = belief.with_fantasy(problem.space.to_unit([trial.design])[0])
        seed = int(generator(problem, trials, 6).integers(2**31))
        chosen = np.empty((0, tried.shape[1]))
        for i in range(count):
            place = self._next(problem, belief, trials, np.vstack([tried, chosen]), seed + i)
            chosen = np.vstack([chosen, place])
            belief = belief.with_fantasy(place)
        return problem.space.of_unit(chosen)

    @staticmethod
    def _expected_best(problem: Problem, expected: Basis, tried: FloatArray, count: int) -> FloatArray:
        """Begin with what others did best, (count, d)."""
        others = problem.space.to_unit([trial.design for trial in finished(problem, problem.prior)])
        about = others[np.argsort(expected.of(others)[:, 0])[:2]]
        net = even_net(problem, problem.seed & 0xFFFFFFFF)
        for i in range(count):
            place = most_wanted(
                problem, lambda at: -expected.of(at)[:, 0], net, tried, problem.seed + i, about
            )
            tried = np.vstack([tried, place])
        return tried[-count:]

    def _next(
        self, problem: Problem, belief: Belief, trials: Sequence[Trial], tried: FloatArray, seed: int
    ) -> FloatArray:
        known, space = belief.observed.places, problem.space
        means = belief.predict(known)[0]
        cost = ChangeCost(self.trial_s, self.build_s) if self.build_s else None

        def worth(places: FloatArray) -> FloatArray:
            gain = log_expected_improvement(*belief.predict(places), float(means.min()))
            gain = gain + log_success(space, trials, places)
            return gain - np.log(cost.seconds(space, places, tried)) if cost else gain

        def reuse(places: FloatArray) -> FloatArray:
            return cost.reusing(space, places, tried, seed) if cost else places

        about = known[np.argsort(means)[:2]]
        return most_wanted(problem, worth, even_net(problem, seed), tried, seed, about, reuse)

    def best(self, problem: Problem, trials: Sequence[Trial]) -> dict[str, float]:
        """Recommend, see Engine."""
        done = best_of(problem, trials)
        belief = self._believed(problem, done, len(trials))
        means, _ = belief.predict(problem.space.to_unit([trial.design for trial in done]))
        return dict(done[int(np.argmin(means))].design)

    def _believed(self, problem: Problem, done: Sequence[Trial], now: int) -> Belief:
        scores = observed(problem.space, problem.objectives[0], done)
        number = np.array([trial.number for trial in done], dtype=np.float64)
        if self.trend:
            scores = replace(scores, trend=np.log1p(number) - np.log1p(now))
        if self.forget is not None:
            scores = replace(scores, faded=2.0 ** ((now - number) / self.forget))
        return believe(scores, prior_basis(problem))

"""The Gaussian-process engine, which knows the errors of scores.

It takes the design of largest expected improvement, divided by the seconds that a trial takes, because a new
force on a rig needs an upload or minutes of compensation; candidates reuse what is built (see CABOP, arXiv
2602.01774).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np

from fdvv.errors import InputError
from fdvv.units import FloatArray
from fdvv_people.optimize.engines.gp_model import (
    Basis,
    Belief,
    believe,
    best_of,
    finished,
    observed,
    prior_basis,
)
from fdvv_people.optimize.engines.multi_objective import scalar_problem
from fdvv_people.optimize.engines.search import (
    SAME,
    even_net,
    generator,
    log_expected_improvement,
    most_wanted,
    sobol_places,
    tried_places,
)
from fdvv_people.optimize.problem import OPEN, Problem, Trial, TrialState
from fdvv_people.optimize.space import DesignSpace

REUSED = 0.5
"""Part of the candidates whose dear parameters are those of a design that was built before."""


@dataclass(frozen=True)
class ChangeCost:
    """Seconds that a trial takes.

    Attributes
    ----------
    trial_s : of the task itself. build_s : by parameter, of a value that no earlier trial had; the dearest of
        those that are new counts. What was built is kept, so coming back to it costs nothing.
    """

    trial_s: float
    build_s: Mapping[str, float]

    def __post_init__(self) -> None:
        for name, seconds in {"trial_s": self.trial_s, **self.build_s}.items():
            if not 0 <= seconds < np.inf or (name == "trial_s" and seconds == 0):
                raise InputError("cost", name, f"is {seconds} s", "give seconds above 0, or 0 to build")

    def dear(self, space: DesignSpace) -> list[int]:
        """List the parameters that cost something to build. InputError on one the space does not have."""
        space.check_names(self.build_s, "cost")
        return [i for i, name in enumerate(space.names) if self.build_s.get(name, 0.0) > 0]

    def seconds(self, space: DesignSpace, places: FloatArray, built: FloatArray) -> FloatArray:
        """Return what trying places (n, d) takes, (n,), after those built, (m, d)."""
        dear = self.dear(space)
        if not dear:
            return np.full(len(places), self.trial_s)
        price = np.array([self.build_s[space.names[i]] for i in dear])
        new = np.abs(places[:, None, dear] - built[None, :, dear]) >= SAME
        # the cheapest of what is there to begin from; with nothing there all is new
        owed = np.where(new, price, 0.0).max(axis=2).min(axis=1, initial=float(price.max()))
        return np.asarray(self.trial_s + owed)

    def reusing(self, space: DesignSpace, places: FloatArray, built: FloatArray, seed: int) -> FloatArray:
        """Return some of places (n, d) the dear values of designs that were built."""
        if not len(built):
            return places
        rng, dear, found = np.random.default_rng([seed, 12]), self.dear(space), places.copy()
        rows = np.flatnonzero(rng.random(len(places)) < REUSED)
        found[rows[:, None], dear] = built[rng.integers(len(built), size=len(rows))[:, None], dear]
        return found


NEAR = 0.1
"""Distance over which one failure lets expect another, parts of a range, root mean square over parameters."""
SURE = 0.95
"""Chance that the very design that failed fails again."""


def log_success(space: DesignSpace, trials: Sequence[Trial], places: FloatArray) -> FloatArray:
    """Return the log of the chance, (n,), that a trial at places (n, d) can be scored.

    Every failure takes away a share that falls with distance, whatever succeeded beside it.
    """
    failed = [trial.design for trial in trials if trial.state is TrialState.FAILED]
    if not failed:
        return np.zeros(len(places))
    squared = ((places[:, None] - space.to_unit(failed)[None]) ** 2).mean(axis=2)
    return np.asarray(np.log1p(-SURE * np.exp(-0.5 * squared / NEAR**2)).sum(axis=1))


@dataclass(frozen=True)
class GPEngine:
    """Expected improvement over the posterior mean's best, by a Gaussian process with known errors.

    Trials under way are taken to come out as expected; near failed ones success is doubted; trials of others
    are a mean function whose weight the person's own scores decide. Several objectives become one by random
    weights that change from trial to trial (ParEGO).

    Parameters
    ----------
    startup : designs of an even net before the process may learn, at least one.
    length : over which scores are expected to change, see `DesignSpace`; None: as the space says.
    trend : the person learns or tires: scores have a part that runs with the log of the trial's number.
    forget : trials after which an old score's variance counts double; None: all count alike.
    trial_s, build_s : seconds of a trial, and of a new value by parameter (`ChangeCost`); with them
        improvement is sought per second.
    """

    trial_size: ClassVar[int] = 1
    startup: int = 3
    length: float | None = None
    trend: bool = False
    forget: float | None = None
    trial_s: float = 60.0
    build_s: Mapping[str, float] = field(default_factory=dict)
    name: str = field(default="gp", init=False)

    def __post_init__(self) -> None:
        if self.forget is not None and not self.forget > 0:
            raise InputError("engine", "forget", f"is {self.forget}", "give a number of trials above 0")
        if self.startup < 1:
            raise InputError("engine", "startup", f"is {self.startup}", "give at least one design")
        if self.length is not None and not 0 < self.length < np.inf:
            raise InputError("engine", "length", f"is {self.length}", "give a length above 0")

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        tried = tried_places(problem.space, trials)
        case, done = scalar_problem(problem, trials)
        expected = prior_basis(case)
        if not done and expected:
            return problem.space.of_unit(self._expected_best(case, expected, tried, count))
        if len(done) < (1 if expected else self.startup):
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
        done = best_of(problem, trials)
        return self._believed(problem, done, len(trials)).best_of(done)

    def _believed(self, problem: Problem, done: Sequence[Trial], now: int) -> Belief:
        scores = observed(problem.space, problem.objectives[0], done)
        number = np.array([trial.number for trial in done], dtype=np.float64)
        if self.trend:
            scores = replace(scores, trend=np.log1p(number) - np.log1p(now))
        if self.forget is not None:
            scores = replace(scores, faded=2.0 ** ((now - number) / self.forget))
        return believe(scores, prior_basis(problem), length=self.length or problem.space.length)

"""Optuna's samplers as engines to compare with: a study is built anew for every suggestion."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.optimize.engines.gp_model import RecommendsBelievedBest, believed_best, finished
from fdvv_people.optimize.engines.search import (
    draw_feasible,
    fresh,
    generator,
    missed_by,
    sobol_places,
    tried_places,
)
from fdvv_people.optimize.problem import OPEN, Problem, Trial, TrialState

if TYPE_CHECKING:
    from optuna.distributions import BaseDistribution
    from optuna.samplers import BaseSampler
    from optuna.study import Study

STARTUP = 10
"""Designs of an even net before a sampler may learn."""
ASKS = 40
"""How often a sampler is asked for a design that holds the constraints before one is drawn instead."""
PRIOR = 30
"""Trials of others that a sampler is given at most; each own one takes the place of one of them."""
BROKEN = "held"


@dataclass(frozen=True)
class TPEEngine(RecommendsBelievedBest):
    """Tree-structured Parzen estimators over all parameters at once.

    Trials under way count as bad ones (the constant liar), so that a batch spreads; failed ones and what
    breaks a constraint are infeasible ones for the sampler.
    """

    name: str = field(default="tpe", init=False)

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        prior = _weighed_prior(problem, trials)
        if len(finished(problem, trials)) + len(prior) < STARTUP:
            return problem.space.of_unit(sobol_places(problem, tried_places(problem.space, trials), count))
        with _quiet():
            import optuna

            seed = int(generator(problem, trials, 2).integers(2**31))
            study = _study(problem, optuna.samplers.TPESampler(seed=seed, n_startup_trials=0))
            for trial in (*prior, *trials):
                _tell(study, problem, trial)
            return _suggested(study, problem, trials, count)


@dataclass(frozen=True)
class CMAESEngine(RecommendsBelievedBest):
    """Covariance matrix adaptation: for budgets of hundreds, as simulated users have them.

    Its state is made by going through the trials again, those that a person edited as injected ones. Of
    trials of others it takes their best as its first.
    """

    name: str = field(default="cmaes", init=False)

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        """Suggest, see Engine. Raises ModelError on several objectives."""
        if len(problem.objectives) != 1:
            raise ModelError("cmaes takes one objective; use nsga2, tpe or gp")
        others = finished(problem, problem.prior)
        if others and not trials and count == 1:
            first = believed_best(problem, others)
            if not problem.space.broken(first):
                return [first]
        with _quiet():
            import optuna

            seed = problem.seed & 0x7FFFFFFF
            independent = optuna.samplers.RandomSampler(seed=seed)
            sampler = optuna.samplers.CmaEsSampler(seed=seed, independent_sampler=independent)
            return _suggested(_replayed(problem, trials, sampler), problem, trials, count)


@dataclass(frozen=True)
class NSGA2Engine(RecommendsBelievedBest):
    """Non-dominated sorting: generations that spread along a front, for budgets of hundreds.

    Parameters
    ----------
    population : of a generation; the trials before that many are drawn at random.
    """

    population: int = 20
    name: str = field(default="nsga2", init=False)

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        with _quiet():
            import optuna

            sampler = optuna.samplers.NSGAIISampler(
                seed=problem.seed & 0x7FFFFFFF, population_size=self.population
            )
            return _suggested(_replayed(problem, trials, sampler), problem, trials, count)


def _replayed(problem: Problem, trials: Sequence[Trial], sampler: BaseSampler) -> Study:
    """Go through the trials with a sampler that keeps a state of its own."""
    import optuna

    study = _study(problem, sampler)
    for trial in trials:
        study.enqueue_trial(_params(problem, trial))
        optuna_trial = study.ask(_ranges(problem))
        if finished(problem, [trial]):
            study.tell(optuna_trial, _values(problem, trial))
        elif trial.state not in OPEN:
            study.tell(optuna_trial, state=optuna.trial.TrialState.FAIL)
    return study


def _weighed_prior(problem: Problem, trials: Sequence[Trial]) -> list[Trial]:
    """Choose trials of others, evenly, fewer the more there are of one's own."""
    done = finished(problem, problem.prior)
    room = min(len(done), max(0, PRIOR - len(finished(problem, trials))))
    return [done[i] for i in np.linspace(0, len(done) - 1, room).astype(int)] if room else []


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep Optuna from logging every study."""
    import optuna

    before = optuna.logging.get_verbosity()
    optuna.logging.set_verbosity(logging.WARNING)
    try:
        yield
    finally:
        optuna.logging.set_verbosity(before)


def _study(problem: Problem, sampler: BaseSampler) -> Study:
    import optuna

    minimize, maximize = optuna.study.StudyDirection.MINIMIZE, optuna.study.StudyDirection.MAXIMIZE
    directions = [maximize if one.larger_is_better else minimize for one in problem.objectives]
    return optuna.create_study(directions=directions, sampler=sampler)


def _ranges(problem: Problem) -> dict[str, BaseDistribution]:
    import optuna

    return {name: optuna.distributions.FloatDistribution(0.0, 1.0) for name in problem.space.names}


def _params(problem: Problem, trial: Trial) -> dict[str, Any]:
    (place,) = problem.space.to_unit([trial.design])
    return dict(zip(problem.space.names, np.clip(place, 0.0, 1.0).tolist(), strict=True))


def _tell(study: Study, problem: Problem, trial: Trial) -> None:
    """Add a trial to a study: done, under way, or failed as one that no constraint allows."""
    import optuna

    params = _params(problem, trial)
    if finished(problem, [trial]):
        _add(study, problem, params, values=_values(problem, trial), constraints={BROKEN: 0.0})
    elif trial.state in OPEN:
        _add(study, problem, params, state=optuna.trial.TrialState.RUNNING)
    elif trial.state is TrialState.FAILED:
        _add_infeasible(study, problem, params, 1.0)


def _add(study: Study, problem: Problem, params: dict[str, Any], **fields: Any) -> None:
    import optuna

    study.add_trial(optuna.trial.create_trial(params=params, distributions=_ranges(problem), **fields))


def _add_infeasible(study: Study, problem: Problem, params: dict[str, Any], missed: float) -> None:
    worst = [1e9 * one.sign for one in problem.objectives]
    # what missed by 0 was tried before: to be avoided as well
    _add(study, problem, params, values=worst, constraints={BROKEN: min(missed, 1e9) or 1.0})


def _values(problem: Problem, trial: Trial) -> list[float]:
    return [trial.scores[one.name].value for one in problem.objectives]


def _suggested(study: Study, problem: Problem, trials: Sequence[Trial], count: int) -> list[dict[str, float]]:
    """Ask until count designs hold the constraints and are new; one at random where asking finds none."""
    tried = tried_places(problem.space, trials)
    rng, d = generator(problem, trials, 3), len(problem.space.names)
    found = np.empty((0, d))
    for _ in range(count):
        designs = (_one(study, problem, np.vstack([tried, found])) for _ in range(ASKS))
        place = next((design for design in designs if design is not None), None)
        if place is None:
            place = draw_feasible(problem, lambda n: rng.random((n, d)), np.vstack([tried, found]), 1)[0]
        found = np.vstack([found, place])
    return problem.space.of_unit(found)


def _one(study: Study, problem: Problem, tried: FloatArray) -> FloatArray | None:
    """Ask for one place; None where it breaks a constraint or was tried, which the study then knows."""
    import optuna

    trial = study.ask(_ranges(problem))
    place = np.array([trial.params[name] for name in problem.space.names])
    missed = float(missed_by(problem.space, place[None])[0])
    if missed <= 0 and len(fresh(place[None], tried)):
        return place
    study.tell(trial, state=optuna.trial.TrialState.FAIL)
    _add_infeasible(study, problem, dict(trial.params), missed)
    return None

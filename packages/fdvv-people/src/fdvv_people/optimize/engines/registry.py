"""The engines by name: those of this package and those of extras."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

from fdvv import extras
from fdvv.errors import BuildError, InputError
from fdvv_people.optimize.engines.gp import GPEngine
from fdvv_people.optimize.engines.gp_model import RecommendsBelievedBest, best_of
from fdvv_people.optimize.engines.preference import PreferenceEngine
from fdvv_people.optimize.engines.preference_line import PreferenceLineEngine
from fdvv_people.optimize.engines.search import random_places, sobol_places, tried_places
from fdvv_people.optimize.problem import PREFERENCE, Engine, Problem, Trial


@dataclass(frozen=True)
class RandomEngine(RecommendsBelievedBest):
    """Draw designs at random, uniformly."""

    name: str = field(default="random", init=False)

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        return problem.space.of_unit(random_places(problem, trials, count))


@dataclass(frozen=True)
class SobolEngine(RecommendsBelievedBest):
    """Take the points of a scrambled Sobol sequence in turn, those that hold the constraints."""

    name: str = field(default="sobol", init=False)

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        places = sobol_places(problem, tried_places(problem.space, trials), count)
        return problem.space.of_unit(places)


@dataclass(frozen=True)
class RetiredEngine(RecommendsBelievedBest):
    """An engine of an earlier fdvv: its runs are read and reported, and cannot be continued."""

    name: str
    options: Mapping[str, Any]

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        """Raise InputError."""
        reason = "suggests no more designs: it is a baseline of the benchmarks now"
        raise InputError("engine", self.name, reason, "report what there is, or begin another run with gp")

    def best(self, problem: Problem, trials: Sequence[Trial]) -> dict[str, float]:
        """Recommend a design as the engine did: gp-ei that of the best score, luck or not."""
        if self.name != "gp-ei" or self.options.get("smoothed"):
            return super().best(problem, trials)
        (objective,), done = problem.objectives, best_of(problem, trials)
        return dict(min(done, key=lambda one: objective.sign * one.scores[objective.name].value).design)


RETIRED = ("tpe", "cmaes", "nsga2", "gp-ei")
ENGINES: Mapping[str, Callable[..., Engine]] = MappingProxyType(
    {
        "random": RandomEngine,
        "sobol": SobolEngine,
        "gp": GPEngine,
        "preference-line": PreferenceLineEngine,
        "preference": PreferenceEngine,
    }
)
"""Engines of this package, by name; called with their options."""


def reads_choices(name: str) -> bool:
    """Whether an engine learns from which design is liked best, not from scores."""
    return name.startswith(PREFERENCE)


def engine_names(choices: bool = False) -> tuple[str, ...]:
    """Return the names of the engines that read scores, or choices, those of extras last."""
    return tuple(name for name in (*ENGINES, *extras.names("engines")) if reads_choices(name) is choices)


def check_engine(name: str, task: str) -> None:
    """Raise InputError where a new run cannot have this engine: one of RETIRED, or of another task."""
    choices = task == PREFERENCE
    remedy = f"use one of {', '.join(engine_names(choices))}"
    if name in RETIRED:
        raise InputError("engine", name, "is a baseline of the benchmarks now, no engine of fdvv", remedy)
    if choices and name in engine_names():
        raise InputError("engine", name, "reads scores, but designs are compared", remedy)
    if not choices and name in engine_names(choices=True):
        reason = f"reads what somebody likes better, but {task} is scored"
        raise InputError("engine", name, reason, f"play {PREFERENCE}, or leave the engine out")


def engine_of(name: str, options: Mapping[str, Any] | None = None) -> Engine:
    """Make an engine; of RETIRED one that suggests nothing.

    Raises InputError on a name or an option that is not known, and on an engine whose name does not say what
    it reads; BuildError if its extra is not installed.
    """
    if name in RETIRED:
        return RetiredEngine(name, options or {})
    known = (*engine_names(), *engine_names(choices=True))
    if name not in known:
        raise InputError("engine", name, "no engine has this name", f"use one of {', '.join(known)}")
    make = ENGINES.get(name) or extras.load("engines", name)
    try:
        engine: Engine = make(**(options or {}))
    except TypeError as error:
        reason = f"an option does not fit ({error})"
        raise InputError("engine", name, reason, "see the options in the docs") from error
    if (engine.trial_size > 1) is not reads_choices(name):
        reason = f"tries {engine.trial_size} designs at once"
        remedy = f"let the name begin with {PREFERENCE!r} where there are several, and only there"
        raise InputError("engine", name, reason, remedy)
    return engine


def default_trial_size(name: str) -> int:
    """Return how many designs an engine tries at once by default; of an absent extra at least so many."""
    try:
        return engine_of(name).trial_size
    except BuildError:
        return 2 if reads_choices(name) else 1


def pair_engine_names() -> tuple[str, ...]:
    """Return the names of the engines that compare two designs, those of extras last."""
    return tuple(name for name in engine_names(choices=True) if default_trial_size(name) == 2)

"""The engines by name: those of this package and those of extras."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

from fdvv import extras
from fdvv.errors import InputError
from fdvv.optimize.engines.gp import GPEngine
from fdvv.optimize.engines.gp_model import RecommendsBelievedBest, best_of
from fdvv.optimize.engines.preference import PreferenceEngine
from fdvv.optimize.engines.preference_line import PreferenceLineEngine
from fdvv.optimize.engines.search import random_places, sobol_places, tried_places
from fdvv.optimize.problem import Engine, LineEngine, PairEngine, Problem, Trial


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
    }
)
"""Engines of this package that read scores, by name; called with their options."""
PAIR_ENGINES: Mapping[str, Callable[..., PairEngine]] = MappingProxyType({"preference": PreferenceEngine})
"""Engines of this package that read comparisons, by name."""
LINE_ENGINES: Mapping[str, Callable[..., LineEngine]] = MappingProxyType(
    {"preference-line": PreferenceLineEngine}
)
"""Engines that read which stop of a line is liked best, by name."""


def engine_names() -> tuple[str, ...]:
    """Return the names of the engines that read scores, those of extras last."""
    return (*ENGINES, *extras.names("engines"))


def pair_engine_names() -> tuple[str, ...]:
    """Return the names of the engines that read comparisons, those of extras last."""
    return (*PAIR_ENGINES, *extras.names("pair_engines"))


def check_engine(name: str) -> None:
    """Raise InputError where a new run cannot have this engine."""
    if name in RETIRED:
        reason = "is a baseline of the benchmarks now, no engine of fdvv"
        raise InputError("engine", name, reason, f"use one of {', '.join(engine_names())}")


def engine_of(name: str, options: Mapping[str, Any] | None = None) -> Engine:
    """Make an engine; of RETIRED one that suggests nothing.

    Raises InputError on a name or an option that is not known, BuildError if its extra is not installed.
    """
    if name in RETIRED:
        return RetiredEngine(name, options or {})
    engine: Engine = _made(ENGINES, "engines", name, options)
    return engine


def pair_engine_of(name: str, options: Mapping[str, Any] | None = None) -> PairEngine:
    """Make an engine of comparisons. Raises like ``engine_of``."""
    engine: PairEngine = _made(PAIR_ENGINES, "pair_engines", name, options)
    return engine


def line_engine_of(name: str, options: Mapping[str, Any] | None = None) -> LineEngine:
    """Make an engine of lines. Raises like ``engine_of``."""
    engine: LineEngine = _made(LINE_ENGINES, None, name, options)
    return engine


def _made(
    own: Mapping[str, Callable[..., Any]],
    kind: extras.Kind | None,
    name: str,
    options: Mapping[str, Any] | None,
) -> Any:
    known = (*own, *(extras.names(kind) if kind else ()))
    if name not in known:
        raise InputError("engine", name, "no engine has this name", f"use one of {', '.join(known)}")
    make = own[name] if name in own or kind is None else extras.load(kind, name)
    try:
        return make(**(options or {}))
    except TypeError as error:
        reason = f"an option does not fit ({error})"
        raise InputError("engine", name, reason, "see the options in the docs") from error

"""Engines that others are compared with, by name; those of the package beside them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from benchmarks.optimize_expected_improvement import GPExpectedImprovement
from benchmarks.optimize_optuna import CMAESEngine, NSGA2Engine, TPEEngine
from fdvv_people.optimize.engines.registry import engine_of
from fdvv_people.optimize.problem import Engine

BASELINES: Mapping[str, Callable[..., Engine]] = {
    "tpe": TPEEngine,
    "cmaes": CMAESEngine,
    "nsga2": NSGA2Engine,
    "gp-ei": GPExpectedImprovement,
}


def compared_engine(name: str, options: Mapping[str, Any] | None = None) -> Engine:
    """Make a baseline, or an engine of the package, see `engine_of`."""
    return BASELINES[name](**(options or {})) if name in BASELINES else engine_of(name, options)

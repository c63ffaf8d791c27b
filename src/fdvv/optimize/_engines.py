"""The engines there are, by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

from fdvv.errors import InputError
from fdvv.optimize._botorch import BoTorchEngine
from fdvv.optimize._engine import Engine, PairEngine
from fdvv.optimize._gp_ei import GPExpectedImprovement
from fdvv.optimize._gp_engine import GPEngine
from fdvv.optimize._optuna import CMAESEngine, NSGA2Engine, TPEEngine
from fdvv.optimize._plain import RandomEngine, SobolEngine
from fdvv.optimize._preference import PreferenceEngine
from fdvv.optimize._preference_botorch import PreferenceBoTorchEngine

ENGINES: Mapping[str, Callable[..., Engine]] = MappingProxyType(
    {
        "random": RandomEngine,
        "sobol": SobolEngine,
        "tpe": TPEEngine,
        "cmaes": CMAESEngine,
        "nsga2": NSGA2Engine,
        "gp-ei": GPExpectedImprovement,
        "gp": GPEngine,
        "botorch": BoTorchEngine,
    }
)
"""Engines that read scores, by name; called with their options."""

PAIR_ENGINES: Mapping[str, Callable[..., PairEngine]] = MappingProxyType(
    {"preference": PreferenceEngine, "preference-botorch": PreferenceBoTorchEngine}
)
"""Engines that read comparisons, by name."""


def engine_of(name: str, options: Mapping[str, Any] | None = None) -> Engine:
    """Make an engine. InputError on a name or an option that it does not know."""
    engine: Engine = _made(ENGINES, name, options)
    return engine


def pair_engine_of(name: str, options: Mapping[str, Any] | None = None) -> PairEngine:
    """Make an engine of comparisons. InputError on a name or an option that it does not know."""
    engine: PairEngine = _made(PAIR_ENGINES, name, options)
    return engine


def _made(known: Mapping[str, Callable[..., Any]], name: str, options: Mapping[str, Any] | None) -> Any:
    if name not in known:
        raise InputError("engine", name, "no engine has this name", f"use one of {', '.join(known)}")
    try:
        return known[name](**(options or {}))
    except TypeError as error:
        reason = f"an option does not fit ({error})"
        raise InputError("engine", name, reason, "see the options in the docs") from error

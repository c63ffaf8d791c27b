"""What suggests designs: ask and tell, with all state in the trials."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Protocol

from fdvv.errors import ModelError
from fdvv.optimize._space import DesignSpace
from fdvv.optimize._trial import Comparison, Trial


@dataclass(frozen=True)
class Objective:
    """One quantity to be made small (or large).

    Attributes
    ----------
    name : with its unit, as ``asynchrony_ms``. larger_is_better : the direction.
    """

    name: str
    larger_is_better: bool = False


@dataclass(frozen=True)
class Problem:
    """What is optimised.

    Attributes
    ----------
    space : designs there are. objectives : at least one; several make a front of compromises.
    seed : of everything random in an engine.
    prior : finished trials of others (simulated users, earlier people) to begin from; empty: from nothing.
    """

    space: DesignSpace
    objectives: tuple[Objective, ...]
    seed: int = 0
    prior: tuple[Trial, ...] = field(default=())

    def __post_init__(self) -> None:
        names = [one.name for one in self.objectives]
        if not names or len(set(names)) != len(names):
            raise ModelError(f"a problem needs objectives of different names, got {names}")


class Engine(Protocol):
    """Suggests designs to try. It keeps nothing: the same problem and trials give the same suggestion.

    That makes a run that was killed ask the same next design when it goes on, and lets a seed replay.
    """

    @property
    def name(self) -> str:
        """Get its name, as `--engine` knows it."""
        ...

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        """Suggest count designs that hold the constraints, given all trials so far (every state).

        Trials that are suggested or shown are under way; failed ones tell that their neighbourhood may fail;
        abandoned ones tell nothing. InputError if no design of the space holds the constraints.
        """
        ...

    def best(self, problem: Problem, trials: Sequence[Trial]) -> dict[str, float]:
        """Recommend a design of those done: by what the engine believes, not by the luckiest score.

        Only with one objective; ModelError if nothing is done yet.
        """
        ...


class PairEngine(Protocol):
    """Suggests two designs to be compared; keeps nothing, as Engine."""

    @property
    def name(self) -> str:
        """Get its name, as `--engine` knows it."""
        ...

    def pair(
        self, problem: Problem, comparisons: Sequence[Comparison]
    ) -> tuple[dict[str, float], dict[str, float]]:
        """Suggest the next two designs."""
        ...

    def best(self, problem: Problem, comparisons: Sequence[Comparison]) -> dict[str, float]:
        """Recommend a design; ModelError if nothing was answered yet."""
        ...

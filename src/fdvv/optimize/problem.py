"""What suggests designs: ask and tell, with all state in the trials."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Protocol

from msgspec import Struct

from fdvv.errors import ModelError
from fdvv.optimize.space import DesignSpace


class TrialState(StrEnum):
    """How far a trial is.

    suggested : written down, not yet shown to anybody. shown : somebody tries it. done : scored.
    failed : it could not be tried or scored, and the reason is known. abandoned : somebody stopped it; its
    presses do not count.
    """

    SUGGESTED = "suggested"
    SHOWN = "shown"
    DONE = "done"
    FAILED = "failed"
    ABANDONED = "abandoned"


OPEN = (TrialState.SUGGESTED, TrialState.SHOWN)
"""States of a trial that is under way."""


@dataclass(frozen=True)
class Score:
    """The value of one objective.

    Attributes
    ----------
    value : in the objective's unit. error : standard error of it, None if unknown.
    """

    value: float
    error: float | None = None

    def __post_init__(self) -> None:
        if not math.isfinite(self.value) or not (self.error is None or 0 <= self.error < math.inf):
            raise ModelError(f"a score needs a finite value and an error of at least 0, got {self}")


@dataclass(frozen=True)
class Trial:
    """One design and what became of it.

    Attributes
    ----------
    number : from 0, in the order of suggestion.
    design : what is tried. suggested : what the engine had suggested, if a person edited it.
    state : how far it is. scores : by objective, when done. reason : of a failure.
    origin : who suggested it: an engine's name, "start" (the person's own button) or "person".
    """

    number: int
    design: dict[str, float]
    state: TrialState = TrialState.SUGGESTED
    scores: dict[str, Score] = field(default_factory=dict)
    suggested: dict[str, float] | None = None
    reason: str = ""
    origin: str = ""


class Answer(StrEnum):
    """What a person says of two designs."""

    FIRST = "first"
    SECOND = "second"
    EQUAL = "equal"


@dataclass(frozen=True)
class Comparison:
    """Two designs and which of them somebody preferred; answer None: not yet answered."""

    number: int
    first: dict[str, float]
    second: dict[str, float]
    answer: Answer | None = None


class Objective(Struct, frozen=True, forbid_unknown_fields=True):
    """One quantity to be made small (or large).

    Attributes
    ----------
    name : with its unit, as ``asynchrony_ms``. larger_is_better : the direction.
    """

    name: str
    larger_is_better: bool = False

    @property
    def sign(self) -> float:
        """What makes smaller better: -1 where larger is."""
        return -1.0 if self.larger_is_better else 1.0


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

    So a continued run suggests the same next design, and a seed can be replayed.
    """

    @property
    def name(self) -> str:
        """Its name, as `--engine` knows it."""

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        """Suggest count designs that hold the constraints, given all trials so far (every state).

        Trials that are suggested or shown are under way; failed ones tell that their neighbourhood may fail;
        abandoned ones tell nothing. InputError if no design of the space holds the constraints.
        """

    def best(self, problem: Problem, trials: Sequence[Trial]) -> dict[str, float]:
        """Recommend a design of those done: by what the engine believes, not by the luckiest score.

        Only with one objective; ModelError if nothing is done yet.
        """


class PairEngine(Protocol):
    """Suggests two designs to be compared; keeps nothing, as Engine."""

    @property
    def name(self) -> str:
        """Its name, as `--engine` knows it."""

    def pair(
        self, problem: Problem, comparisons: Sequence[Comparison]
    ) -> tuple[dict[str, float], dict[str, float]]:
        """Suggest the next two designs."""

    def best(self, problem: Problem, comparisons: Sequence[Comparison]) -> dict[str, float]:
        """Recommend a design; ModelError if nothing was answered yet."""

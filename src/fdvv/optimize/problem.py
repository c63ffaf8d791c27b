"""What suggests designs: ask and tell, with all state in the trials."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Protocol

import msgspec

from fdvv.errors import ModelError
from fdvv.optimize.space import DesignSpace
from fdvv.task.score import Objective, Score


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
class Trial:
    """One design and what became of it.

    Attributes
    ----------
    number : from 0, in the order of suggestion.
    design : what is tried. suggested : what the engine had suggested, if a person edited it.
    state : how far it is. scores : by objective, when done. reason : of a failure.
    origin : who suggested it: an engine's name, "start" (the person's own button) or "retest".
    components : of a design that several people scored: what a person of one standard deviation along each
        principal component of the people adds to the score; UNSET: nothing is known of how they differ.
    rival : at the end of a run what is played in the place of a design of the run, by its name; else UNSET,
        so that records of all other trials are as they were before there were rivals.
    """

    number: int
    design: dict[str, float]
    state: TrialState = TrialState.SUGGESTED
    scores: dict[str, Score] = field(default_factory=dict)
    suggested: dict[str, float] | None = None
    reason: str = ""
    origin: str = ""
    components: tuple[float, ...] | msgspec.UnsetType = msgspec.UNSET
    rival: str | msgspec.UnsetType = msgspec.UNSET


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


@dataclass(frozen=True)
class Line:
    """Designs along a straight line through the space, and the one of them that somebody liked best.

    Attributes
    ----------
    number : from 0, in the order of suggestion. stops : at least two designs, in the order of the line.
    best : which of the stops is liked best, from 0; None: not yet answered.
    """

    number: int
    stops: tuple[dict[str, float], ...]
    best: int | None = None

    @property
    def middle(self) -> dict[str, float]:
        """The stop in the middle; of a run's first line, what its result is compared with."""
        return self.stops[len(self.stops) // 2]


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

        Trials that are suggested or shown are under way; failed ones say that their neighbourhood may fail;
        abandoned ones say nothing. InputError if no design of the space holds the constraints.
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


class LineEngine(Protocol):
    """Suggests a line along which the best design is felt out; keeps nothing, as Engine."""

    @property
    def name(self) -> str:
        """Its name, as a setup knows it."""

    def line(self, problem: Problem, lines: Sequence[Line]) -> tuple[dict[str, float], ...]:
        """Suggest the stops of the next line; all of them hold the constraints."""

    def best(self, problem: Problem, lines: Sequence[Line]) -> dict[str, float]:
        """Recommend a design; ModelError if nothing was answered yet."""

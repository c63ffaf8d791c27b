"""What people are asked, and what suggests it: ask and answer, with all state in the trials."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Protocol

import msgspec

from fdvv.errors import ModelError
from fdvv_people.optimize.space import DesignSpace
from fdvv_people.task.score import Objective, Score


class TrialState(StrEnum):
    """How far a trial is.

    suggested : written down, not yet shown to anybody. shown : somebody tries it. done : answered.
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


PREFERENCE = "preference"
"""The task in which the best of some designs is chosen; the names of engines for it begin with it."""


class Answer(StrEnum):
    """What a person says of two designs, in the words of messages."""

    FIRST = "first"
    SECOND = "second"
    EQUAL = "equal"

    @property
    def best(self) -> tuple[int, ...]:
        """Which of the two are liked best, from 0."""
        return {"first": (0,), "second": (1,), "equal": (0, 1)}[self]


@dataclass(frozen=True)
class Trial:
    """One design to be scored, or several of which the best is chosen, and what became of it.

    Attributes
    ----------
    number : from 0, in the order of suggestion.
    design : what is tried. beside : the others that are tried with it, of a choice; two designs are compared,
        more are felt along a line in their order. best : which of all these, from 0, is liked best; several
        where somebody finds no difference. suggested : what the engine had suggested, if a person edited it.
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
    beside: tuple[dict[str, float], ...] | msgspec.UnsetType = msgspec.UNSET
    best: tuple[int, ...] | msgspec.UnsetType = msgspec.UNSET

    @property
    def designs(self) -> tuple[dict[str, float], ...]:
        """All designs that are tried."""
        return (self.design, *(self.beside or ()))

    @property
    def is_open(self) -> bool:
        """Whether it is under way."""
        return self.state in OPEN

    @property
    def answer(self) -> Answer | None:
        """What is said of two designs; None before it is said."""
        return next((one for one in Answer if one.best == self.best), None)


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
        """Its name, as `--engine` knows it; it begins with PREFERENCE where the best of designs is chosen."""

    @property
    def trial_size(self) -> int:
        """How many designs a trial has at most: 1 is scored, 2 are compared, more are felt along a line."""

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        """Suggest designs that hold the constraints, given all trials so far (every state).

        Return those of the next count trials where designs are scored, else all those of the next trial.
        Trials that are suggested or shown are under way; failed ones say that their neighbourhood may fail;
        abandoned ones say nothing. InputError if no design of the space holds the constraints.
        """

    def best(self, problem: Problem, trials: Sequence[Trial]) -> dict[str, float]:
        """Recommend a design of those done: by what the engine believes, not by the luckiest score.

        Only with one objective; ModelError if nothing is done yet.
        """

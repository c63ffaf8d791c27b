"""What was tried and how it came out: records that engines read and ledgers keep."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import StrEnum

from fdvv.errors import ModelError


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

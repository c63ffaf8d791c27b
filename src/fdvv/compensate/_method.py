"""The shape that every method of compensation has, per curve or model-based."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, TypeVar

from fdvv.compensate._tuning import UNTUNED, Tuning
from fdvv.model import ForceSurface, Press, Stroke

S = TypeVar("S")


@dataclass(frozen=True, eq=False)
class Job:
    """What is wanted of a rig.

    Attributes
    ----------
    target : force wanted; its rows are the velocities, its grid the bins of the command tables.
    travel_mm : where the stop is set.
    force_limit_cN : largest command of either sign.
    """

    target: ForceSurface
    travel_mm: float
    force_limit_cN: float


@dataclass(frozen=True, eq=False)
class Trial:
    """What to do next: upload surface under this tuning, have it pressed once at velocity_mm_s.

    pace_ratio : how far off the asked speed the press may be, as a part of it; None: as the session has it.
    """

    surface: ForceSurface
    velocity_mm_s: float
    tuning: Tuning = UNTUNED
    pace_ratio: float | None = None


@dataclass(frozen=True)
class CurveOutcome:
    """How one curve went, as the rig measured it while it learned (not what the finger felt).

    Attributes
    ----------
    error_cN : error_k of every press used, in order.
    mean_error_cN, max_error_cN : of |target - felt| over the bins, for the table kept.
    sentence : how it went.
    """

    stroke: Stroke
    velocity_mm_s: float
    error_cN: tuple[float, ...]
    mean_error_cN: float
    max_error_cN: float
    sentence: str


@dataclass(frozen=True, eq=False)
class Outcome:
    """What a method learned.

    Attributes
    ----------
    surface : the actuation, one row per velocity of the job.
    tuning : what the controller adds while it renders the surface.
    curves : one per stroke and velocity.
    presses : learned from.
    complete : the method did all it meant to; if not, the sentence says what stopped it.
    """

    surface: ForceSurface
    curves: tuple[CurveOutcome, ...]
    presses: int
    complete: bool
    sentence: str
    tuning: Tuning = UNTUNED


@dataclass(frozen=True)
class Count:
    """How far a job is: presses learned from and presses it takes in all.

    wanted : presses it takes per velocity, in the order of the target's rows; empty if that is not known.
    """

    made: int
    total: int
    wanted: tuple[int, ...] = ()


class Method(Protocol[S]):
    """Settings of a way to learn actuation: init, then trial, press and step until trial gives None."""

    @property
    def name(self) -> str:
        """Name the method and what it adds to it, for the record."""
        ...

    @property
    def bin_mm(self) -> float:
        """Give the step of the tables it learns."""
        ...

    def init(self, job: Job) -> S:
        """Begin."""
        ...

    def trial(self, state: S) -> Trial | None:
        """Tell what to press next; None when finished."""
        ...

    def step(self, press: Press, state: S) -> S:
        """Learn from the press that the last trial asked for, which ``judge`` accepted.

        Raises ModelError, whose text is the reason, if it teaches nothing all the same; it is made again.
        """
        ...

    def count(self, state: S) -> Count:
        """Tell how far the job is."""
        ...

    def explain(self, state: S) -> str:
        """Tell in a few words what the last press changed, for whoever presses; empty if there is nothing."""
        ...

    def done(self, state: S) -> Outcome:
        """Give what was learned so far; works at any time."""
        ...

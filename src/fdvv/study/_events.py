"""What happens in a person's session, event by event.

Events are what the session's journal holds: plain, answers by label only. Whoever has them, and the plan,
knows where the person stands; nobody learns from them what a label hid.
"""

from __future__ import annotations

from typing import Any, Literal

import msgspec
from msgspec import Struct

from fdvv.errors import ModelError
from fdvv.study._plan import StudyPlan
from fdvv.study._trial import StudyTrial, TrialAnswer

Value = str | float | None
"""Of a question: the text of a choice in the study's first language, a number, free text, or nothing."""


class TrialFace(Struct, frozen=True, forbid_unknown_fields=True):
    """All of a trial that may be seen.

    Attributes
    ----------
    number, item, round, practice : see StudyTrial. labels : between which a person switches, "X" first.
    """

    number: int
    item: str
    round: int
    labels: tuple[str, ...]
    practice: bool = False


class Began(Struct, frozen=True, forbid_unknown_fields=True):
    """The first event. simulated : the answers will be those of a simulated participant."""

    at_s: float
    person: str
    language: str
    trials: tuple[TrialFace, ...]
    simulated: bool = False


class PageAnswered(Struct, frozen=True, forbid_unknown_fields=True):
    """A page was read and its questions were answered. agreed : False on a consent page ends it all."""

    at_s: float
    name: str
    values: dict[str, Value] = {}
    agreed: bool = True


class Shown(Struct, frozen=True, forbid_unknown_fields=True):
    """A trial is before the person.

    attempt : 1, and one more each time it had to be shown again. simulated : on a simulated rig.
    """

    at_s: float
    number: int
    attempt: int
    simulated: bool = False


class Answered(Struct, frozen=True, forbid_unknown_fields=True):
    """A trial was answered, in that attempt; it is never shown again."""

    at_s: float
    number: int
    attempt: int
    answer: TrialAnswer


class Interrupted(Struct, frozen=True, forbid_unknown_fields=True):
    """The device went away in a trial, which is shown again. Why is secret: it could tell what was felt.

    felt : a label had been felt by then.
    """

    at_s: float
    number: int
    felt: bool = False


class Skipped(Struct, frozen=True, forbid_unknown_fields=True):
    """The device went away in a trial again and again: it is given up, and missing in the analysis."""

    at_s: float
    number: int


class Settled(Struct, frozen=True, forbid_unknown_fields=True):
    """The staircase of an item in a round came to its end: its other trials are not met."""

    at_s: float
    item: str
    round: int


class BreakEnded(Struct, frozen=True, forbid_unknown_fields=True):
    """The person went on after a break."""

    at_s: float


class Left(Struct, frozen=True, forbid_unknown_fields=True):
    """The session was closed in order; until it is resumed nobody works."""

    at_s: float


class Resumed(Struct, frozen=True, forbid_unknown_fields=True):
    """The session was opened again, with the person's code or by the keeper."""

    at_s: float
    by: Literal["code", "keeper"]


class Withdrawn(Struct, frozen=True, forbid_unknown_fields=True):
    """The person does not want to go on."""

    at_s: float


Event = (
    Began
    | PageAnswered
    | Shown
    | Answered
    | Interrupted
    | Skipped
    | Settled
    | BreakEnded
    | Left
    | Resumed
    | Withdrawn
)
"""What can happen in a session, as its journal keeps it."""
EVENTS: dict[str, type[Event]] = {
    "began": Began,
    "page": PageAnswered,
    "shown": Shown,
    "answered": Answered,
    "interrupted": Interrupted,
    "skipped": Skipped,
    "settled": Settled,
    "break_ended": BreakEnded,
    "left": Left,
    "resumed": Resumed,
    "withdrawn": Withdrawn,
}
"""Events by the key of their record."""
WORD = {kind: word for word, kind in EVENTS.items()}


def record_of(event: Event) -> dict[str, Any]:
    """Give the journal's record of an event: an object with one key."""
    return {WORD[type(event)]: msgspec.to_builtins(event)}


def event_of(record: dict[str, Any]) -> Event:
    """Read a journal's record. ModelError where it is none."""
    ((word, body),) = record.items()
    try:
        return msgspec.convert(body, EVENTS[word])
    except (KeyError, msgspec.ValidationError) as error:
        raise ModelError(f"no event of a session: {error}") from error


def face_of(plan: StudyPlan, trial: StudyTrial) -> TrialFace:
    """Give what may be seen of a trial."""
    labels = set(trial.labels) | ({"X"} if _names_x(plan, trial.item) else set())
    ordered = tuple(sorted(labels, key=lambda label: (label != "X", label)))
    return TrialFace(trial.number, trial.item, trial.round, ordered, trial.practice)


def _names_x(plan: StudyPlan, item: str) -> bool:
    """Tell whether a named reference is rendered: one that is given, or mushra's first stimulus."""
    return plan.kind == "mushra" or any(one.name == item and one.reference for one in plan.items)

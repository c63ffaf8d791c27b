"""What happens in a person's session, event by event.

Events are what the session's log holds: plain, answers by label only. With the plan they determine the state
of the session; they do not reveal what a label hid.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, Literal

import msgspec
from msgspec import Struct

from fdvv.errors import InputError
from fdvv_people.study.plan.plan import Page, Question, Rating, StudyPlan
from fdvv_people.study.plan.plan_words import offers_equal
from fdvv_people.study.plan.tasks import task_of
from fdvv_people.study.plan.trial import EQUAL, StudyTrial, TrialAnswer

Value = str | float | None
"""Of a question: the text of a choice in the study's first language, a number, free text, or nothing."""

LONGEST_TEXT = 2000  # assumed: a page; an answer without a limit could fill the session's log
CHOOSE = "answer it again"


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


class SessionEvent(Struct, frozen=True, forbid_unknown_fields=True):
    """What all events have. word : key of its record in the log. at_s : wall time."""

    word: ClassVar[str]
    at_s: float


class SessionStarted(SessionEvent, frozen=True):
    """The session started, with its trials. simulated : the participant is simulated."""

    word: ClassVar[str] = "began"
    person: str
    language: str
    trials: tuple[TrialFace, ...]
    simulated: bool = False


class PageAnswered(SessionEvent, frozen=True):
    """A page was read and its questions were answered. agreed : False on a consent page ends it all."""

    word: ClassVar[str] = "page"
    name: str
    values: dict[str, Value] = {}
    agreed: bool = True


class TrialShown(SessionEvent, frozen=True):
    """A trial was shown.

    attempt : 1, and one more each time it had to be shown again. simulated : on a simulated rig.
    """

    word: ClassVar[str] = "shown"
    number: int
    attempt: int
    simulated: bool = False


class TrialAnswered(SessionEvent, frozen=True):
    """A trial was answered, in that attempt; it is never shown again."""

    word: ClassVar[str] = "answered"
    number: int
    attempt: int
    answer: TrialAnswer


class TrialInterrupted(SessionEvent, frozen=True):
    """The device went away in a trial, which is taken up again. Why could reveal a label, and is sealed.

    felt : a label had been felt by then.
    """

    word: ClassVar[str] = "interrupted"
    number: int
    felt: bool = False


class TrialSkipped(SessionEvent, frozen=True):
    """A trial is given up, and missing in the analysis. Why could reveal a label, and is sealed."""

    word: ClassVar[str] = "skipped"
    number: int


class StaircaseConverged(SessionEvent, frozen=True):
    """The staircase of an item in a round ended: its other trials are passed over."""

    word: ClassVar[str] = "settled"
    item: str
    round: int


class BreakEnded(SessionEvent, frozen=True):
    """The person ended a break."""

    word: ClassVar[str] = "break_ended"


class SessionClosed(SessionEvent, frozen=True):
    """The session was closed in order; time until it is resumed is not work."""

    word: ClassVar[str] = "left"


class SessionResumed(SessionEvent, frozen=True):
    """The session was opened again, with the person's code or by the key holder."""

    word: ClassVar[str] = "resumed"
    by: Literal["code", "keeper"]


class ParticipantWithdrew(SessionEvent, frozen=True):
    """The person left the study for good."""

    word: ClassVar[str] = "withdrawn"


def record_of(event: SessionEvent) -> dict[str, Any]:
    return {event.word: msgspec.to_builtins(event)}


def face_of(plan: StudyPlan, trial: StudyTrial) -> TrialFace:
    labels, task = set(trial.labels), task_of(plan.kind)
    if any(one.name == trial.item and task.shown_reference(one) for one in plan.items):
        labels.add("X")
    ordered = tuple(sorted(labels, key=lambda label: (label != "X", label)))
    return TrialFace(trial.number, trial.item, trial.round, ordered, trial.practice)


def choices_of(plan: StudyPlan) -> tuple[str, ...]:
    """Return the answers that a trial offers; none where only ratings are asked."""
    first, *others = task_of(plan.kind).choices or ("",)
    return (*filter(None, (first, EQUAL if offers_equal(plan) else "")), *others)


def rated_labels(trial: TrialFace) -> tuple[str, ...]:
    """Return the labels that are rated: all that hide something."""
    return tuple(label for label in trial.labels if label != "X")


def check_answer(plan: StudyPlan, trial: TrialFace, answer: TrialAnswer) -> None:
    """See that an answer is one that the trial asks for. InputError."""
    place = f"trial {trial.number}"
    choices = choices_of(plan)
    if answer.choice not in (choices or ("",)):
        offered = ", ".join(choices) or "ratings only"
        raise InputError("answer", place, f"{answer.choice!r:.40} is not offered ({offered})", CHOOSE)
    if set(answer.ratings) != {rating.name for rating in plan.ratings}:
        raise InputError("answer", place, "not every scale was rated, or one that is not asked", CHOOSE)
    for rating in plan.ratings:
        _check_rating(rating, answer.ratings[rating.name], rated_labels(trial), place)
    felt = {label for _, label in answer.switches} | set(answer.presses)
    if not felt <= set(trial.labels):
        raise InputError("answer", place, "tells of a label that the trial does not have", CHOOSE)


def _check_rating(rating: Rating, given: Mapping[str, float], labels: tuple[str, ...], place: str) -> None:
    low, high = rating.ends
    if set(given) != set(labels):
        raise InputError("answer", place, f"{rating.name} is not rated for {', '.join(labels)}", CHOOSE)
    for label, points in given.items():
        if not (low <= points <= high and points == round(points)):
            reason = f"{rating.name} of {label} is {points:g}, not a whole number from {low} to {high}"
            raise InputError("answer", place, reason, CHOOSE)


def checked_page(languages: Sequence[str], page: Page, values: Mapping[str, Value]) -> dict[str, Value]:
    """Return a page's answers as they are kept; a choice in the first of the languages. InputError."""
    questions = {question.name: question for question in page.questions}
    for name in set(values) - set(questions):
        raise InputError("answer", f"page {page.name}", f"does not ask {name!r:.60}", CHOOSE)
    return {name: _checked_value(languages, page, one, values.get(name)) for name, one in questions.items()}


def _checked_value(languages: Sequence[str], page: Page, question: Question, value: Value) -> Value:
    place = f"page {page.name}, {question.name}"
    if value is None or value == "":
        if question.required:
            raise InputError("answer", place, "is not answered", CHOOSE)
        return None
    if question.choices:
        return _choice(languages, question, value, place)
    if question.low is not None or question.high is not None:
        return _number(question, value, place)
    if not isinstance(value, str) or len(value) > LONGEST_TEXT:
        raise InputError("answer", place, f"is not a text of at most {LONGEST_TEXT} letters", CHOOSE)
    return value


def _choice(languages: Sequence[str], question: Question, value: Value, place: str) -> str:
    first = question.choices.get(languages[0]) or next(iter(question.choices.values()))
    for choices in question.choices.values():
        if value in choices:
            return first[choices.index(str(value))]
    raise InputError("answer", place, f"{value!r:.60} is none of {', '.join(first)}", CHOOSE)


def _number(question: Question, value: Value, place: str) -> float:
    low = -math.inf if question.low is None else question.low
    high = math.inf if question.high is None else question.high
    if isinstance(value, str) or value is None or not (low <= value <= high and math.isfinite(value)):
        raise InputError("answer", place, f"{value!r:.40} is no number from {low:g} to {high:g}", CHOOSE)
    return float(value)

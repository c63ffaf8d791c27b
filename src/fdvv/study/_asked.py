"""What may be answered: in a trial, and on a page."""

from __future__ import annotations

import math
from collections.abc import Mapping

from fdvv.errors import InputError
from fdvv.study._events import TrialFace, Value
from fdvv.study._plan import Page, Question, Rating, StudyPlan
from fdvv.study._trial import EQUAL, TrialAnswer
from fdvv.study._words import asks_choice, offers_equal

LONGEST_TEXT = 2000
CHOOSE = "answer it again"


def choices_of(plan: StudyPlan) -> tuple[str, ...]:
    """Give the answers that a trial offers; none where only ratings are asked."""
    if not asks_choice(plan):
        return ()
    return ("A", EQUAL, "B") if offers_equal(plan) else ("A", "B")


def rated_labels(trial: TrialFace) -> tuple[str, ...]:
    """Give the labels that are rated: all that hide something."""
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
    low, high = (0, 100) if rating.points == 101 else (1, rating.points)
    if set(given) != set(labels):
        raise InputError("answer", place, f"{rating.name} is not rated for {', '.join(labels)}", CHOOSE)
    for label, points in given.items():
        if not (low <= points <= high and points == round(points)):
            reason = f"{rating.name} of {label} is {points:g}, not a whole number from {low} to {high}"
            raise InputError("answer", place, reason, CHOOSE)


def checked_page(plan: StudyPlan, page: Page, values: Mapping[str, Value]) -> dict[str, Value]:
    """Give a page's answers as they are kept; a choice in the study's first language. InputError."""
    asked = {question.name: question for question in page.questions}
    for name in set(values) - set(asked):
        raise InputError("answer", f"page {page.name}", f"does not ask {name!r:.60}", CHOOSE)
    return {name: _kept(plan, page, one, values.get(name)) for name, one in asked.items()}


def _kept(plan: StudyPlan, page: Page, question: Question, value: Value) -> Value:
    place = f"page {page.name}, {question.name}"
    if value is None or value == "":
        if question.required:
            raise InputError("answer", place, "is not answered", CHOOSE)
        return None
    if question.choices:
        return _choice(plan, question, value, place)
    if question.low is not None or question.high is not None:
        return _number(question, value, place)
    if not isinstance(value, str) or len(value) > LONGEST_TEXT:
        raise InputError("answer", place, f"is not a text of at most {LONGEST_TEXT} letters", CHOOSE)
    return value


def _choice(plan: StudyPlan, question: Question, value: Value, place: str) -> str:
    """Find a choice in whatever language; give it in the first."""
    first = question.choices.get(plan.languages[0]) or next(iter(question.choices.values()))
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

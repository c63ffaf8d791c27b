"""From where a participant stands to what their screen is told, in their language."""

from __future__ import annotations

import re
from collections.abc import Mapping

import msgspec

from fdvv.program import Signal
from fdvv.studio import _messages_study as m
from fdvv.studio._messages_press import ShakeSignal
from fdvv.studio._press_tell import DIGITS, shake_signal
from fdvv.study import (
    EQUAL,
    Page,
    Question,
    Rating,
    SessionState,
    Step,
    StudyPlan,
    TrialFace,
    choices_of,
    equal_text,
    question_text,
    rated_labels,
)
from fdvv.workflow import PersonFrame

PARTED = re.compile(r"\n\s*\n")


def step_told(plan: StudyPlan, state: SessionState, language: str, step: Step) -> m.StudyStep:
    """Tell a step."""
    form = task = None
    if step.kind == "page":
        (page,) = (one for one in plan.pages if one.name == step.page)
        form = form_told(page, language)
    elif step.kind in ("practice", "trial"):
        task = task_told(plan, state, language, state.began.trials[step.number])
    left_s = step.left_s if step.kind == "break" else None
    return m.StudyStep(step.kind, round(step.progress, 4), form, task, left_s)


def form_told(page: Page, language: str) -> m.StudyForm:
    """Tell a page; blank lines part its paragraphs."""
    paragraphs = PARTED.split(said(page.text, language).strip())
    return m.StudyForm(
        page.name,
        said(page.title, language),
        [text for text in paragraphs if text],
        [_asked(question, language) for question in page.questions],
        page.when == "consent",
    )


def task_told(plan: StudyPlan, state: SessionState, language: str, face: TrialFace) -> m.StudyTask:
    """Tell a trial; how many there are is told where that is known, which a staircase's end is not."""
    alike = [one.number for one in state.began.trials if one.practice == face.practice]
    known = face.practice or plan.kind != "staircase"
    at = 1 + sum(number in state.answers for number in alike)
    return m.StudyTask(
        face.number,
        at,
        len(alike) if known else 0,
        face.item,
        question_text(plan, language),
        list(face.labels),
        [choice for choice in choices_of(plan) if choice != EQUAL],
        equal_text(plan, language),
        list(rated_labels(face)) if plan.ratings else [],
        [_scale(rating, language) for rating in plan.ratings],
    )


def said(texts: Mapping[str, str], language: str) -> str:
    """Give a text in a language, else in the one that is there."""
    return texts.get(language) or next(iter(texts.values()), "")


def _scale(rating: Rating, language: str) -> m.StudyScale:
    question, low, high = (said(texts, language) for texts in (rating.question, rating.low, rating.high))
    return m.StudyScale(rating.name, question, low, high, rating.points)


def _asked(question: Question, language: str) -> m.StudyAsked:
    choices = question.choices.get(language) or next(iter(question.choices.values()), ())
    about = (question.low, question.high, question.required)
    return m.StudyAsked(question.name, said(question.question, language), list(choices), *about)


def frame_told(frame: PersonFrame) -> m.StudyFrame:
    """Tell a frame: where the cap is at its end, and what was heard in it."""
    clicks = [m.StudyClick(one.sound, one.t_s, one.velocity_mm_s) for one in frame.clicks]
    t_s, displacement_mm = (round(float(column[-1]), DIGITS) for column in (frame.t_s, frame.displacement_mm))
    return m.StudyFrame(
        frame.label, t_s, displacement_mm, frame.key > 0, frame.pressed, frame.dropped_s, clicks
    )


def sound_told(signal: Signal) -> ShakeSignal:
    """Tell a sound without its name, which may be that of a stimulus."""
    return msgspec.structs.replace(shake_signal(signal), name="")

"""What a participant's screen shows: steps and frames in their language, and the stage behind them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Any, Literal

from fdvv.errors import DeviceError, InputError
from fdvv.program.program import Signal
from fdvv_people.pages.participant.messages import StudyBroke
from fdvv_people.pages.studies import TWIN, Studies
from fdvv_people.study.admin.study import Study
from fdvv_people.study.plan.events import TrialFace, choices_of, rated_labels
from fdvv_people.study.plan.plan import Page, Question, Rating, StudyPlan
from fdvv_people.study.plan.plan_words import equal_text, question_text
from fdvv_people.study.plan.sitting import Step
from fdvv_people.study.plan.trial import EQUAL
from fdvv_people.study.stimulus.open import ScreenRenderer, open_screen_renderer
from fdvv_people.study.stimulus.twin import PersonClick, PersonFrame
from fdvv_studio.studio.api.press_frames import DIGITS, ShakeSignal
from fdvv_studio.studio.contract import Message, Tell, message_of
from fdvv_studio.studio.devices import DeviceLocks, device_names, require_listed
from fdvv_studio.studio.studio import Studio

PARTED = re.compile(r"\n\s*\n")


def step_message(plan: StudyPlan, language: str, step: Step[TrialFace]) -> StudyStep:
    task = task_message(plan, language, step) if step.kind in ("practice", "trial") else None
    return message_of(StudyStep, step, **step_parts(plan.pages, language, step), task=task)


def step_parts(pages: Iterable[Page], language: str, step: Step[Any]) -> dict[str, Any]:
    """Return what steps of every kind of study tell alike: the page, the break, how much is done."""
    page = next((one for one in pages if step.kind == "page" and one.name == step.page), None)
    return {
        "form": form_message(page, language) if page else None,
        "left_s": step.left_s if step.kind == "break" else None,
        "progress_ratio": round(step.progress, 4),
    }


def form_message(page: Page, language: str) -> StudyForm:
    """Return a page; blank lines separate its paragraphs."""
    paragraphs = PARTED.split(text_in(page.text, language).strip())
    return StudyForm(
        page.name,
        text_in(page.title, language),
        [text for text in paragraphs if text],
        [_question(question, language) for question in page.questions],
        page.when == "consent",
    )


def task_message(plan: StudyPlan, language: str, step: Step[TrialFace]) -> StudyTask:
    face = step.trial
    return StudyTask(
        step.number,
        step.at,
        step.of,
        face.item,
        question_text(plan, language),
        face.labels,
        [choice for choice in choices_of(plan) if choice != EQUAL],
        equal_text(plan, language),
        rated_labels(face) if plan.ratings else (),
        [_scale(rating, language) for rating in plan.ratings],
    )


def text_in(texts: Mapping[str, str], language: str) -> str:
    """Return a text in a language, else in any there is."""
    return texts.get(language) or next(iter(texts.values()), "")


def _scale(rating: Rating, language: str) -> StudyScale:
    question, low, high = (text_in(texts, language) for texts in (rating.question, rating.low, rating.high))
    return StudyScale(rating.name, question, low, high, rating.points)


def _question(question: Question, language: str) -> StudyAsked:
    choices = question.choices.get(language) or next(iter(question.choices.values()), ())
    return message_of(StudyAsked, question, question=text_in(question.question, language), choices=choices)


def frame_message(frame: PersonFrame) -> StudyFrame:
    """Return a frame: the position of the cap at its end, and its clicks."""
    t_s, displacement_mm = (round(float(column[-1]), DIGITS) for column in (frame.t_s, frame.displacement_mm))
    return message_of(StudyFrame, frame, t_s=t_s, displacement_mm=displacement_mm, key=frame.key > 0)


def unnamed_sound(signal: Signal) -> ShakeSignal:
    """Return a sound without its name, which may reveal the stimulus."""
    return message_of(ShakeSignal, signal, name="")


StepKind = Literal["page", "practice", "trial", "break", "done", "declined", "withdrawn"]


class StudyScale(Message):
    """A scale on which every hidden rendering is rated; words in the person's language."""

    name: str
    question: str
    low: str
    high: str
    points: int


class StudyAsked(Message):
    """A question of a page; choices empty: a number from low to high, or free text."""

    name: str
    question: str
    choices: tuple[str, ...]
    low: float | None
    high: float | None
    required: bool


class StudyForm(Message):
    """A page outside the trials; consent : it asks for agreement."""

    name: str
    title: str
    paragraphs: list[str]
    questions: list[StudyAsked]
    consent: bool


class StudyTask(Message):
    """A trial. number : of the person, practice included.

    at, of : for people, among trials that count, or among those of practice; of : 0 where it is not known.
    places : labels that can be brought under the finger. choices : that can be chosen; none where only
    ratings are asked. equal : words on the answer that it is none of them; empty where it is not offered.
    rated : labels that are rated on every scale.
    item : name of the button it is about.
    """

    number: int
    at: int
    of: int
    item: str
    question: str
    places: tuple[str, ...]
    choices: list[str]
    equal: str
    rated: tuple[str, ...]
    scales: list[StudyScale]


class StudyStep(Message, tag="step"):
    """What comes next. progress_ratio : of the whole session. left_s : of a break, or None."""

    kind: StepKind
    progress_ratio: float
    form: StudyForm | None = None
    task: StudyTask | None = None
    left_s: float | None = None


class StudyFrame(Message, tag="frame"):
    """What the cap did since the last frame; no force is sent.

    t_s, displacement_mm : of its end. pressed : presses that ended. dropped_s : time that
        was not simulated.
    """

    label: str
    t_s: float
    displacement_mm: float
    key: bool
    pressed: int
    dropped_s: float
    clicks: tuple[PersonClick, ...]


class StudyStages:
    """Opens stages for one screen, and holds the lease of the device they use. tell : to that screen."""

    def __init__(self, studio: Studio, tell: Tell) -> None:
        self._studies, self._tell = studio.part(Studies), tell
        self._locks, self._locked = studio.part(DeviceLocks), ""

    def open(self, study: Study) -> ScreenRenderer:
        """Open what the operator chose. InputError where it is used elsewhere, DeviceError."""
        device = self._studies.device(study.folder.name)
        if device not in (TWIN, self._locked):
            # the file that names it may come from somebody else
            require_listed("device", device, device_names(), "ask who leads the study")
            self.release()
            self._locks.acquire(device, f"the study {study.folder.name}")
            self._locked = device
        return open_screen_renderer(device, study.folder, self._show, self._broke, study.plan.switch_s)

    def first(self, study: Study) -> ScreenRenderer:
        """Open a stage for a new session. InputError where it cannot be opened."""
        try:
            return self.open(study)
        except DeviceError as error:
            self.release()
            raise InputError("study", "device", str(error), "ask who leads the study") from error

    def release(self) -> None:
        if self._locked:
            self._locks.release(self._locked)
            self._locked = ""

    def _show(self, frame: PersonFrame) -> None:
        if frame.t_s.size:  # else this machine was busy, and no time has passed
            self._tell(frame_message(frame))

    def _broke(self, _line: str) -> None:
        """Report that the button restarts; the reason could reveal what was rendered."""
        self._tell(StudyBroke())


class StudyReady(Message, tag="ready"):
    """A trial's labels can be felt; nothing here differs between them.

    travel_mm : scale of the drawing, the same for all labels. signals : of all labels together, without
    names, in an order that tells nothing.
    """

    number: int
    travel_mm: float
    signals: list[ShakeSignal]

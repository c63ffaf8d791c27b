"""Messages of the participant's screen: labels, and never what hides behind one."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta, Struct

from fdvv.studio._messages_press import Count, Number, ShakeSignal

Short = Annotated[str, Meta(max_length=100)]
Long = Annotated[str, Meta(max_length=4000)]
Holder = Annotated[str, Meta(min_length=16, max_length=100)]
StepKind = Literal["page", "practice", "trial", "break", "done", "declined", "withdrawn"]


class StudyLook(Struct, frozen=True, forbid_unknown_fields=True, tag="look"):
    """Ask what the study is, before anybody sits down.

    seat : that the link holds, or empty. holder : see StudySit.
    """

    study: Short
    seat: Short
    holder: Holder


class StudySit(Struct, frozen=True, forbid_unknown_fields=True, tag="sit"):
    """Sit down as a new person.

    seat : the one-time word that the operator's link holds. holder : a word that this page drew and tells
        nobody else: whoever begins first holds the seat, and a link that others see gives it to none of them.
    """

    study: Short
    seat: Short
    holder: Holder
    language: Short


class StudyResume(Struct, frozen=True, forbid_unknown_fields=True, tag="resume"):
    """Go on as a person who has a card. code : what stands on it."""

    study: Short
    person: Short
    code: Short


class StudyShown(Struct, frozen=True, forbid_unknown_fields=True, tag="shown"):
    """The trial is on the screen."""

    number: Count


class StudyGo(Struct, frozen=True, forbid_unknown_fields=True, tag="go"):
    """Bring what a label hides under the finger."""

    label: Short


class StudyLead(Struct, frozen=True, forbid_unknown_fields=True, tag="lead"):
    """Lead the finger to a place that moves at a speed, as PressLead does."""

    referent_mm: Number
    velocity_mm_s: Number
    near_1_s: Annotated[float, Meta(ge=1, le=1000)] = 125.0


class StudyPush(Struct, frozen=True, forbid_unknown_fields=True, tag="push"):
    """Push with a force."""

    force_cN: Number


class StudyLift(Struct, frozen=True, forbid_unknown_fields=True, tag="lift"):
    """Take the finger off."""


class StudyAnswered(Struct, frozen=True, forbid_unknown_fields=True, tag="answer"):
    """Answer a trial. choice : a label, "equal", or "" where only ratings are asked. ratings : by label."""

    number: Count
    choice: Short
    ratings: Annotated[dict[Short, dict[Short, float]], Meta(max_length=20)]


class StudyFilled(Struct, frozen=True, forbid_unknown_fields=True, tag="page"):
    """Answer a page's questions, and its consent where it asks for that."""

    name: Short
    values: Annotated[dict[Short, Long | float], Meta(max_length=200)]
    agreed: bool


class StudyAgain(Struct, frozen=True, forbid_unknown_fields=True, tag="again"):
    """Set up the button that broke."""


class StudyRested(Struct, frozen=True, forbid_unknown_fields=True, tag="rested"):
    """Go on after the break."""


class StudyWithdraw(Struct, frozen=True, forbid_unknown_fields=True, tag="withdraw"):
    """Leave the study for good."""


class StudyHere(Struct, frozen=True, forbid_unknown_fields=True, tag="here"):
    """Somebody looks at the page."""


class StudyAbout(Struct, frozen=True, tag="about"):
    """What the study is. seat : it can be taken by this page. titles : by language."""

    study: str
    titles: dict[str, str]
    languages: list[str]
    seat: bool


class StudyCard(Struct, frozen=True, tag="card"):
    """Who sits here. code : to be written down by the person; told to nobody else, empty after a resume."""

    person: str
    language: str
    code: str


class StudyScale(Struct, frozen=True):
    """A scale on which every hidden rendering is rated; words in the person's language."""

    name: str
    question: str
    low: str
    high: str
    points: int


class StudyAsked(Struct, frozen=True):
    """A question of a page; choices empty: a number from low to high, or free text."""

    name: str
    question: str
    choices: list[str]
    low: float | None
    high: float | None
    required: bool


class StudyForm(Struct, frozen=True):
    """A page outside the trials; consent : it asks for agreement."""

    name: str
    title: str
    paragraphs: list[str]
    questions: list[StudyAsked]
    consent: bool


class StudyTask(Struct, frozen=True):
    """A trial. number : of the person, practice included.

    at, of : for people, among trials that count, or among those of practice; of : 0 where nobody knows.
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
    places: list[str]
    choices: list[str]
    equal: str
    rated: list[str]
    scales: list[StudyScale]


class StudyStep(Struct, frozen=True, tag="step"):
    """What comes next. progress_ratio : of the whole session. left_s : of a break, or None."""

    kind: StepKind
    progress_ratio: float
    form: StudyForm | None = None
    task: StudyTask | None = None
    left_s: float | None = None


class StudyReady(Struct, frozen=True, tag="ready"):
    """A trial's labels can be felt; nothing here differs between them.

    travel_mm : scale of the drawing, the same for all labels. signals : of all labels together, without
    names, in an order that tells nothing.
    """

    number: int
    travel_mm: float
    signals: list[ShakeSignal]


class StudyFelt(Struct, frozen=True, tag="felt"):
    """A label is under the finger."""

    label: str


class StudyClick(Struct, frozen=True):
    """A vibration starts at the cap. sound : its place among the trial's signals."""

    sound: int
    t_s: float
    velocity_mm_s: float


class StudyFrame(Struct, frozen=True, tag="frame"):
    """What the cap did since the last frame; no force is told.

    t_s, displacement_mm : of its end. pressed : presses that ended. dropped_s : time that
        was not simulated.
    """

    label: str
    t_s: float
    displacement_mm: float
    key: bool
    pressed: int
    dropped_s: float
    clicks: list[StudyClick]


class StudyBroke(Struct, frozen=True, tag="broke"):
    """The button fell to zero force and is set up anew: the trial's labels are felt once more."""


class StudyPaused(Struct, frozen=True, tag="paused"):
    """The operator pauses: the screen waits, whatever step it is at."""

    on: bool


class StudyStopped(Struct, frozen=True, tag="stopped"):
    """This screen serves nobody any more. reason : one line."""

    reason: str

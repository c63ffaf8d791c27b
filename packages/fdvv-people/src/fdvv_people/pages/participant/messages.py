"""What every participant's screen asks and hears, whatever its study asks of people."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from fdvv_studio.studio.contract import Message

Short = Annotated[str, Meta(max_length=100)]
Long = Annotated[str, Meta(max_length=4000)]
Holder = Annotated[str, Meta(min_length=16, max_length=100)]


class StudyLook(Message, tag="look"):
    """Ask what the study is, before anybody sits down.

    seat : that the link holds, or empty. holder : see JoinSession.
    """

    study: Short
    seat: Short
    holder: Holder


class JoinSession(Message, tag="sit"):
    """Sit down as a new person.

    seat : the one-time word that the operator's link holds. holder : a word that this page drew and tells
        no one else: the first page to begin holds the invitation, even if others see the link.
    """

    study: Short
    seat: Short
    holder: Holder
    language: Short


class StudyResume(Message, tag="resume"):
    """Resume the session of a person who has a card. code : printed on it."""

    study: Short
    person: Short
    code: Short


class StudyFilled(Message, tag="page"):
    """Answer a page's questions, and its consent where it asks for that."""

    name: Short
    values: Annotated[dict[Short, Long | float], Meta(max_length=200)]
    agreed: bool


class EndBreak(Message, tag="rested"):
    """Continue after the break."""


class StudyWithdraw(Message, tag="withdraw"):
    """Leave the study for good."""


class StudyAbout(Message, tag="about"):
    """What the study is. seat : it can be taken by this page. titles : by language.

    kind : as studies.list has it; "timing" and "tapping" go on with the channel of timing.
    """

    study: str
    kind: str
    titles: dict[str, str]
    languages: list[str]
    seat: bool


class StudyCard(Message, tag="card"):
    """The person at this screen. code : for them to write down; sent nowhere else, empty after a resume."""

    person: str
    language: str
    code: str


class StudyPaused(Message, tag="paused"):
    """The operator pauses: the screen waits, whatever step it is at."""

    on: bool


class StudyStopped(Message, tag="stopped"):
    """The session at this screen has ended. reason : one line."""

    reason: str


class StudyBroke(Message, tag="broke"):
    """The button fell to zero force and is set up anew; why it did could reveal what was rendered."""


SEATING = (StudyLook, JoinSession, StudyResume, StudyFilled, EndBreak, StudyWithdraw)
SEATED = (StudyAbout, StudyCard, StudyBroke, StudyPaused, StudyStopped)

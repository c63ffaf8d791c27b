"""The channel of a timing study's participants, and how far each of them is, for the operator."""

from __future__ import annotations

import time

from fdvv_people.pages.api.play import PlayDown, PlayPing, PlayPong, PlayUp
from fdvv_people.pages.api.studies import StudiesAsk
from fdvv_people.pages.participant.messages import SEATED, SEATING
from fdvv_people.pages.participant.screen import TimingScreen
from fdvv_people.pages.participant.steps import (
    TimingBegin,
    TimingKept,
    TimingPlaced,
    TimingReady,
    TimingRound,
    TimingStepMessage,
)
from fdvv_people.pages.play_trials import PlayClick
from fdvv_people.pages.studies import Studies
from fdvv_people.study.admin.progress import study_progress
from fdvv_people.study.plan.sitting import utc_text
from fdvv_people.study.timing.kind import KIND
from fdvv_people.study.timing.progress import PersonPhase
from fdvv_studio.studio.contract import ChannelKind, Here, Message, call, message_of


class TimingPerson(Message):
    """How far a person of a timing study is, in times of the day (UTC).

    phase : where they are. rounds : presses, or seconds of tapping, that are kept.
    due_at : from when they may come back. overdue_at : from when they are late. reminder : to be sent to
        them; empty where none is due. resumptions : how often they came back. interruptions : how often a
        device went away. problem : why their record cannot be read, or empty.
    """

    person: str
    phase: PersonPhase
    rounds: int
    due_at: str
    overdue_at: str
    reminder: str
    resumptions: int
    interruptions: int
    problem: str


class TimingProgress(Message):
    """How far everybody is. now : when that was (UTC)."""

    study: str
    now: str
    people: list[TimingPerson]


@call("timing.progress")
def progress(studies: Studies, ask: StudiesAsk) -> TimingProgress:
    now_s = time.time()
    people = study_progress(studies.study(ask.study, KIND), now_s)
    return TimingProgress(ask.study, utc_text(now_s), [message_of(TimingPerson, one) for one in people])


ASKS = (*SEATING, TimingPlaced, TimingBegin, TimingRound, PlayPing, PlayDown, PlayUp, Here)
TELLS = (*SEATED, TimingStepMessage, TimingReady, TimingKept, PlayPong, PlayClick)
CHANNEL = ChannelKind("timing", ASKS, TELLS, TimingScreen, TimingScreen)

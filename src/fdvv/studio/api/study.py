"""The participant's screen: labels, and never what hides behind one."""

from __future__ import annotations

from threading import RLock
from typing import Annotated

from msgspec import Meta

from fdvv.errors import DeviceError, FdvvError, InputError, ModelError
from fdvv.studio.api.press import Count, Number
from fdvv.studio.api.study_steps import (
    StudyBroke,
    StudyFrame,
    StudyReady,
    StudyStages,
    StudyStep,
    step_message,
    unnamed_sound,
)
from fdvv.studio.contract import ChannelKind, Here, Message, Tell, error_line
from fdvv.studio.studies import Invitation, Studies
from fdvv.studio.studio import Studio
from fdvv.study.admin.study import Study
from fdvv.study.plan.session import ENDS, Step
from fdvv.study.plan.trial import TrialAnswer
from fdvv.study.session.participant import Participant
from fdvv.study.stimulus.open import ScreenRenderer

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


class StudyShown(Message, tag="shown"):
    """The trial is on the screen."""

    number: Count


class ContinueStep(Message, tag="go"):
    """Bring what a label hides under the finger."""

    label: Short


class StudyLead(Message, tag="lead"):
    """Lead the finger to a place that moves at a speed, as PressLead does."""

    referent_mm: Number
    velocity_mm_s: Number
    near_1_s: Annotated[float, Meta(ge=1, le=1000)] = 125.0


class StudyPush(Message, tag="push"):
    """Push with a force."""

    force_cN: Number


class StudyLift(Message, tag="lift"):
    """Take the finger off."""


class StudyAnswered(Message, tag="answer"):
    """Answer a trial. choice : a label, "equal", or "" where only ratings are asked. ratings : by label."""

    number: Count
    choice: Short
    ratings: Annotated[dict[Short, dict[Short, float]], Meta(max_length=20)]


class StudyFilled(Message, tag="page"):
    """Answer a page's questions, and its consent where it asks for that."""

    name: Short
    values: Annotated[dict[Short, Long | float], Meta(max_length=200)]
    agreed: bool


class StudyAgain(Message, tag="again"):
    """Set up the button that broke."""


class EndBreak(Message, tag="rested"):
    """Continue after the break."""


class StudyWithdraw(Message, tag="withdraw"):
    """Leave the study for good."""


class StudyAbout(Message, tag="about"):
    """What the study is. seat : it can be taken by this page. titles : by language."""

    study: str
    titles: dict[str, str]
    languages: list[str]
    seat: bool


class StudyCard(Message, tag="card"):
    """The person at this screen. code : for them to write down; sent nowhere else, empty after a resume."""

    person: str
    language: str
    code: str


class StudyFelt(Message, tag="felt"):
    """A label is under the finger."""

    label: str


class StudyPaused(Message, tag="paused"):
    """The operator pauses: the screen waits, whatever step it is at."""

    on: bool


class StudyStopped(Message, tag="stopped"):
    """The session at this screen has ended. reason : one line."""

    reason: str


def taken_error() -> InputError:
    return InputError("study", "seat", "is taken", "ask for another, or continue with your card")


class StudyScreen:
    """What serves one page: no one, or a participant, whom the operator may pause or withdraw.

    seat : the word of the seat that the page is confined to; empty: to none.
    """

    def __init__(self, studio: Studio, tell: Tell, seat: str = "") -> None:
        self._seat = seat
        self._studies, self._tell = studio.part(Studies), tell
        self._stages = StudyStages(studio, tell)
        self._name = ""
        self._participant: Participant | None = None
        self._stage: ScreenRenderer | None = None
        self._invitation: Invitation | None = None
        # the operator may use it while the page's own thread does
        self._lock, self._gone = RLock(), False

    def receive(self, ask: Message) -> None:
        """Do what the page asks; without a participant most asks have come too late and do nothing."""
        if isinstance(ask, StudyLead | StudyPush | StudyLift | Here):
            self._move_finger(ask)
            return
        with self._lock:
            if self._gone:  # the page was closed while this waited for its turn
                return
            try:
                self._do(ask)
            except DeviceError:
                self._tell(StudyBroke())
            except ModelError:
                # a page that fell behind gets the step it is at
                self._tell_step()

    def close(self) -> None:
        """The page is gone: the session waits to be resumed."""
        with self._lock:
            self._gone = True
            self._leave_session()

    def _leave_session(self) -> None:
        with self._lock:
            participant, self._participant, self._stage = self._participant, None, None
            if participant:
                participant.close()
                self._studies.detach(self._name, participant.person, self)
            self._stages.release()

    def pause(self, on: bool) -> None:
        stage = self._stage
        if on and stage:
            stage.lift()
        self._tell(StudyPaused(on))

    def leave(self, reason: str) -> None:
        """End the session at this screen with a reason."""
        self._leave_session()
        self._tell(StudyStopped(reason))

    def withdraw(self, delete: bool) -> None:
        with self._lock:
            if self._participant:
                self._advance(self._participant.withdraw(delete=delete))

    def _confine(self, ask: StudyLook | JoinSession | StudyResume) -> None:
        """Refuse what is not of the page's own seat. InputError."""
        if not self._seat:
            return
        study, seat = self._studies.seat(self._seat) or ("", None)
        other = isinstance(ask, JoinSession | StudyLook) and ask.seat not in ("", self._seat)
        someone = isinstance(ask, StudyResume) and seat is not None and seat.person not in ("", ask.person)
        if seat is None or study != ask.study or other or someone:
            raise InputError("study", "seat", "is another one's", "ask for an invitation of your own")

    def _do(self, ask: Message) -> None:
        if isinstance(ask, StudyLook | JoinSession | StudyResume):
            self._confine(ask)
        match ask:
            case StudyLook():
                plan = self._studies.study(ask.study).plan
                free = self._studies.invitation(ask.study, ask.seat, ask.holder) is not None
                self._tell(StudyAbout(ask.study, plan.title, list(plan.languages), free))
            case JoinSession():
                self._join(ask)
            case StudyResume() if self._studies.study(ask.study).waits_for_key(ask.person):
                # as when the operator pauses: after a restart of the studio the page goes on by itself
                self._tell(StudyPaused(True))
                self._studies.when_open(ask.study, lambda: self._resume_late(ask))
            case StudyResume():
                self._leave_session()
                self._resume(self._studies.study(ask.study), ask.study, ask.person, ask.code)
                if self._seat:
                    self._studies.settle(self._seat, ask.person)
                self._begin("")
            case _ if self._participant and self._stage:
                self._go_on(ask, self._participant, self._stage)

    def _join(self, ask: JoinSession) -> None:
        invitation = self._studies.invitation(ask.study, ask.seat, ask.holder)
        if invitation is None:
            raise taken_error()
        self._leave_session()
        study = self._studies.study(ask.study)
        with invitation.lock:
            if self._studies.invitation(ask.study, ask.seat, ask.holder) is None:  # two began at once
                raise taken_error()
            if invitation.person:  # the page went away before it heard the code
                if not invitation.code:  # and so did the studio
                    raise taken_error()
                self._resume(study, ask.study, invitation.person, invitation.code)
            else:
                stage = self._stages.first(study)
                participant, code = Participant.enrol(study, ask.language, stage)
                self._studies.take(invitation, participant.person, code, ask.holder)
                self._take(ask.study, participant, stage)
            self._invitation = invitation
        self._begin(invitation.code)

    def _resume_late(self, ask: StudyResume) -> None:
        try:
            self.receive(ask)
        except (FdvvError, OSError) as error:
            self._tell(StudyStopped(error_line(error)))

    def _go_on(self, ask: Message, participant: Participant, stage: ScreenRenderer) -> None:
        match ask:
            case StudyShown():
                self._forget_code()
                participant.show_trial(ask.number)
                signals = [unnamed_sound(signal) for signal in stage.sounds]
                self._tell(StudyReady(ask.number, stage.travel_mm, signals))
            case ContinueStep():
                self._require_running(participant)
                participant.go_to(ask.label)
                self._tell(StudyFelt(ask.label))
            case StudyAgain():
                self._stage = self._stages.open(participant.study)
                participant.reconnect(self._stage)
                self._tell_step()
            case StudyAnswered():
                self._require_running(participant)
                answer = TrialAnswer(choice=ask.choice, ratings=ask.ratings)
                self._advance(participant.answer(ask.number, answer))
            case StudyFilled():
                self._forget_code()
                self._advance(participant.answer_page(ask.name, ask.values, ask.agreed))
            case EndBreak():
                self._advance(participant.end_break())
            case StudyWithdraw():
                self.withdraw(delete=True)

    def _move_finger(self, ask: StudyLead | StudyPush | StudyLift | Here) -> None:
        """Lead the finger; many of these come, and none waits for anything."""
        stage = self._stage
        if stage is None:
            return
        match ask:
            case Here():
                stage.here()
            case StudyLead():
                stage.lead(ask.referent_mm, ask.velocity_mm_s, ask.near_1_s)
            case StudyPush():
                stage.push(ask.force_cN)
            case StudyLift():
                stage.lift()

    def _resume(self, study: Study, name: str, person: str, code: str) -> None:
        """Resume a person's session; another screen that serves them, or is about to, ends first."""
        with self._studies.exclusive(name, person):
            other = self._studies.screen(name, person)
            if other:
                study.schedule(person, code)  # a wrong code must not take anybody's screen away
                other.leave("this study continues at another screen")
            stage = self._stages.first(study)
            self._take(name, Participant.resume(study, person, code, stage), stage)

    def _take(self, name: str, participant: Participant, stage: ScreenRenderer) -> None:
        self._name, self._participant, self._stage = name, participant, stage
        self._studies.attach(name, participant.person, self)

    def _begin(self, code: str) -> None:
        assert self._participant is not None
        self._tell(StudyCard(self._participant.person, self._participant.language, code))
        self._tell(StudyPaused(self._studies.paused(self._name, self._participant.person)))
        self._tell_step()

    def _forget_code(self) -> None:
        """Forget the code: the page has shown it."""
        if self._invitation:
            self._studies.settle(self._invitation.word, self._invitation.person)
            self._invitation = None

    def _require_running(self, participant: Participant) -> None:
        if self._studies.paused(self._name, participant.person):
            raise InputError("study", "screen", "the study pauses", "wait a moment")

    def _advance(self, step: Step) -> None:
        """Send the next step; at the end of the session the operator is informed too."""
        self._tell_step(step)
        if self._participant and step.kind in ENDS:
            self._leave_session()
        else:
            self._studies.announce(self._name)

    def _tell_step(self, step: Step | None = None) -> None:
        participant = self._participant
        if participant:
            now = step or participant.step()
            self._tell(step_message(participant.study.plan, participant.state, participant.language, now))


ASKS = (
    *(StudyLook, JoinSession, StudyResume, StudyShown, ContinueStep, StudyLead, StudyPush, StudyLift),
    *(StudyAgain, StudyAnswered, StudyFilled, EndBreak, StudyWithdraw, Here),
)
TELLS = (
    *(StudyAbout, StudyCard, StudyStep, StudyReady, StudyFelt),
    *(StudyFrame, StudyBroke, StudyPaused, StudyStopped),
)
CHANNEL = ChannelKind("study", ASKS, TELLS, StudyScreen, StudyScreen)

"""Who sits at a participant's screen: invitations, cards, pauses and the way out, of every kind of study."""

from __future__ import annotations

from abc import ABC, abstractmethod
from threading import RLock
from typing import Any, ClassVar, Generic, TypeVar

from msgspec import Struct

from fdvv.errors import DeviceError, FdvvError, InputError, ModelError
from fdvv_people.pages.participant.messages import (
    EndBreak,
    JoinSession,
    StudyAbout,
    StudyBroke,
    StudyCard,
    StudyFilled,
    StudyLook,
    StudyPaused,
    StudyResume,
    StudyStopped,
    StudyWithdraw,
)
from fdvv_people.pages.studies import Studies
from fdvv_people.study.admin.study import Study
from fdvv_people.study.kind import StudyKind
from fdvv_people.study.plan.sitting import ENDS, Step
from fdvv_people.study.session.sitting import Sitting
from fdvv_studio.studio.contract import Message, Tell, error_line
from fdvv_studio.studio.seats import Invitation
from fdvv_studio.studio.studio import Studio

P = TypeVar("P", bound=Sitting[Any])


def taken_error() -> InputError:
    return InputError("study", "seat", "is taken", "ask for another, or continue with your card")


class SeatedScreen(ABC, Generic[P]):
    """What serves one page: no one, or a participant, whom the operator may pause or withdraw.

    seat : the word of the seat that the page is confined to; empty: to none.

    Attributes
    ----------
    sitting, kind : of its participants, and of their studies.
    """

    sitting: type[P]
    kind: ClassVar[StudyKind[Any]]

    def __init__(self, studio: Studio, tell: Tell, seat: str = "") -> None:
        self._seat, self._name = seat, ""
        self._studies, self._tell = studio.part(Studies), tell
        self._seats = self._studies.seats
        self._participant: P | None = None
        self._staged: tuple[Any, ...] = ()
        self._invitation: Invitation | None = None
        # the operator may use it while the page's own thread does
        self._lock, self._gone = RLock(), False

    def prepare(self, study: Study) -> tuple[Any, ...]:
        """Make ready what a session needs besides its study, or nothing. InputError, OSError."""
        del study
        return ()

    @abstractmethod
    def go_on(self, ask: Message, participant: P) -> None:
        """Do what a page asks whose person sits here, where it is no matter of the seat."""

    @abstractmethod
    def message(self, participant: P, step: Any) -> Struct:
        """Return a step as the page gets it."""

    @abstractmethod
    def put_away(self) -> None:
        """Let go of what is under the finger: the person leaves the screen, or their step is over."""

    def lift(self) -> None:
        """Have a simulated finger leave the button, if there is one."""

    def receive(self, ask: Message) -> None:
        """Do what the page asks; without a participant most asks have come too late and do nothing."""
        with self._lock:
            if self._gone:  # the page was closed while this waited for its turn
                return
            try:
                self._do(ask)
            except DeviceError:
                self._tell(StudyBroke())
            except ModelError:
                # a page that fell behind gets the step it is at
                self.tell_step()

    def close(self) -> None:
        """The page is gone: the session waits to be resumed."""
        with self._lock:
            self._gone = True
            self._leave_session()

    def _leave_session(self) -> None:
        with self._lock:
            participant, self._participant = self._participant, None
            self.put_away()
            if participant:
                participant.close()
                self._studies.screens.detach(self._name, participant.person, self)

    def pause(self, on: bool) -> None:
        if on:
            self.lift()
        self._tell(StudyPaused(on))

    def leave(self, reason: str) -> None:
        """End the session at this screen with a reason."""
        self._leave_session()
        self._tell(StudyStopped(reason))

    def withdraw(self, delete: bool) -> None:
        with self._lock:
            if self._participant:
                self.put_away()
                self.advance(self._participant.withdraw(delete=delete))

    def _confine(self, ask: StudyLook | JoinSession | StudyResume) -> None:
        """Refuse what is not of the page's own seat. InputError."""
        if not self._seat:
            return
        study, seat = self._seats.find(self._seat) or ("", None)
        other = isinstance(ask, JoinSession | StudyLook) and ask.seat not in ("", self._seat)
        someone = isinstance(ask, StudyResume) and seat is not None and seat.person not in ("", ask.person)
        if seat is None or study != ask.study or other or someone:
            raise InputError("study", "seat", "is another one's", "ask for an invitation of your own")

    def _do(self, ask: Message) -> None:
        match ask:
            case StudyLook() | JoinSession() | StudyResume():
                self._confine(ask)
                self._take_place(ask)
            case _ if participant := self._participant:
                self._sit(ask, participant)

    def _take_place(self, ask: StudyLook | JoinSession | StudyResume) -> None:
        match ask:
            case StudyLook():
                plan = self._studies.study(ask.study).plan
                free = self._seats.invitation(ask.study, ask.seat, ask.holder) is not None
                self._tell(StudyAbout(ask.study, plan.kind, plan.title, list(plan.languages), free))
            case JoinSession():
                self._join(ask)
            case StudyResume() if self._studies.study(ask.study).waits_for_key(ask.person):
                # as when the operator pauses: after a restart of the studio the page goes on by itself
                self._tell(StudyPaused(True))
                self._studies.when_open(ask.study, lambda: self._resume_late(ask))
            case StudyResume():
                self._leave_session()
                self._resume(ask.study, ask.person, ask.code)
                if self._seat:
                    self._seats.settle(self._seat, ask.person)
                self._begin("")

    def _sit(self, ask: Message, participant: P) -> None:
        match ask:
            case StudyFilled():
                self.forget_code()
                self.advance(participant.answer_page(ask.name, ask.values, ask.agreed))
            case EndBreak():
                self.advance(participant.end_break())
            case StudyWithdraw():
                self.withdraw(delete=True)
            case _:
                self.go_on(ask, participant)

    def _join(self, ask: JoinSession) -> None:
        invitation = self._seats.invitation(ask.study, ask.seat, ask.holder)
        if invitation is None:
            raise taken_error()
        self._leave_session()
        with invitation.lock:
            if self._seats.invitation(ask.study, ask.seat, ask.holder) is None:  # two began at once
                raise taken_error()
            if invitation.person:  # the page went away before it heard the code
                if not invitation.code:  # and so did the studio
                    raise taken_error()
                self._resume(ask.study, invitation.person, invitation.code)
            else:
                study = self._studies.study(ask.study, self.kind)
                stage = self.prepare(study)
                participant, code = self.sitting.enrol(study, ask.language, *stage)
                self._seats.take(invitation, participant.person, code, ask.holder)
                self._take(ask.study, participant, stage)
            self._invitation = invitation
        self._begin(invitation.code)

    def _resume_late(self, ask: StudyResume) -> None:
        try:
            self.receive(ask)
        except (FdvvError, OSError) as error:
            self._tell(StudyStopped(error_line(error)))

    def _resume(self, name: str, person: str, code: str) -> None:
        """Resume a person's session; another screen that serves them, or is about to, ends first."""
        with self._studies.screens.exclusive(name, person):
            other = self._studies.screens.find(name, person)
            if other:
                # a wrong code must not take anybody's screen away
                self._studies.study(name).schedule(person, code)
                other.leave("this study continues at another screen")
            study = self._studies.study(name, self.kind)
            stage = self.prepare(study)
            self._take(name, self.sitting.resume(study, person, code, *stage), stage)

    def _take(self, name: str, participant: P, stage: tuple[Any, ...]) -> None:
        self._name, self._participant, self._staged = name, participant, stage
        self._studies.screens.attach(name, participant.person, self)

    def _begin(self, code: str) -> None:
        assert self._participant is not None
        self._tell(StudyCard(self._participant.person, self._participant.language, code))
        self._tell(StudyPaused(self._studies.paused(self._name, self._participant.person)))
        self.tell_step()

    def forget_code(self) -> None:
        """Forget the code: the page has shown it."""
        if self._invitation:
            self._seats.settle(self._invitation.word, self._invitation.person)
            self._invitation = None

    def require_running(self, participant: P) -> None:
        """Raise InputError while the operator pauses."""
        if self._studies.paused(self._name, participant.person):
            raise InputError("study", "screen", "the study pauses", "wait a moment")

    def advance(self, step: Step[Any]) -> None:
        """Send the next step; at the end of the session the operator is informed too."""
        self.tell_step(step)
        if self._participant and step.kind in ENDS:
            self._leave_session()
        else:
            self._studies.announce(self._name)

    def tell_step(self, step: Step[Any] | None = None) -> None:
        """Send a step, the one that is due if none is named."""
        participant = self._participant
        if participant:
            self._tell(self.message(participant, step or participant.step()))

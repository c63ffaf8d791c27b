"""A participant's screen: one page, one person, the button under the hand on a simulated rig at real pace."""

from __future__ import annotations

from functools import singledispatchmethod
from threading import RLock
from typing import Any

from fdvv.errors import DeviceError, InputError, ModelError
from fdvv.studio import _messages_study as m
from fdvv.studio._contract import ChannelKind, Tell
from fdvv.studio._studies import Seat, Studies
from fdvv.studio._studio import Studio
from fdvv.studio._study_stages import StudyStages
from fdvv.studio._study_told import sound_told, step_told
from fdvv.study import ENDS, Step, TrialAnswer
from fdvv.workflow import Participant, ScreenStage, Study


def taken() -> InputError:
    """Make the error of a seat that somebody else has."""
    return InputError("study", "seat", "is taken", "ask for another, or go on with your card")


class StudyScreen:
    """What serves one page: nobody, or a participant. See Screen for what the operator does with it."""

    def __init__(self, studio: Studio, tell: Tell) -> None:
        self._studies, self._tell = studio.part(Studies), tell
        self._stages = StudyStages(studio, tell)
        self._name = ""
        self._participant: Participant | None = None
        self._stage: ScreenStage | None = None
        self._seat: Seat | None = None
        # the operator may use it while the page's own thread does
        self._lock, self._gone = RLock(), False

    def receive(self, ask: Any) -> None:
        """Do what the page asks; without a participant most asks have come too late and do nothing."""
        if isinstance(ask, m.StudyLead | m.StudyPush | m.StudyLift | m.StudyHere):
            self._hand(ask)
            return
        with self._lock:
            if self._gone:  # the page was closed while this waited for its turn
                return
            try:
                self._do(ask)
            except DeviceError:
                self._tell(m.StudyBroke())
            except ModelError:
                # a page that was left behind is told where it is
                self._tell_step()

    def close(self) -> None:
        """The page is gone: the session waits to be resumed."""
        with self._lock:
            self._gone = True
            self._rise()

    def _rise(self) -> None:
        """Serve nobody any more."""
        with self._lock:
            participant, self._participant, self._stage = self._participant, None, None
            if participant:
                participant.close()
                self._studies.rise(self._name, participant.person, self)
            self._stages.release()

    def pause(self, on: bool) -> None:
        """Have it wait, or go on."""
        stage = self._stage
        if on and stage:
            stage.lift()
        self._tell(m.StudyPaused(on))

    def leave(self, reason: str) -> None:
        """Serve nobody any more, and say why."""
        self._rise()
        self._tell(m.StudyStopped(reason))

    def withdraw(self, delete: bool) -> None:
        """Take the person out of the study."""
        with self._lock:
            if self._participant:
                self._go_on(self._participant.withdraw(delete=delete))

    @singledispatchmethod
    def _do(self, ask: Any) -> None:
        raise TypeError(f"no such ask: {ask}")

    @_do.register
    def _(self, ask: m.StudyLook) -> None:
        plan = self._studies.study(ask.study).plan
        free = self._studies.seat(ask.study, ask.seat, ask.holder) is not None
        self._tell(m.StudyAbout(ask.study, plan.title, list(plan.languages), free))

    @_do.register
    def _(self, ask: m.StudySit) -> None:
        seat = self._studies.seat(ask.study, ask.seat, ask.holder)
        if seat is None:
            raise taken()
        self._rise()
        study = self._studies.study(ask.study)
        with seat.lock:
            if seat.holder not in ("", ask.holder):  # two began at once
                raise taken()
            if seat.person:  # the page went away before it heard the code
                self._sit(study, ask.study, seat.person, seat.code)
            else:
                stage = self._stages.first(study)
                participant, seat.code = Participant.enrol(study, ask.language, stage)
                seat.person, seat.holder = participant.person, ask.holder
                self._take(ask.study, participant, stage)
            self._seat = seat
        self._begin(seat.code)

    @_do.register
    def _(self, ask: m.StudyResume) -> None:
        self._rise()
        self._sit(self._studies.study(ask.study), ask.study, ask.person, ask.code)
        self._begin("")

    @_do.register
    def _(self, ask: m.StudyShown) -> None:
        if self._participant and self._stage:
            self._heard()
            self._participant.shown(ask.number)
            signals = [sound_told(signal) for signal in self._stage.sounds]
            self._tell(m.StudyReady(ask.number, self._stage.travel_mm, signals))

    @_do.register
    def _(self, ask: m.StudyGo) -> None:
        if self._participant:
            self._require_on()
            self._participant.go_to(ask.label)
            self._tell(m.StudyFelt(ask.label))

    @_do.register
    def _(self, _ask: m.StudyAgain) -> None:
        if self._participant:
            self._stage = self._stages.open(self._participant.study)
            self._participant.take_stage(self._stage)
            self._tell_step()

    @_do.register
    def _(self, ask: m.StudyAnswered) -> None:
        if self._participant:
            self._require_on()
            answer = TrialAnswer(choice=ask.choice, ratings=ask.ratings)
            self._go_on(self._participant.answer(ask.number, answer))

    @_do.register
    def _(self, ask: m.StudyFilled) -> None:
        if self._participant:
            self._heard()
            self._go_on(self._participant.answer_page(ask.name, ask.values, ask.agreed))

    @_do.register
    def _(self, _ask: m.StudyRested) -> None:
        if self._participant:
            self._go_on(self._participant.end_break())

    @_do.register
    def _(self, _ask: m.StudyWithdraw) -> None:
        self.withdraw(delete=True)

    def _hand(self, ask: Any) -> None:
        """Lead the finger; many of these come, and none waits for anything."""
        stage = self._stage
        if stage is None:
            return
        if isinstance(ask, m.StudyHere):
            stage.here()
        elif isinstance(ask, m.StudyLead):
            stage.lead(ask.referent_mm, ask.velocity_mm_s, ask.near_1_s)
        elif isinstance(ask, m.StudyPush):
            stage.push(ask.force_cN)
        else:
            stage.lift()

    def _sit(self, study: Study, name: str, person: str, code: str) -> None:
        """Go on as somebody; a screen that serves them, or is about to, lets go first."""
        with self._studies.place(name, person):
            other = self._studies.screen(name, person)
            if other:
                study.schedule(person, code)  # a wrong code must not take anybody's screen away
                other.leave("this study goes on at another screen")
            stage = self._stages.first(study)
            self._take(name, Participant.resume(study, person, code, stage), stage)

    def _take(self, name: str, participant: Participant, stage: ScreenStage) -> None:
        self._name, self._participant, self._stage = name, participant, stage
        self._studies.sit(name, participant.person, self)

    def _begin(self, code: str) -> None:
        """Tell a page who sits at it, and where they are."""
        assert self._participant is not None
        self._tell(m.StudyCard(self._participant.person, self._participant.language, code))
        self._tell(m.StudyPaused(self._studies.paused(self._name, self._participant.person)))
        self._tell_step()

    def _heard(self) -> None:
        """Forget the code: the page has it, for it goes on."""
        if self._seat:
            self._studies.taken(self._seat)
            self._seat = None

    def _require_on(self) -> None:
        assert self._participant is not None
        if self._studies.paused(self._name, self._participant.person):
            raise InputError("study", "screen", "the study pauses", "wait a moment")

    def _go_on(self, step: Step) -> None:
        """Tell what comes next; an end is an end for the operator too."""
        self._tell_step(step)
        if self._participant and step.kind in ENDS:
            self._rise()
        else:
            self._studies.announce(self._name)

    def _tell_step(self, step: Step | None = None) -> None:
        participant = self._participant
        if participant:
            now = step or participant.step()
            self._tell(step_told(participant.study.plan, participant.state, participant.language, now))


ASKS = (
    m.StudyLook,
    m.StudySit,
    m.StudyResume,
    m.StudyShown,
    m.StudyGo,
    m.StudyLead,
    m.StudyPush,
    m.StudyLift,
    m.StudyAgain,
    m.StudyAnswered,
    m.StudyFilled,
    m.StudyRested,
    m.StudyWithdraw,
    m.StudyHere,
)
TELLS = (
    m.StudyAbout,
    m.StudyCard,
    m.StudyStep,
    m.StudyReady,
    m.StudyFelt,
    m.StudyFrame,
    m.StudyBroke,
    m.StudyPaused,
    m.StudyStopped,
)
CHANNEL = ChannelKind("study", ASKS, TELLS, StudyScreen)

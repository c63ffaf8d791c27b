"""The participant's screen of a timing study: who is there, and the trial under their hand."""

from __future__ import annotations

from typing import Any, ClassVar

from msgspec import Struct

from fdvv.errors import DeviceError, InputError, ModelError
from fdvv_people.pages.api.play import PlayDown, PlayPing, PlayPong, PlayUp
from fdvv_people.pages.api.study_steps import unnamed_sound
from fdvv_people.pages.participant.messages import StudyBroke
from fdvv_people.pages.participant.seated import SeatedScreen
from fdvv_people.pages.participant.steps import (
    TimingBegin,
    TimingPlaced,
    TimingReady,
    TimingRound,
    TimingStepMessage,
    timing_step_message,
)
from fdvv_people.pages.participant.trial import KeyTrial, OpenTrial, TimedRounds, button_trial
from fdvv_people.pages.play_trials import CLOCK, LiveTrial, Table
from fdvv_people.pages.played_trial import PlayDelay
from fdvv_people.pages.studies import TWIN
from fdvv_people.study.kind import StudyKind
from fdvv_people.study.plan.sitting import Step
from fdvv_people.study.timing.events import Surface
from fdvv_people.study.timing.kind import KIND
from fdvv_people.study.timing.participant import BegunTrial, TimingParticipant
from fdvv_people.study.timing.schedule import TimingFace
from fdvv_studio.live.device_key import DeviceKey
from fdvv_studio.studio.api.press_frames import ShakeSignal
from fdvv_studio.studio.contract import Message, Over, Tell, error_line
from fdvv_studio.studio.studio import Studio


class TimingScreen(SeatedScreen[TimingParticipant]):
    """What serves one page of a timing study: a person, the trial that is open, the device on their table.

    seat : the word of the seat that the page is confined to; empty: to none.
    """

    sitting = TimingParticipant
    kind: ClassVar[StudyKind[Any]] = KIND

    def __init__(self, studio: Studio, tell: Tell, seat: str = "") -> None:
        super().__init__(studio, tell, seat)
        self._table = Table(studio, self._lost)
        self._trial: OpenTrial | None = None
        self._lost_line = ""

    def receive(self, ask: Message) -> None:
        """Do what the page asks; without a participant most asks have come too late and do nothing."""
        trial = self._trial
        match ask:
            case PlayPing():
                self._tell(PlayPong(ask.sent_ms, 1e3 * CLOCK()))
                if isinstance(trial, LiveTrial):
                    trial.run.here()
            case PlayDown() if isinstance(trial, LiveTrial | KeyTrial):
                trial.down(ask.at_ms)
            case PlayUp() if isinstance(trial, LiveTrial):
                trial.up(ask.at_ms)
            case PlayDown() | PlayUp():
                pass
            case _:
                super().receive(ask)

    def message(self, participant: TimingParticipant, step: Step[TimingFace]) -> TimingStepMessage:
        """Return a step as the page gets it."""
        return timing_step_message(participant.study.plan, participant.language, step)

    def put_away(self) -> None:
        """End this beginning of a trial; the trial goes on when it is begun again."""
        trial, self._trial = self._trial, None
        if trial:
            trial.close()

    def go_on(self, ask: Message, participant: TimingParticipant) -> None:
        """Do what a page asks about its trial."""
        trial = self._trial
        match ask:
            case TimingPlaced():
                self.forget_code()
                self.advance(participant.place(ask.number))
            case TimingBegin():
                self.forget_code()
                self.require_running(participant)
                self._open(ask.number, participant)
            case TimingRound() if trial:
                self._keep(ask, trial, participant)

    def _leave_session(self) -> None:
        super()._leave_session()
        self._table.clear()

    def _open(self, number: int, participant: TimingParticipant) -> None:
        """Begin a trial, or go on with it. One whose button cannot be held is given up."""
        self.put_away()
        self._note_loss(participant)
        device = self._studies.device(self._name)
        on = _surface(participant.step(), device)
        key = self._key("" if device == TWIN else device) if on != "table" else None
        begun = participant.begin(number, on)
        rounds = TimedRounds(participant, number, begun.kept)
        try:
            if begun.button is None:
                hand, latency = begun.face.hand, _latency(participant, begun)
                self._trial, signals = KeyTrial(rounds, hand, latency), list[ShakeSignal]()
            else:
                self._trial, subject = button_trial(rounds, begun.button, key, self._hear)
                signals = [unnamed_sound(signal) for signal in subject.signals] if subject else []
        except (InputError, ModelError) as error:
            self.advance(participant.fail(number, error_line(error)))
        except DeviceError as error:
            participant.interrupt(str(error))
            raise
        else:
            self._tell(TimingReady(number, on, begun.attempt, begun.kept, begun.rounds, signals))
            self._studies.announce(self._name)

    def _key(self, device: str) -> DeviceKey | None:
        """Return the key of a device, None of the twin. InputError where there is none, or it is in use."""
        try:
            return self._table.put(device)
        except DeviceError as error:
            raise InputError("study", "device", str(error), "ask who leads the study") from error

    def _keep(self, ask: TimingRound, trial: OpenTrial, participant: TimingParticipant) -> None:
        try:
            kept = trial.keep(ask)
        except DeviceError as error:
            self.put_away()
            participant.interrupt(str(error))
            raise
        if kept.finished:
            self.put_away()
        self._tell(kept)
        if kept.finished:
            self.advance(participant.step())

    def _hear(self, message: Struct) -> None:
        """Pass on what a simulated button tells."""
        if isinstance(message, Over):
            self._lost(message.reason)
        else:
            self._tell(message)

    def _lost(self, line: str) -> None:
        """Note that nothing is rendered any more; the device's own thread must not wait here."""
        self._lost_line = line
        self._tell(StudyBroke())

    def _note_loss(self, participant: TimingParticipant) -> None:
        line, self._lost_line = self._lost_line, ""
        if line:
            participant.interrupt(line)


def _surface(step: Step[TimingFace], device: str) -> Surface:
    if step.trial.hand != "button":
        return "table"
    return "page" if device == TWIN else "device"


def _latency(participant: TimingParticipant, begun: BegunTrial) -> PlayDelay | None:
    """Return what the plan states of a switch or key; None: nothing."""
    stated = participant.study.plan.condition(begun.face.switch)
    if stated.latency_ms is None or stated.latency_error_ms is None:
        return None
    return PlayDelay(stated.latency_ms, stated.latency_error_ms)

"""The participant's screen: labels, and never what hides behind one."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

from msgspec import Meta

from fdvv_people.pages.api.study_steps import (
    StudyFrame,
    StudyReady,
    StudyStages,
    StudyStep,
    step_message,
    unnamed_sound,
)
from fdvv_people.pages.participant.messages import SEATED, SEATING, Short
from fdvv_people.pages.participant.seated import SeatedScreen
from fdvv_people.study.admin.study import Study
from fdvv_people.study.kind import StudyKind
from fdvv_people.study.labels import KIND
from fdvv_people.study.plan.events import TrialFace
from fdvv_people.study.plan.sitting import Step
from fdvv_people.study.plan.trial import TrialAnswer
from fdvv_people.study.session.participant import Participant
from fdvv_people.study.stimulus.open import ScreenRenderer
from fdvv_studio.studio.api.press import Count, Number
from fdvv_studio.studio.contract import ChannelKind, Here, Message, Tell
from fdvv_studio.studio.studio import Studio


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


class StudyAgain(Message, tag="again"):
    """Set up the button that broke."""


class StudyFelt(Message, tag="felt"):
    """A label is under the finger."""

    label: str


class StudyScreen(SeatedScreen[Participant]):
    """What serves one page of a study in which labels are felt and answered.

    seat : the word of the seat that the page is confined to; empty: to none.
    """

    sitting = Participant
    kind: ClassVar[StudyKind[Any]] = KIND

    def __init__(self, studio: Studio, tell: Tell, seat: str = "") -> None:
        super().__init__(studio, tell, seat)
        self._stages = StudyStages(studio, tell)

    def receive(self, ask: Message) -> None:
        """Do what the page asks; without a participant most asks have come too late and do nothing."""
        if isinstance(ask, StudyLead | StudyPush | StudyLift | Here):
            self._move_finger(ask)
        else:
            super().receive(ask)

    @property
    def _stage(self) -> ScreenRenderer | None:
        return next(iter(self._staged), None)

    def prepare(self, study: Study) -> tuple[Any, ...]:
        return (self._stages.first(study),)

    def message(self, participant: Participant, step: Step[TrialFace]) -> StudyStep:
        """Return a step as the page gets it."""
        return step_message(participant.study.plan, participant.language, step)

    def put_away(self) -> None:
        """Let go of the stage; the participant closes it."""
        self._staged = ()

    def lift(self) -> None:
        """Have the finger leave the button."""
        if stage := self._stage:
            stage.lift()

    def go_on(self, ask: Message, participant: Participant) -> None:
        """Do what a page asks about its trial."""
        stage = self._stage
        if stage is None:
            return
        match ask:
            case StudyShown():
                self.forget_code()
                participant.show_trial(ask.number)
                signals = [unnamed_sound(signal) for signal in stage.sounds]
                self._tell(StudyReady(ask.number, stage.travel_mm, signals))
            case ContinueStep():
                self.require_running(participant)
                participant.go_to(ask.label)
                self._tell(StudyFelt(ask.label))
            case StudyAgain():
                self._staged = (self._stages.open(participant.study),)
                participant.reconnect(*self._staged)
                self.tell_step()
            case StudyAnswered():
                self.require_running(participant)
                answer = TrialAnswer(choice=ask.choice, ratings=ask.ratings)
                self.advance(participant.answer(ask.number, answer))

    def _leave_session(self) -> None:
        super()._leave_session()
        self._stages.release()

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


ASKS = (
    *(*SEATING, StudyShown, ContinueStep, StudyLead, StudyPush, StudyLift),
    *(StudyAgain, StudyAnswered, Here),
)
TELLS = (*SEATED, StudyStep, StudyReady, StudyFelt, StudyFrame)
CHANNEL = ChannelKind("study", ASKS, TELLS, StudyScreen, StudyScreen)

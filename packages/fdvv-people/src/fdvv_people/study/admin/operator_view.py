"""What the operator's screen may show of a running study: who is where, and nothing that a label hides.

It is read from plain files only, without a key, so that a screen cannot reveal more.
"""

from __future__ import annotations

from msgspec import Struct, structs

from fdvv.errors import InputError
from fdvv_people.study.files.folder import StudyFolder
from fdvv_people.study.files.layout import PEOPLE, SESSION_FILE
from fdvv_people.study.files.people import Person, PersonState
from fdvv_people.study.plan.plan import StudyPlan
from fdvv_people.study.plan.session import SessionState
from fdvv_people.study.plan.sitting import StepKind
from fdvv_people.study.session.log import read_session


class PersonView(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """The progress of a person.

    Attributes
    ----------
    person, language, simulated, state : see Person. kind, page : of the step that is due; None and "" where
        that is unknown: the session has not started, or was deleted.
    answered, trials : of those that count; of a staircase trials is the most there can be.
    interruptions : of the device. resumptions : of the session.
    problem : why the journal cannot be read; empty if it can.
    """

    person: str
    language: str
    simulated: bool
    state: PersonState
    kind: StepKind | None = None
    page: str = ""
    answered: int = 0
    trials: int = 0
    interruptions: int = 0
    resumptions: int = 0
    problem: str = ""


class OperatorView(Struct, frozen=True, forbid_unknown_fields=True):
    """A study as its operator may see it. planned : how many people should take part."""

    name: str
    fingerprint: str
    planned: int
    people: tuple[PersonView, ...]


def operator_view(study: StudyFolder[StudyPlan], now_s: float) -> OperatorView:
    """Return the progress of everybody, in the order of their enrolment. now_s : wall time.

    InputError on a study that was changed, OSError.
    """
    people = tuple(_person_view(study, person, now_s) for person in study.people())
    return OperatorView(study.plan.name, study.fingerprint, study.plan.people, people)


def _person_view(study: StudyFolder[StudyPlan], person: Person, now_s: float) -> PersonView:
    about = PersonView(
        person=person.name, language=person.language, simulated=person.simulated, state=person.state
    )
    if person.state == "deleted":
        return about
    try:
        state = read_session(study.folder / PEOPLE / person.name / SESSION_FILE, study.plan, SessionState)
    except (InputError, OSError) as error:
        return structs.replace(about, problem=str(error))
    if state is None:
        return about
    step = state.step(now_s)
    counted = [trial.number for trial in state.started.trials if not trial.practice]
    return structs.replace(
        about,
        kind=step.kind,
        page=step.page,
        answered=sum(number in state.answers for number in counted),
        trials=len(counted),
        interruptions=state.interruptions,
        resumptions=state.resumptions,
    )

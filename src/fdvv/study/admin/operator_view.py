"""What the operator's screen may show of a running study: who is where, and nothing that a label hides.

It is read from plain files only, without a key, so that a screen cannot reveal more.
"""

from __future__ import annotations

from msgspec import Struct, structs

from fdvv.errors import InputError
from fdvv.study.files.folder import StudyFolder
from fdvv.study.files.layout import PEOPLE, SESSION_FILE
from fdvv.study.files.people import Person, PersonState
from fdvv.study.plan.session import SessionState, Step, StepKind, next_step
from fdvv.study.session.log import read_session


class PersonView(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """The progress of a person.

    Attributes
    ----------
    person, language, simulated, state : see Person. kind, page, item : of the step that is due; "" where that
        is unknown: the session has not started, or was deleted. trial : which, from 0; -1: none.
    left_s : of a break. answered, trials : of those that count; of a staircase trials is the most there can
        be. progress : see Step.
    again : trials that had to be shown again. skipped : that were given up, for the device went away in them
        again and again. interruptions : of the device. resumptions : of the session.
    open : it was not closed in order since. last_s : when something happened last, seconds since 1970 UTC.
    problem : why the journal cannot be read; empty if it can.
    """

    person: str
    language: str
    simulated: bool
    state: PersonState
    kind: StepKind | None = None
    page: str = ""
    item: str = ""
    trial: int = -1
    left_s: float = 0.0
    answered: int = 0
    trials: int = 0
    progress: float = 0.0
    again: int = 0
    skipped: int = 0
    interruptions: int = 0
    resumptions: int = 0
    open: bool = False
    last_s: float = 0.0
    problem: str = ""


class OperatorView(Struct, frozen=True, forbid_unknown_fields=True):
    """A study as its operator may see it. planned : how many people should take part."""

    name: str
    fingerprint: str
    planned: int
    people: tuple[PersonView, ...]


def operator_view(study: StudyFolder, now_s: float) -> OperatorView:
    """Return the progress of everybody, in the order of their enrolment. now_s : wall time.

    InputError on a study that was changed, OSError.
    """
    people = tuple(_person_view(study, person, now_s) for person in study.people())
    return OperatorView(study.plan.name, study.fingerprint, study.plan.people, people)


def _person_view(study: StudyFolder, person: Person, now_s: float) -> PersonView:
    about = PersonView(
        person=person.name, language=person.language, simulated=person.simulated, state=person.state
    )
    if person.state == "deleted":
        return about
    try:
        state = read_session(study.folder / PEOPLE / person.name / SESSION_FILE, study.plan)
    except (InputError, OSError) as error:
        return structs.replace(about, problem=str(error))
    return about if state is None else _with_state(about, state, next_step(state, now_s))


def _with_state(about: PersonView, state: SessionState, step: Step) -> PersonView:
    counted = [trial.number for trial in state.started.trials if not trial.practice]
    return structs.replace(
        about,
        kind=step.kind,
        page=step.page,
        item=step.item,
        trial=step.number,
        left_s=step.left_s,
        answered=sum(number in state.answers for number in counted),
        trials=len(counted),
        progress=step.progress,
        again=sum(attempts - 1 for attempts in state.attempts.values()),
        skipped=len(state.skipped),
        interruptions=state.interruptions,
        resumptions=state.resumptions,
        open=state.left_s is None,
        last_s=state.last_s,
    )

"""What the operator's screen may show of a running study: who is where, and nothing that a label hides.

It is read from plain files only, with no key: whoever shows it cannot know more.
"""

from __future__ import annotations

from msgspec import Struct

from fdvv.study import SessionState, Step, StepKind, next_step
from fdvv.workflow._participant_log import read_session
from fdvv.workflow._study import Study
from fdvv.workflow._study_files import SESSION_FILE
from fdvv.workflow._study_people import Person, PersonState


class PersonView(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """Where somebody is.

    Attributes
    ----------
    person, language, simulated, state : see Person. kind, page, item : of what they meet now; "" where that
        cannot be told: nothing was begun, or nothing is kept. trial : which, from 0; -1: none.
    left_s : of a break. answered, trials, progress : see Step.
    again : trials that had to be shown again. skipped : that were given up, for the device went away in them
        again and again. interruptions : of the device. resumptions : of the session.
    open : it was not closed in order since. last_s : when something happened last, seconds since 1970 UTC.
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


class OperatorView(Struct, frozen=True, forbid_unknown_fields=True):
    """A study as its operator may see it. planned : how many people should take part."""

    name: str
    fingerprint: str
    planned: int
    people: tuple[PersonView, ...]


def operator_view(study: Study, now_s: float) -> OperatorView:
    """Tell where everybody is. now_s : wall time. InputError on a study that was changed, OSError."""
    people = tuple(_person_view(study, person, now_s) for person in study.people())
    return OperatorView(study.plan.name, study.fingerprint, study.plan.people, people)


def _person_view(study: Study, person: Person, now_s: float) -> PersonView:
    kept = person.state != "deleted"
    path = study.person_folder(person.name) / SESSION_FILE
    state = read_session(path, study.plan) if kept else None
    about = PersonView(
        person=person.name, language=person.language, simulated=person.simulated, state=person.state
    )
    return about if state is None else _with_state(about, state, next_step(state, now_s))


def _with_state(about: PersonView, state: SessionState, step: Step) -> PersonView:
    return PersonView(
        person=about.person,
        language=about.language,
        simulated=about.simulated,
        state=about.state,
        kind=step.kind,
        page=step.page,
        item=step.item,
        trial=step.number,
        left_s=step.left_s,
        answered=step.answered,
        trials=step.trials,
        progress=step.progress,
        again=sum(attempts - 1 for attempts in state.attempts.values()),
        skipped=len(state.skipped),
        interruptions=state.interruptions,
        resumptions=state.resumptions,
        open=state.left_s is None,
        last_s=state.last_s,
    )

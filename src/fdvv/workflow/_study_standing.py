"""How far a study is, from what everybody may read: nothing here tells what a label hid."""

from __future__ import annotations

from dataclasses import dataclass

from fdvv.errors import InputError
from fdvv.workflow._participant_log import read_session
from fdvv.workflow._study import Study
from fdvv.workflow._study_files import SESSION_FILE
from fdvv.workflow._study_people import Person


@dataclass(frozen=True)
class PersonStanding:
    """How far somebody is.

    Attributes
    ----------
    answered, trials : of those that count; of a staircase trials is the most there can be.
    resumed, interrupted : how often. problem : why their log cannot be read; empty if it can.
    """

    person: Person
    answered: int = 0
    trials: int = 0
    resumed: int = 0
    interrupted: int = 0
    problem: str = ""


def people_standing(study: Study) -> tuple[PersonStanding, ...]:
    """Tell how far everybody is, in the order of their enrolment. InputError on a changed plan."""
    return tuple(_standing(study, person) for person in study.people())


def _standing(study: Study, person: Person) -> PersonStanding:
    if person.state == "deleted":
        return PersonStanding(person)
    path = study.person_folder(person.name) / SESSION_FILE
    try:
        state = read_session(path, study.plan)
    except (InputError, OSError) as error:
        return PersonStanding(person, problem=str(error))
    if state is None:
        return PersonStanding(person)
    counted = [trial.number for trial in state.began.trials if not trial.practice]
    answered = sum(number in state.answers for number in counted)
    return PersonStanding(person, answered, len(counted), state.resumptions, state.interruptions)

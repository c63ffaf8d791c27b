"""The operator's page: people and their progress, and never what a label hides."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Annotated, Any

from msgspec import Meta, field

from fdvv.errors import FdvvError
from fdvv_people.pages.api.study_steps import text_in
from fdvv_people.pages.studies import Studies, StudiesChanged, StudyState, state_of
from fdvv_people.study.admin.progress import Kind, PersonProgress, standing, study_progress
from fdvv_people.study.admin.study import Study
from fdvv_people.study.files.counts import COUNTED
from fdvv_people.study.files.people import EVERYBODY
from fdvv_studio.studio.contract import Empty, Message, call, error_line, watch_channel

Name = Annotated[str, Meta(max_length=60)]


class StudiesRow(Message):
    """A study in short. problem : why it cannot be read; empty if it can."""

    name: str
    title: str
    kind: str
    state: StudyState
    people: int
    planned: int
    problem: str


class StudiesRows(Message):
    """All studies by name."""

    rows: list[StudiesRow]


class StudiesAsk(Message):
    """Name a study."""

    study: Name


class StudiesPerson(Message):
    """A person's progress. here : at a screen now. answered, trials : that count. note : may be empty."""

    person: str
    language: str
    state: str
    answered: int
    trials: int
    here: bool
    paused: bool
    note: str = field(name="told")


class StudiesDetail(Message):
    """A study for the operator.

    history : what was done with it, one line each. waiting : open invitations.
    device : what renders it, one of `studies.devices`.
    open : people can begin and come back; else the key holder opens the sessions first.
    code_alone : people whose code alone opens the blind, for an earlier fdvv enrolled them.
    """

    row: StudiesRow
    fingerprint: str
    frozen: str
    people: list[StudiesPerson]
    waiting: int
    paused: bool
    history: list[str]
    device: str
    open: bool
    code_alone: list[str]


class StudiesStanding(Message):
    """How far a study is, or what it found, in a sentence."""

    sentence: str
    kind: Kind


SIMULATED = "simulated"


def study_row(name: str, study: Study) -> StudiesRow:
    plan = study.plan
    title = text_in(plan.title, plan.languages[0])
    return StudiesRow(name, title, plan.kind, state_of(study), len(study.people()), plan.people, "")


@call("studies.detail")
def detail(studies: Studies, ask: StudiesAsk) -> StudiesDetail:
    return study_detail(studies, ask.study)


def study_detail(studies: Studies, name: str) -> StudiesDetail:
    study = studies.study(name)
    frozen = study.frozen
    paused = study.paused
    return StudiesDetail(
        study_row(name, study),
        study.fingerprint,
        when(frozen.when) if frozen else "",
        _people(studies, name, study) if frozen else [],
        studies.seats.waiting(name),
        EVERYBODY in paused,
        [history_line(record) for record in study.history() if COUNTED not in record],
        studies.device(name),
        frozen is not None and (study.sessions_open or not study.needs_run_key),
        list(study.code_alone) if frozen else [],
    )


def _people(studies: Studies, name: str, study: Study) -> list[StudiesPerson]:
    paused = study.paused
    here = {one.name for one in study.people() if studies.screens.find(name, one.name)}
    people = study_progress(study, time.time())
    return [_person(one, one.person in here, one.person in paused) for one in people]


def history_line(record: Mapping[str, Any]) -> str:
    """Return a record of a study's log as one line, without keys and sums."""
    ((event, details),) = record.items()
    known = ("person", "language", "who", "why", "simulated", "deleted")
    more = ", ".join(f"{key} {details[key]}" for key in known if details.get(key))
    return f"{when(details.get('when', ''))} {event}{': ' if more else ''}{more}".strip()


def when(stamp: str) -> str:
    """Write a time of the log for people, to the minute."""
    return f"{stamp[:16].replace('T', ' ')} UTC" if stamp else ""


def _person(one: PersonProgress, here: bool, paused: bool) -> StudiesPerson:
    note = SIMULATED if one.simulated else ""
    return StudiesPerson(one.person, one.language, one.place, one.done, one.trials, here, paused, note)


@call("studies.list")
def rows(studies: Studies, _ask: Empty) -> StudiesRows:
    return StudiesRows([_row(studies, name) for name in studies.names()])


def _row(studies: Studies, name: str) -> StudiesRow:
    try:
        return study_row(name, studies.study(name))
    except FdvvError as error:
        return StudiesRow(name, name, "", "broken", 0, 0, error_line(error))


@call("studies.standing")
def study_standing(studies: Studies, ask: StudiesAsk) -> StudiesStanding:
    return StudiesStanding(*standing(studies.study(ask.study)))


CHANNEL = watch_channel("studies", Studies, StudiesChanged)

"""From what a study's folder holds to what the operator is told: people and how far, labels never."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any

from fdvv.plot import Section
from fdvv.studio import _messages_studies as m
from fdvv.studio._studies import TWIN, Studies, state_of
from fdvv.studio._study_told import said
from fdvv.studio._work_choices import devices
from fdvv.workflow import EVERYBODY, PersonView, Study, operator_view

SIMULATED = "simulated"
ON_THE_TABLE = ("host", "serial:")
"""How devices are called that keep the labels of a trial ready side by side."""


def row(name: str, study: Study) -> m.StudiesRow:
    """Tell a study in short."""
    plan = study.plan
    title = said(plan.title, plan.languages[0])
    return m.StudiesRow(name, title, plan.kind, state_of(study), len(study.people()), plan.people, "")


def broken(name: str, reason: str) -> m.StudiesRow:
    """Tell a study that cannot be read."""
    return m.StudiesRow(name, name, "", "broken", 0, 0, reason)


def detail(studies: Studies, name: str) -> m.StudiesDetail:
    """Tell a study and its people."""
    study = studies.study(name)
    frozen = study.frozen
    people = operator_view(study, time.time()).people if frozen else ()
    paused = study.paused
    return m.StudiesDetail(
        row(name, study),
        study.fingerprint,
        when(frozen.when) if frozen else "",
        [_person(one, studies.screen(name, one.person) is not None, one.person in paused) for one in people],
        studies.waiting(name),
        EVERYBODY in paused,
        [history_line(record) for record in study.history()],
        studies.device(name),
    )


def all_devices() -> list[m.StudiesDevice]:
    """List what may render a study: the twin, and what keeps the labels of a trial ready side by side."""
    return [
        m.StudiesDevice(TWIN, "the twin, under a hand on the screen"),
        *(
            m.StudiesDevice(name, f"{name}: {about}" if about else name)
            for name, about in devices()[0]
            if name.startswith(ON_THE_TABLE)
        ),
    ]


def section(one: Section) -> m.StudiesSection:
    """Tell a part of a preview."""
    tables = [m.StudiesTable(list(table.columns), [list(row) for row in table.rows]) for table in one.tables]
    return m.StudiesSection(one.title, list(one.paragraphs), tables)


def history_line(record: Mapping[str, Any]) -> str:
    """Tell a record of a study's log in a line; keys and sums are for machines."""
    ((event, told),) = record.items()
    known = ("person", "language", "who", "why", "simulated", "deleted")
    more = ", ".join(f"{key} {told[key]}" for key in known if told.get(key))
    return f"{when(told.get('when', ''))} {event}{': ' if more else ''}{more}".strip()


def when(stamp: str) -> str:
    """Write a time of the log for people, to the minute."""
    return f"{stamp[:16].replace('T', ' ')} UTC" if stamp else ""


def _person(one: PersonView, here: bool, paused: bool) -> m.StudiesPerson:
    return m.StudiesPerson(
        one.person,
        one.language,
        place_of(one),
        one.answered,
        one.trials,
        here,
        paused,
        SIMULATED if one.simulated else "",
    )


def place_of(one: PersonView) -> str:
    """Tell in a word where somebody is."""
    if one.problem:
        return "not to be read"
    if one.state in ("withdrawn", "deleted"):
        return one.state
    return f"page {one.page}" if one.kind == "page" else (one.kind or one.state)

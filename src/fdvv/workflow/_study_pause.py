"""Pauses of a study, as its log tells them: who led it put them in force, and they outlive every crash."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from fdvv.workflow._session_manifest import now
from fdvv.workflow._study_log import ChainedLog
from fdvv.workflow._study_people import no_person, people_of

PAUSED, CONTINUED = "paused", "continued"
EVERYBODY = ""
"""Name in a pause of all."""


def paused_of(records: Iterable[Mapping[str, Any]]) -> frozenset[str]:
    """Give whom a study's log tells to be paused; `EVERYBODY` among them for all."""
    found = set[str]()
    for record in records:
        for event, change in ((PAUSED, found.add), (CONTINUED, found.discard)):
            if event in record:
                change(record[event].get("person", EVERYBODY))
    return frozenset(found)


def pause_person(log: ChainedLog, person: str, on: bool) -> None:
    """Have somebody wait, or go on; what is so already is not written again. log : of the study, open.

    person : `EVERYBODY` for all. InputError on somebody who is not in the study.
    """
    people = people_of(log.records)
    if person != EVERYBODY and all(one.name != person for one in people):
        raise no_person(person, people)
    if on != (person in paused_of(log.records)):
        about = {"person": person} if person != EVERYBODY else {}
        log.write({PAUSED if on else CONTINUED: {"when": now(), **about}})

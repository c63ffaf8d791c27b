"""People of a study, opened by the key holder: what was drawn for them, what they did, what was rendered."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec

from fdvv.errors import InputError, ModelError
from fdvv_people.study.files.chained_log import read_chained
from fdvv_people.study.files.layout import COUNTS_FILE, PEOPLE, SCHEDULE_FILE, SEALED_FILE, SESSION_FILE
from fdvv_people.study.files.people import Person, Schedule, SealedTrial, open_schedule
from fdvv_people.study.files.seal import KeyHolder
from fdvv_people.study.plan.events import PageAnswered, SessionEvent
from fdvv_people.study.plan.sitting import SittingState

CHANGED = "the person's files were changed"


@dataclass(frozen=True)
class OpenedPerson:
    """A person, opened. **Secret.**

    Attributes
    ----------
    events : of their session, as far as its log is whole. rendered : by number of the trial.
    changed : their files are not as they were written, so that nothing of them counts.
    """

    person: Person
    schedule: Schedule
    events: Sequence[SessionEvent]
    rendered: Mapping[int, SealedTrial]
    changed: bool


def open_people(
    folder: Path,
    people: Sequence[Person],
    keeper: KeyHolder,
    problems: Sequence[str],
    kind: type[SittingState[Any]],
) -> Iterator[OpenedPerson]:
    """Open everybody of whom something is kept, and whose schedule is there to be read.

    problems : of the study, a line each. kind : of its sessions. InputError on a record that no fdvv of this
    kind wrote.
    """
    suspects = _suspects(problems, people)
    for person in people:
        own = folder / PEOPLE / person.name
        try:
            schedule = None if person.state == "deleted" else open_schedule(own / SCHEDULE_FILE, keeper)
        except InputError:
            continue  # reported by verify, and on record
        if schedule:
            session, sealed = (
                read_chained(own / name, bytes.fromhex(schedule.key)) for name in (SESSION_FILE, SEALED_FILE)
            )
            yield OpenedPerson(
                person,
                schedule,
                _events(person, session.records, kind),
                _open_boxes(person, sealed.records, keeper),
                person.name in suspects or bool(session.problems or sealed.problems),
            )


def _events(
    person: Person, records: Iterable[dict[str, Any]], kind: type[SittingState[Any]]
) -> list[SessionEvent]:
    try:
        return [kind.event_of(record) for record in records]
    except ModelError as error:
        raise InputError(person.name, "session", str(error), "install the fdvv that ran the study") from error


def _open_boxes(
    person: Person, records: Iterable[dict[str, Any]], keeper: KeyHolder
) -> dict[int, SealedTrial]:
    """Return what was rendered, by number of the trial; of those of one number the last one counts."""
    boxes = (keeper.unlock(record["sealed"], f"{person.name}/{SEALED_FILE}") for record in records)
    trials = (msgspec.json.decode(box, type=SealedTrial) for box in boxes)
    return {trial.number: trial for trial in trials}


def _suspects(problems: Sequence[str], people: Sequence[Person]) -> set[str]:
    """Return the people whose files something is wrong with; where the counts are wrong, everybody."""
    if any(line.startswith(f"{COUNTS_FILE}:") for line in problems):
        return {person.name for person in people}
    return {one.name for one in people if any(line.startswith(f"{PEOPLE}/{one.name}/") for line in problems)}


def page_rows(people: Iterable[OpenedPerson]) -> Iterator[Sequence[object]]:
    """Yield what people answered on pages, by person, page, question and answer."""
    for one in people:
        for page in one.events:
            if isinstance(page, PageAnswered):
                for question, value in page.values.items():
                    yield one.person.name, page.name, question, "" if value is None else value

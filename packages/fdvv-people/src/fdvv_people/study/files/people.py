"""People of a study: their state and pauses in the study's log, their locked schedules, their folders."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Literal

import msgspec
from msgspec import Struct

from fdvv.errors import InputError
from fdvv.io.documents import Kind, pretty
from fdvv.io.files import private_folder, sync_folder, write_atomic
from fdvv.rendering.session import now
from fdvv_people.study.files.chained_log import ChainedLog
from fdvv_people.study.files.layout import (
    LOG_FILE,
    REMEDY,
    SCHEDULE_FILE,
    SEALED_FILE,
    SESSION_FILE,
    content,
    read_record,
)
from fdvv_people.study.files.log_head import LogHead
from fdvv_people.study.files.run_key import CLOSED, OPEN_FIRST, RunKey
from fdvv_people.study.files.seal import (
    CODE_COST,
    Cost,
    KeyHolder,
    SealingKey,
    lock_with_code,
    unlock_with_code,
)
from fdvv_people.study.plan.trial import Rendered, StudyTrial

PersonState = Literal["enrolled", "finished", "withdrawn", "deleted"]
SCHEDULE = Kind("fdvv-schedule", 2, "a locked schedule", REMEDY, oldest=1)
STEP_bytes = 1024
PAUSED, CONTINUED = "paused", "continued"
EVERYBODY = ""
"""Name in a pause of all."""


class Person(Struct, frozen=True):
    """A person who takes part, without anything secret.

    Attributes
    ----------
    name : P01, P02, ... place : 0, 1, ...: which orders of items; the place of a person who
        withdrew is given to the next one. simulated : it is a simulated participant.
    schedule : SHA-256 of the locked schedule.
    state : withdrawn: what was given until then is kept; deleted: it is not.
    """

    name: str
    language: str
    place: int
    simulated: bool
    when: str
    schedule: str
    state: PersonState = "enrolled"


class Schedule(Struct, frozen=True, forbid_unknown_fields=True):
    """All trials of a person. **Secret.**

    Attributes
    ----------
    study : SHA-256 of frozen.json. key : hexadecimal, marks the lines of the person's logs.
    """

    study: str
    person: str
    key: str
    trials: tuple[StudyTrial, ...]


class SealedTrial(Struct, frozen=True, forbid_unknown_fields=True):
    """What was rendered in a trial. ratio : of its staircase there. change : of thresholds."""

    number: int
    ratio: float
    rendered: tuple[Rendered, ...]
    change: tuple[float, ...] = ()


class LockedSchedule(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """Content of schedule.json: the schedule locked for the key holder, and for the person's sessions.

    Attributes
    ----------
    version : 1: a code alone unlocks it. 2: the code and the study's run key do.
    mark : of version 2: nobody without the run key has made this file.
    """

    format: Literal["fdvv-schedule"] = "fdvv-schedule"
    version: Literal[1, 2]
    person: str
    sealed: str
    locked: str
    mark: str = ""

    @property
    def text(self) -> str:
        fields = msgspec.to_builtins(self)
        if self.version == 1:
            del fields["mark"]
        return pretty(fields) + "\n"

    def made_with(self, run_key: RunKey) -> bool:
        """Whether the run key made this file; of version 1 nobody knows."""
        return self.version == 1 or run_key.made(self.mark, msgspec.structs.replace(self, mark="").text)


def people_of(records: Iterable[Mapping[str, Any]]) -> tuple[Person, ...]:
    """Return the people in a study's log, in the order of their enrolment.

    InputError on an unknown record.
    """
    found: dict[str, Person] = {}
    for number, record in enumerate(records, 1):
        try:
            _take(record, found)
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise InputError(LOG_FILE, f"record {number}", "is none of a study", REMEDY) from error
    return tuple(found.values())


def _take(record: Mapping[str, Any], found: dict[str, Person]) -> None:
    ((event, body),) = record.items()
    if event == "enrolled":
        fields = {"name": body["person"], **{k: v for k, v in body.items() if k != "person"}}
        found[body["person"]] = msgspec.convert(fields, Person)
    elif event in ("finished", "withdrawn"):
        person = found[body["person"]]
        state = "deleted" if body.get("deleted") else event
        found[person.name] = msgspec.structs.replace(person, state=state)


def free_place(people: Iterable[Person]) -> int:
    """Return the first place that is not taken by a person who is still in the study."""
    taken = {person.place for person in people if person.state in ("enrolled", "finished")}
    return next(place for place in range(len(taken) + 1) if place not in taken)


def lock_schedule(
    schedule: Schedule, seal: SealingKey, code: str, cost: Cost = CODE_COST, run_key: RunKey | None = None
) -> str:
    """Return the text of schedule.json: the schedule locked for the key holder and for the person's sessions.

    run_key : that their code opens it with; None, of simulated people: their code alone opens it.
    """
    data, room = msgspec.json.encode(schedule), room_bytes(schedule)
    found = LockedSchedule(
        version=2 if run_key else 1,
        person=schedule.person,
        sealed=seal.lock(data, room),
        locked=lock_with_code(data, code, room, cost, run_key),
    )
    return (msgspec.structs.replace(found, mark=run_key.mark(found.text)) if run_key else found).text


def room_bytes(schedule: Schedule) -> int:
    """Return a length that any schedule of the plan fits in: every label may hide the longest name.

    So it depends on what everybody knows, and not on what was drawn.
    """
    names = {name for trial in schedule.trials for name in trial.labels.values()}
    longest = max(names, key=lambda name: len(msgspec.json.encode(name)), default="")
    public = msgspec.structs.replace(
        schedule,
        trials=tuple(
            msgspec.structs.replace(trial, labels=dict.fromkeys(trial.labels, longest), correct="A")
            for trial in schedule.trials
        ),
    )
    # locking puts the length before the data, in four bytes
    whole = len(msgspec.json.encode(public)) + 4
    return whole + -whole % STEP_bytes


def read_locked(path: Path) -> LockedSchedule:
    """Read a locked schedule. InputError."""
    return read_record(content(path), path, SCHEDULE, LockedSchedule)


def open_schedule(path: Path, key: str | KeyHolder, run_key: RunKey | None = None) -> Schedule:
    """Open a schedule with its person's code and the run key, or with the key holder's key.

    InputError on a wrong code, where the run key is needed and not there, on a file made without it.
    """
    found = read_locked(path)
    run_key = key.run_key if isinstance(key, KeyHolder) else run_key
    if found.version > 1 and run_key is None:
        raise InputError("study", "sessions", CLOSED, OPEN_FIRST)
    if run_key and not found.made_with(run_key):
        raise InputError(path, "mark", "was made without the key of this study", REMEDY)
    if isinstance(key, KeyHolder):
        return msgspec.json.decode(key.unlock(found.sealed, path), type=Schedule)
    opened = unlock_with_code(found.locked, key, path, run_key if found.version > 1 else None)
    return msgspec.json.decode(opened, type=Schedule)


def person_of(records: Iterable[Mapping[str, Any]], name: str) -> Person:
    """Return a person in a study's log. InputError, which lists who is in it."""
    people = {person.name: person for person in people_of(records)}
    if name not in people:
        known = ", ".join(people) or "nobody yet"
        raise InputError(name, "person", "is not in this study", f"name one of: {known}")
    return people[name]


def paused_of(records: Iterable[Mapping[str, Any]]) -> frozenset[str]:
    """Return the people whom a study's log has paused; `EVERYBODY` among them for all."""
    found = set[str]()
    for record in records:
        for event, change in ((PAUSED, found.add), (CONTINUED, found.discard)):
            if event in record:
                change(record[event].get("person", EVERYBODY))
    return frozenset(found)


def pause_person(log: ChainedLog, person: str, on: bool) -> None:
    """Pause or continue a person; a state that holds already is not logged again. log : of the study, open.

    person : `EVERYBODY` for all. InputError on a person who is not in the study.
    """
    if person != EVERYBODY:
        person_of(log.records, person)
    if on != (person in paused_of(log.records)):
        about = {"person": person} if person != EVERYBODY else {}
        log.write({PAUSED if on else CONTINUED: {"when": now(), **about}})


def keep_person(folder: Path, schedule: Schedule, text: str, consent: str) -> dict[str, LogHead]:
    """Make the folder of a person, whole or not at all: the locked schedule and two empty logs.

    Returns where the logs end, by file.
    """
    building = folder.with_name(f".{schedule.person}.new")
    for left in (building, folder):  # of an enrolment that was killed before it was logged
        shutil.rmtree(left, ignore_errors=True)
    private_folder(folder.parent)
    write_atomic(building / SCHEDULE_FILE, text, private=True)
    logs: dict[str, Mapping[str, str]] = {
        SESSION_FILE: {"log": "session", "consent": consent},
        SEALED_FILE: {"log": "sealed"},
    }
    heads = {}
    for name, own in logs.items():
        about = {"study": schedule.study, "person": schedule.person, **own}
        with ChainedLog.create(building / name, about, bytes.fromhex(schedule.key)) as log:
            heads[name] = log.head
    building.replace(folder)
    sync_folder(folder.parent)
    return heads


def wipe(folder: Path) -> None:
    """Overwrite every file below a folder, and remove them all; nothing if it is not there. OSError."""
    if not folder.exists():
        return
    for path in folder.rglob("*"):
        if path.is_file() and not path.is_symlink():
            with path.open("r+b") as stream:
                stream.write(bytes(path.stat().st_size))
                stream.flush()
                os.fsync(stream.fileno())
    shutil.rmtree(folder)
    sync_folder(folder.parent)

"""People of a study: their standing as the study's log tells it, and their locked schedules."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Literal

import msgspec
from msgspec import Struct

from fdvv.documents import Kind, pretty, read_document
from fdvv.errors import InputError
from fdvv.files import read_limited
from fdvv.study import Rendered, StudyTrial
from fdvv.workflow._study_files import LOG_FILE, REMEDY, LARGEST_bytes
from fdvv.workflow._study_seal import CODE_COST, Cost, Keeper, Seal, lock_with_code, unlock_with_code

PersonState = Literal["enrolled", "finished", "withdrawn", "deleted"]
SCHEDULE = Kind("fdvv-schedule", 1, "a locked schedule", REMEDY)
STEP_bytes = 1024


class Person(Struct, frozen=True):
    """Somebody who takes part, as everybody may know it.

    Attributes
    ----------
    name : P01, P02, ... place : 0, 1, ...: which orders of items; who comes for somebody that withdrew takes
        that place. simulated : it is a simulated participant. schedule : SHA-256 of the locked schedule.
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
    """What was rendered in a trial, as it is sealed. ratio : that a staircase had there."""

    number: int
    ratio: float
    rendered: tuple[Rendered, ...]


class LockedSchedule(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """What schedule.json holds: a schedule for the keeper, and for who has the person's code."""

    format: Literal["fdvv-schedule"] = "fdvv-schedule"
    version: Literal[1] = 1
    person: str
    sealed: str
    locked: str


def people_of(records: Iterable[Mapping[str, Any]]) -> tuple[Person, ...]:
    """Give the people that a study's log tells of, in the order of their enrolment.

    InputError on a record that no study writes.
    """
    found: dict[str, Person] = {}
    for number, record in enumerate(records, 1):
        try:
            _take(record, found)
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise InputError(LOG_FILE, f"record {number}", "is none of a study", REMEDY) from error
    return tuple(found.values())


def _take(record: Mapping[str, Any], found: dict[str, Person]) -> None:
    ((event, told),) = record.items()
    if event == "enrolled":
        fields = {"name": told["person"], **{k: v for k, v in told.items() if k != "person"}}
        found[told["person"]] = msgspec.convert(fields, Person)
    elif event in ("finished", "withdrawn"):
        person = found[told["person"]]
        state = "deleted" if told.get("deleted") else event
        found[person.name] = msgspec.structs.replace(person, state=state)


def free_place(people: Iterable[Person]) -> int:
    """Give the first place that nobody has who is still in the study."""
    taken = {person.place for person in people if person.state in ("enrolled", "finished")}
    return next(place for place in range(len(taken) + 1) if place not in taken)


def lock_schedule(schedule: Schedule, seal: Seal, code: str, cost: Cost = CODE_COST) -> str:
    """Lock a schedule both ways, as schedule.json holds it."""
    data, room = msgspec.json.encode(schedule), room_bytes(schedule)
    return (
        pretty(
            msgspec.to_builtins(
                LockedSchedule(
                    person=schedule.person,
                    sealed=seal.lock(data, room),
                    locked=lock_with_code(data, code, room, cost),
                )
            )
        )
        + "\n"
    )


def room_bytes(schedule: Schedule) -> int:
    """Give a length that any schedule of the plan fits in: every label may hide the longest name.

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
    whole = len(msgspec.json.encode(public)) + 4
    return whole + -whole % STEP_bytes


def read_locked(path: Path) -> LockedSchedule:
    """Read a locked schedule. InputError."""
    data = read_limited(path, LARGEST_bytes, REMEDY)
    return read_document(data, path, SCHEDULE, msgspec.json.Decoder(LockedSchedule).decode, lambda _: None)


def open_with_code(path: Path, code: str) -> Schedule:
    """Open a schedule with its person's code. InputError on a wrong one."""
    return msgspec.json.decode(unlock_with_code(read_locked(path).locked, code, path), type=Schedule)


def open_with_keeper(path: Path, keeper: Keeper) -> Schedule:
    """Open a schedule with the keeper's key. InputError."""
    return msgspec.json.decode(keeper.unlock(read_locked(path).sealed, path), type=Schedule)


def no_person(name: str, people: Iterable[Person]) -> InputError:
    """Make the error that says who there is."""
    known = ", ".join(person.name for person in people) or "nobody yet"
    return InputError(name, "person", "is not in this study", f"name one of: {known}")

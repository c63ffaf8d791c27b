"""Enrol people, their schedules locked for their codes and the key holder, and withdraw them."""

from __future__ import annotations

import os
import secrets
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fdvv.errors import InputError
from fdvv.eventlog import Journal
from fdvv.io.files import sync_folder, write_atomic
from fdvv.rendering.session import now
from fdvv.study.files.chained_log import ChainedLog
from fdvv.study.files.layout import PEOPLE, SCHEDULE_FILE, SEALED_FILE, SESSION_FILE, UNSEALED, digest
from fdvv.study.files.people import Person, Schedule, free_place, lock_schedule, no_person, people_of
from fdvv.study.files.seal import Cost, SealingKey, new_code
from fdvv.study.plan.plan import StudyPlan
from fdvv.study.plan.schedule import draw_schedule


@dataclass(frozen=True)
class Enrolment:
    """A person to be enrolled; see `Study.enrol`."""

    language: str
    consent: str = ""
    simulated: bool = False


def enrol_person(
    folder: Path, plan: StudyPlan, seal: SealingKey, log: ChainedLog, enrolment: Enrolment, cost: Cost
) -> tuple[str, str]:
    """Enrol a person; return their name and code. log : of the study, open. InputError, OSError."""
    people = people_of(log.records)
    _check(folder, log.records, people, enrolment.simulated)
    person, place = f"P{len(people) + 1:02d}", free_place(people)
    # seeded by the operating system, anew for everybody: one schedule must not predict the next
    trials = draw_schedule(plan, place, np.random.default_rng())
    schedule, code = Schedule(log.about["study"], person, secrets.token_hex(32), trials), new_code()
    text = lock_schedule(schedule, seal, code, cost)
    _keep(folder / PEOPLE / person, schedule, text, enrolment.consent)
    about = {"language": enrolment.language, "place": place, "simulated": enrolment.simulated}
    log.write({"enrolled": {"person": person, **about, "when": now(), "schedule": digest(text)}})
    return person, code


def _check(
    folder: Path, records: Sequence[Mapping[str, Any]], people: Sequence[Person], simulated: bool
) -> None:
    if any("unsealed" in record for record in records):
        reason = "was unsealed, nobody can begin it any more"
        raise InputError(folder, "study", reason, "declare a new study")
    if any(person.simulated != simulated for person in people):
        reason = "has people and cannot have simulated ones" if simulated else "has simulated people only"
        raise InputError(folder, "study", reason, "declare another study for them")


def _keep(folder: Path, schedule: Schedule, text: str, consent: str) -> None:
    building = folder.with_name(f".{schedule.person}.new")
    for left in (building, folder):  # of an enrolment that was killed before it was logged
        shutil.rmtree(left, ignore_errors=True)
    key = bytes.fromhex(schedule.key)
    write_atomic(building / SCHEDULE_FILE, text)
    about = {"study": schedule.study, "person": schedule.person}
    ChainedLog.create(building / SESSION_FILE, {**about, "log": "session", "consent": consent}, key).close()
    ChainedLog.create(building / SEALED_FILE, {**about, "log": "sealed"}, key).close()
    building.replace(folder)
    sync_folder(folder.parent)


def withdraw_person(folder: Path, log: ChainedLog, name: str, delete: bool) -> None:
    """Withdraw a person; see `Study.withdraw`. log : of the study, open."""
    people = people_of(log.records)
    person = next((person for person in people if person.name == name), None)
    if person is None:
        raise no_person(name, people)
    own = folder / PEOPLE / name
    session = own / SESSION_FILE
    if session.exists():
        remedy = "have them press withdraw, or close their screen"
        Journal(session, InputError(name, "person", "is in the study at this moment", remedy)).close()
    if person.state != "deleted" and (delete or person.state != "withdrawn"):
        # first on record: a process that is killed in between leaves files that verify reports
        log.write({"withdrawn": {"when": now(), "person": name, "deleted": delete}})
    if delete:
        for residue in (own, folder / UNSEALED):
            wipe(residue)


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

"""Enrolment: a whole schedule is drawn in memory, and written for its person's code and the keeper only."""

from __future__ import annotations

import secrets
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fdvv.errors import InputError
from fdvv.files import sync_folder, write_atomic
from fdvv.study import StudyPlan, draw_schedule
from fdvv.workflow._session_manifest import now
from fdvv.workflow._study_files import PEOPLE, SCHEDULE_FILE, SEALED_FILE, SESSION_FILE, digest
from fdvv.workflow._study_log import ChainedLog
from fdvv.workflow._study_people import Person, Schedule, free_place, lock_schedule, people_of
from fdvv.workflow._study_seal import Cost, Seal, new_code


@dataclass(frozen=True)
class Newcomer:
    """Who is to be enrolled; see `Study.enrol`."""

    language: str
    consent: str = ""
    simulated: bool = False


def enrol_person(
    folder: Path, plan: StudyPlan, seal: Seal, log: ChainedLog, newcomer: Newcomer, cost: Cost
) -> tuple[str, str]:
    """Take somebody in; give their name and their code. log : of the study, open. InputError, OSError."""
    people = people_of(log.records)
    _check(folder, log.records, people, newcomer.simulated)
    person, place = f"P{len(people) + 1:02d}", free_place(people)
    # drawn from what the operating system holds random, anew for everybody
    trials = draw_schedule(plan, place, np.random.default_rng())
    schedule, code = Schedule(log.about["study"], person, secrets.token_hex(32), trials), new_code()
    text = lock_schedule(schedule, seal, code, cost)
    _keep(folder / PEOPLE / person, schedule, text, newcomer.consent)
    told = {"person": person, "language": newcomer.language, "place": place, "simulated": newcomer.simulated}
    log.write({"enrolled": {**told, "when": now(), "schedule": digest(text)}})
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
    """Write somebody's files; the folder appears with all of them or not at all."""
    building = folder.with_name(f".{schedule.person}.new")
    for left in (building, folder):  # of an enrolment that was killed before it was told
        shutil.rmtree(left, ignore_errors=True)
    key = bytes.fromhex(schedule.key)
    write_atomic(building / SCHEDULE_FILE, text)
    about = {"study": schedule.study, "person": schedule.person}
    ChainedLog.create(building / SESSION_FILE, {**about, "log": "session", "consent": consent}, key).close()
    ChainedLog.create(building / SEALED_FILE, {**about, "log": "sealed"}, key).close()
    building.replace(folder)
    sync_folder(folder.parent)

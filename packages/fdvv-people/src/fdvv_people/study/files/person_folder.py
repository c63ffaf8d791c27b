"""The folder of a person in a study: made whole, and removed whole."""

from __future__ import annotations

import os
import shutil
from collections.abc import Mapping
from pathlib import Path

from fdvv.io.files import private_folder, sync_folder, write_atomic
from fdvv_people.study.files.chained_log import ChainedLog
from fdvv_people.study.files.layout import SCHEDULE_FILE, SEALED_FILE, SESSION_FILE
from fdvv_people.study.files.log_head import LogHead
from fdvv_people.study.files.people import Schedule


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

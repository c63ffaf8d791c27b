"""Withdrawal: what is kept of a person is deleted for good; that they were there stays on record."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

from fdvv.errors import InputError
from fdvv.files import sync_folder
from fdvv.journal import Journal
from fdvv.workflow._session_manifest import now
from fdvv.workflow._study_files import PEOPLE, SESSION_FILE, UNSEALED
from fdvv.workflow._study_log import ChainedLog
from fdvv.workflow._study_people import no_person, people_of


def withdraw_person(folder: Path, log: ChainedLog, name: str, delete: bool) -> None:
    """Take somebody out of a study; see `Study.withdraw`. log : of the study, open."""
    people = people_of(log.records)
    person = next((person for person in people if person.name == name), None)
    if person is None:
        raise no_person(name, people)
    own = folder / PEOPLE / name
    _let_alone(own / SESSION_FILE, name)
    if person.state != "deleted" and (delete or person.state != "withdrawn"):
        # first on record: a process that is killed in between leaves files that verify tells of
        log.write({"withdrawn": {"when": now(), "person": name, "deleted": delete}})
    if delete:
        for residue in (own, folder / UNSEALED):
            wipe(residue)


def _let_alone(session: Path, name: str) -> None:
    """See that nobody works in a session now. InputError."""
    if session.exists():
        remedy = "have them press withdraw, or close their screen"
        Journal(session, InputError(name, "person", "is in the study at this moment", remedy)).close()


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

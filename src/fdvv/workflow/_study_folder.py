"""What a study in a folder is, as its files tell; nothing here changes one."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from fdvv.errors import InputError
from fdvv.files import read_limited
from fdvv.study import STUDY_FILE, StudyPlan, read_plan_text
from fdvv.workflow._study_chain import read_chained
from fdvv.workflow._study_files import (
    FROZEN_FILE,
    KEEPER_FILE,
    LOG_FILE,
    PEOPLE,
    REMEDY,
    Frozen,
    LARGEST_bytes,
    digest,
    fingerprint_of,
    read_frozen,
)
from fdvv.workflow._study_pause import paused_of
from fdvv.workflow._study_people import Person, no_person, people_of
from fdvv.workflow._study_seal import Keeper, Seal
from fdvv.workflow._study_verify import study_problems


class StudyFolder:
    """A study that lies in a folder, to be read; nothing of it is held open between two calls.

    Attributes
    ----------
    folder : of the study.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = Path(folder)
        self._plan: tuple[bytes, StudyPlan] | None = None

    @property
    def plan(self) -> StudyPlan:
        """Get the plan. InputError where it cannot be read, or is not what was frozen."""
        path = self.folder / STUDY_FILE
        data = read_limited(path, LARGEST_bytes, REMEDY)
        frozen = self.frozen
        if frozen and frozen.files.get(STUDY_FILE) != digest(data):
            raise InputError(path, "whole file", "was changed since the study was frozen", REMEDY)
        if self._plan is None or self._plan[0] != data:
            self._plan = data, read_plan_text(data.decode(errors="replace"), path)
        return self._plan[1]

    @property
    def frozen(self) -> Frozen | None:
        """Get what is frozen; None before. InputError where it cannot be read."""
        found = read_frozen(self.folder)
        return found[0] if found else None

    @property
    def fingerprint(self) -> str:
        """Get what people write into their preregistration; empty before the study is frozen."""
        found = read_frozen(self.folder)
        return fingerprint_of(found[1]) if found else ""

    @property
    def seal(self) -> Seal:
        """Get the public half of the keys. InputError where the study is not frozen."""
        return Seal.of(self.require_frozen().seal, self.folder / FROZEN_FILE)

    def require_frozen(self) -> Frozen:
        """Give what is frozen. InputError of a study that is not."""
        frozen = self.frozen
        if frozen is None:
            raise InputError(self.folder, "study", "is not frozen", "freeze it: fdvv study freeze FOLDER")
        return frozen

    def history(self) -> tuple[dict[str, Any], ...]:
        """Give what the study's log tells, each an object with one key; empty before it is frozen."""
        return read_chained(self.folder / LOG_FILE).records

    def people(self) -> tuple[Person, ...]:
        """Give everybody who was enrolled, in that order."""
        return people_of(self.history())

    @property
    def simulated(self) -> bool:
        """Tell whether its people are simulated: a study has these, or people, and never both."""
        return any(person.simulated for person in self.people())

    def person(self, name: str) -> Person:
        """Find somebody. InputError."""
        people = self.people()
        found = next((person for person in people if person.name == name), None)
        if found is None:
            raise no_person(name, people)
        return found

    def person_folder(self, name: str) -> Path:
        """Give where somebody's files lie. InputError on a name that nobody has."""
        return self.folder / PEOPLE / self.person(name).name

    @property
    def record_end(self) -> str:
        """Get what tells the study's log until now from any other; empty before it is frozen.

        Who writes it down can hold a later log against it: what was recorded until then is still in it.
        """
        chain = read_chained(self.folder / LOG_FILE).chain
        return fingerprint_of(chain) if chain else ""

    def verify(
        self, fingerprint: str = "", passphrase: str = "", keeper: Path | None = None, record: str = ""
    ) -> tuple[str, ...]:
        """Tell all that is not as it was written, each in one line; empty: the study is whole.

        fingerprint : that was written down when the study was frozen. passphrase, keeper : with the keeper's
        key the marks of people's lines are held against their keys too. record : a `record_end` that was
        written down.
        """
        opened = self.keeper(passphrase, keeper) if passphrase else None
        return study_problems(self.folder, fingerprint, opened, record=record)

    def require_whole(self, person: str = "") -> None:
        """Refuse to run a study that is not as it was frozen. person : whose files are looked at too."""
        for problem in study_problems(self.folder, people=(person,) if person else ()):
            raise InputError(self.folder, "study", problem, REMEDY)

    def keeper(self, passphrase: str, path: Path | None = None) -> Keeper:
        """Open the keeper's file. path : where it is, if it was moved. InputError on a wrong passphrase."""
        path = path or self.folder / KEEPER_FILE
        keeper = Keeper.open(read_limited(path, LARGEST_bytes, REMEDY), passphrase, path)
        if keeper.seal != self.seal:
            raise InputError(
                path, "$.seal", "is the keeper's file of another study", "name that of this study"
            )
        return keeper

    @property
    def paused(self) -> frozenset[str]:
        """Get whom its leader has wait; an empty name among them: everybody."""
        return paused_of(self.history())

"""A study in a folder: declared, frozen, run, unsealed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from fdvv.errors import InputError
from fdvv.files import read_limited, write_atomic
from fdvv.study import Answers, StudyPlan, read_plan_text
from fdvv.workflow._session_manifest import now
from fdvv.workflow._study_chain import read_chained
from fdvv.workflow._study_enrol import Newcomer, enrol_person
from fdvv.workflow._study_files import (
    FROZEN_FILE,
    KEEPER_FILE,
    LOG_FILE,
    PEOPLE,
    PLAN_FILE,
    REMEDY,
    SCHEDULE_FILE,
    SEALED_FILE,
    SESSION_FILE,
    Frozen,
    LARGEST_bytes,
    copy_files,
    digest,
    fingerprint_of,
    read_frozen,
)
from fdvv.workflow._study_freeze import freeze_folder
from fdvv.workflow._study_log import ChainedLog, open_when_free
from fdvv.workflow._study_people import (
    Person,
    Schedule,
    no_person,
    open_with_code,
    open_with_keeper,
    people_of,
)
from fdvv.workflow._study_seal import CODE_COST, PASSPHRASE_COST, Cost, Keeper, Seal
from fdvv.workflow._study_verify import study_problems
from fdvv.workflow._study_withdraw import withdraw_person


class Study:
    """A study that lies in a folder; nothing of it is held open between two calls.

    Made by `declare` or `open`.

    Attributes
    ----------
    folder : of the study.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = Path(folder)
        self._plan: tuple[bytes, StudyPlan] | None = None

    @classmethod
    def declare(cls, folder: Path, plan_file: Path) -> Study:
        """Begin a study in a folder that is new or empty: copy its plan and all files that it names.

        InputError on a plan that cannot be read, or that names a file that is not there. OSError.
        """
        text = read_limited(plan_file, LARGEST_bytes, "name a smaller file").decode(errors="replace")
        return cls.declare_text(folder, text, Path(plan_file).parent, plan_file)

    @classmethod
    def declare_text(cls, folder: Path, text: str, beside: Path, source: object = PLAN_FILE) -> Study:
        """Begin a study from the text of its plan. beside : where the files lie that it names."""
        folder = Path(folder)
        if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
            raise InputError(folder, "folder", "is not empty", "name a new one, or open the study in it")
        copy_files(read_plan_text(text, source), Path(beside), folder)
        write_atomic(folder / PLAN_FILE, text)
        return cls(folder)

    @classmethod
    def open(cls, folder: Path) -> Study:
        """Open a study. InputError where there is none."""
        if not (Path(folder) / PLAN_FILE).is_file():
            raise InputError(folder, "folder", f"holds no study ({PLAN_FILE})", "name the folder of a study")
        return cls(folder)

    @property
    def plan(self) -> StudyPlan:
        """Get the plan. InputError where it cannot be read, or is not what was frozen."""
        path = self.folder / PLAN_FILE
        data = read_limited(path, LARGEST_bytes, REMEDY)
        frozen = self.frozen
        if frozen and frozen.files.get(PLAN_FILE) != digest(data):
            raise InputError(path, "whole file", "was changed since the study was frozen", REMEDY)
        if self._plan is None or self._plan[0] != data:
            self._plan = data, read_plan_text(data.decode(errors="replace"), path)
        return self._plan[1]

    def change_plan(self, text: str, beside: Path | None = None) -> None:
        """Put another plan in the place of one that is not frozen. beside : where files lie that it names."""
        if self.frozen:
            raise InputError(self.folder, "study", "is frozen", "declare a new study in another folder")
        copy_files(read_plan_text(text, PLAN_FILE), Path(beside or self.folder), self.folder)
        write_atomic(self.folder / PLAN_FILE, text)

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
        frozen = self.frozen
        if frozen is None:
            raise InputError(self.folder, "study", "is not frozen", "freeze it: fdvv study freeze FOLDER")
        return Seal.of(frozen.seal, self.folder / FROZEN_FILE)

    def freeze(self, passphrase: str, cost: Cost = PASSPHRASE_COST) -> str:
        """Freeze the study, and give its fingerprint. passphrase : the keeper's; it is kept nowhere.

        InputError on a plan with problems, or a study that was frozen before.
        """
        return freeze_folder(self.folder, self.plan, passphrase, cost)

    def history(self) -> tuple[dict[str, Any], ...]:
        """Give what the study's log tells, each an object with one key; empty before it is frozen."""
        return read_chained(self.folder / LOG_FILE).records

    def people(self) -> tuple[Person, ...]:
        """Give everybody who was enrolled, in that order."""
        return people_of(self.history())

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

    def enrol(
        self, language: str = "", consent: str = "", simulated: bool = False, cost: Cost = CODE_COST
    ) -> tuple[str, str]:
        """Take somebody in: draw their whole schedule and lock it. Give their name and their code.

        The code is shown to that person alone and kept nowhere. consent : how it was given, if not on a page.
        InputError where the study is not frozen, was changed or was unsealed. OSError.
        """
        self.require_whole()
        language = language or self.plan.languages[0]
        if language not in self.plan.languages:
            known = ", ".join(self.plan.languages)
            raise InputError(language, "language", "is not one of the study", f"name one of {known}")
        with self._log() as log:
            newcomer = Newcomer(language, consent, simulated)
            return enrol_person(self.folder, self.plan, self.seal, log, newcomer, cost)

    def schedule(self, person: str, code: str) -> Schedule:
        """Open somebody's schedule with their code. **Secret.** InputError: a wrong one, a changed study."""
        return open_with_code(self._checked(person), code)

    def schedule_by_keeper(self, person: str, keeper: Keeper) -> Schedule:
        """Open somebody's schedule with the keeper's key. **Secret.** InputError."""
        return open_with_keeper(self._checked(person), keeper)

    def _checked(self, name: str) -> Path:
        person = self.person(name)
        if person.state in ("withdrawn", "deleted"):
            raise InputError(name, "person", "has withdrawn", "enrol somebody else")
        self.require_whole(name)
        return self.person_folder(name) / SCHEDULE_FILE

    def session_log(self, schedule: Schedule) -> ChainedLog:
        """Open the plain log of somebody's session, to read it and to go on. InputError, OSError."""
        return ChainedLog(self.person_folder(schedule.person) / SESSION_FILE, bytes.fromhex(schedule.key))

    def sealed_log(self, schedule: Schedule) -> ChainedLog:
        """Open the log of what was rendered in somebody's trials, each sealed. InputError."""
        return ChainedLog(self.person_folder(schedule.person) / SEALED_FILE, bytes.fromhex(schedule.key))

    def finished(self, person: str) -> None:
        """Note that somebody is done, with the ends of their logs: from now on none of it can be cut."""
        folder = self.person_folder(person)
        ends = {name: read_chained(folder / name).chain for name in (SESSION_FILE, SEALED_FILE)}
        with self._log() as log:
            log.write({"finished": {"when": now(), "person": person, "ends": ends}})

    def withdraw(self, person: str, delete: bool = True) -> None:
        """Take somebody out for good; that they were there stays in the study's log.

        delete : all that is kept of them, answers and what was rendered, and all that was unsealed of the
        study: unseal it again. Else what they gave until now is kept. A second time does what was left.
        InputError where they are in the study at this moment. OSError.
        """
        with self._log() as log:
            withdraw_person(self.folder, log, person, delete)

    def unseal(
        self, passphrase: str, who: str, why: str, keeper: Path | None = None, despite: bool = False
    ) -> Answers:
        """Tell what the labels hid: on record first, then in memory and in unsealed/.

        Of trials that are still to be answered nothing is told. who, why : on record for good. despite : go
        on where people's files were changed: nothing of theirs counts, and the record tells so.
        InputError on a wrong passphrase, an empty name or reason, a study that is not whole. OSError.
        """
        from fdvv.workflow._study_unseal import check_words, refuse_problems, unseal_folder

        words = check_words(who=who, why=why)
        opened, plan = self.keeper(passphrase, keeper), self.plan
        problems = study_problems(self.folder, keeper=opened)
        if not despite:
            refuse_problems(self.folder, problems)
        with self._log() as log:
            return unseal_folder(self.folder, plan, log, opened, {**words, "problems": list(problems)})

    def _log(self) -> ChainedLog:
        """Open the study's log alone."""
        return open_when_free(self.folder / LOG_FILE)

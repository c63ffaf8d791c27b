"""A study in a folder: declared, frozen, run, unsealed."""

from __future__ import annotations

from pathlib import Path

from fdvv.errors import InputError
from fdvv.files import read_limited
from fdvv.study import STUDY_FILE, Answers
from fdvv.workflow._session_manifest import now
from fdvv.workflow._study_chain import read_chained
from fdvv.workflow._study_declare import declare_folder, put_plan
from fdvv.workflow._study_enrol import Newcomer, enrol_person
from fdvv.workflow._study_files import (
    LOG_FILE,
    SCHEDULE_FILE,
    SEALED_FILE,
    SESSION_FILE,
    SMALLER,
    LARGEST_bytes,
)
from fdvv.workflow._study_folder import StudyFolder
from fdvv.workflow._study_freeze import freeze_folder
from fdvv.workflow._study_log import ChainedLog, open_when_free
from fdvv.workflow._study_pause import EVERYBODY, pause_person
from fdvv.workflow._study_people import Schedule, open_with_code, open_with_keeper
from fdvv.workflow._study_seal import CODE_COST, PASSPHRASE_COST, Cost, Keeper
from fdvv.workflow._study_verify import study_problems
from fdvv.workflow._study_withdraw import withdraw_person


class Study(StudyFolder):
    """A study that lies in a folder; nothing of it is held open between two calls.

    Made by `declare` or `open`.

    Attributes
    ----------
    folder : of the study.
    """

    @classmethod
    def declare(cls, folder: Path, plan_file: Path) -> Study:
        """Begin a study in a folder that is new or empty: copy its plan and all files that it names.

        InputError on a plan that cannot be read, or that names a file that is not there. OSError.
        """
        text = read_limited(plan_file, LARGEST_bytes, SMALLER).decode(errors="replace")
        return cls.declare_text(folder, text, Path(plan_file).parent, plan_file)

    @classmethod
    def declare_text(cls, folder: Path, text: str, beside: Path, source: object = STUDY_FILE) -> Study:
        """Begin a study from the text of its plan. beside : where the files lie that it names."""
        declare_folder(Path(folder), text, Path(beside), source)
        return cls(folder)

    @classmethod
    def open(cls, folder: Path) -> Study:
        """Open a study. InputError where there is none."""
        if not (Path(folder) / STUDY_FILE).is_file():
            raise InputError(folder, "folder", f"holds no study ({STUDY_FILE})", "name the folder of a study")
        return cls(folder)

    def change_plan(self, text: str, beside: Path | None = None) -> None:
        """Put another plan in the place of one that is not frozen. beside : where files lie that it names."""
        if self.frozen:
            raise InputError(self.folder, "study", "is frozen", "declare a new study in another folder")
        put_plan(self.folder, text, Path(beside or self.folder), STUDY_FILE)

    def freeze(self, passphrase: str, cost: Cost = PASSPHRASE_COST) -> str:
        """Freeze the study, and give its fingerprint. passphrase : the keeper's; it is kept nowhere.

        InputError on a plan with problems, or a study that was frozen before.
        """
        return freeze_folder(self.folder, self.plan, passphrase, cost)

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

    def pause(self, person: str = EVERYBODY, on: bool = True) -> None:
        """Have somebody wait, or everybody; on record, so that it holds after every crash. on : else go on.

        InputError where the study is not frozen, or on somebody who is not in it. OSError.
        """
        self.require_frozen()
        with self._log() as log:
            pause_person(log, person, on)

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

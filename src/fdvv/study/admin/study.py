"""A study in a folder: declared, frozen, run, unsealed."""

from __future__ import annotations

from pathlib import Path

from fdvv.errors import InputError
from fdvv.io.files import read_limited
from fdvv.rendering.session import now
from fdvv.study.admin.declare import declare_folder, freeze_folder, put_plan
from fdvv.study.admin.enrol import Enrolment, enrol_person, withdraw_person
from fdvv.study.files.chained_log import ChainedLog, open_when_free, read_chained
from fdvv.study.files.folder import StudyFolder, study_problems
from fdvv.study.files.layout import LOG_FILE, SCHEDULE_FILE, SEALED_FILE, SESSION_FILE, SMALLER, LARGEST_bytes
from fdvv.study.files.people import EVERYBODY, Schedule, open_schedule, pause_person
from fdvv.study.files.seal import CODE_COST, PASSPHRASE_COST, Cost, KeyHolder
from fdvv.study.plan.answers import Answers
from fdvv.study.plan.plan_file import STUDY_FILE


class Study(StudyFolder):
    """A study that lies in a folder; no file is held open between two calls. Made by `declare` or `open`.

    Attributes
    ----------
    folder : of the study.
    """

    @classmethod
    def declare(cls, folder: Path, plan_file: Path) -> Study:
        """Declare a study in a folder that is new or empty: copy its plan and all files that it names.

        InputError on a plan that cannot be read, or that names a file that is not there. OSError.
        """
        text = read_limited(plan_file, LARGEST_bytes, SMALLER).decode(errors="replace")
        return cls.declare_text(folder, text, Path(plan_file).parent, plan_file)

    @classmethod
    def declare_text(cls, folder: Path, text: str, beside: Path, source: object = STUDY_FILE) -> Study:
        """Declare a study from the text of its plan. beside : where the files lie that it names."""
        declare_folder(Path(folder), text, Path(beside), source)
        return cls(folder)

    @classmethod
    def open(cls, folder: Path) -> Study:
        """Open a study. InputError where there is none."""
        if not (Path(folder) / STUDY_FILE).is_file():
            raise InputError(folder, "folder", f"holds no study ({STUDY_FILE})", "name the folder of a study")
        return cls(folder)

    def change_plan(self, text: str, beside: Path | None = None) -> None:
        """Replace the plan of a study that is not frozen. beside : where files lie that it names."""
        if self.frozen:
            raise InputError(self.folder, "study", "is frozen", "declare a new study in another folder")
        put_plan(self.folder, text, Path(beside or self.folder), STUDY_FILE)

    def freeze(self, passphrase: str, cost: Cost = PASSPHRASE_COST) -> str:
        """Freeze the study, and return its fingerprint. passphrase : the key holder's; it is not stored.

        InputError on a plan with problems, or a study that was frozen before.
        """
        return freeze_folder(self.folder, self.plan, passphrase, cost)

    def enrol(
        self, language: str = "", consent: str = "", simulated: bool = False, cost: Cost = CODE_COST
    ) -> tuple[str, str]:
        """Enrol a person: draw their whole schedule and lock it. Return their name and their code.

        The code is shown to that person alone and not stored. consent : how it was given, if not on a page.
        InputError where the study is not frozen, was changed or was unsealed. OSError.
        """
        self.require_whole()
        language = language or self.plan.languages[0]
        if language not in self.plan.languages:
            known = ", ".join(self.plan.languages)
            raise InputError(language, "language", "is not one of the study", f"name one of {known}")
        with self._log() as log:
            enrolment = Enrolment(language, consent, simulated)
            return enrol_person(self.folder, self.plan, self.seal, log, enrolment, cost)

    def schedule(self, person: str, key: str | KeyHolder) -> Schedule:
        """Open a person's schedule with their code, or the key holder's key. **Secret.**

        InputError on a wrong code, a person who withdrew, a study that was changed.
        """
        if self.person(person).state in ("withdrawn", "deleted"):
            raise InputError(person, "person", "has withdrawn", "enrol somebody else")
        self.require_whole(person)
        return open_schedule(self.person_folder(person) / SCHEDULE_FILE, key)

    def session_log(self, schedule: Schedule) -> ChainedLog:
        """Open the plain log of a person's session, to read and append. InputError, OSError."""
        return ChainedLog(self.person_folder(schedule.person) / SESSION_FILE, bytes.fromhex(schedule.key))

    def sealed_log(self, schedule: Schedule) -> ChainedLog:
        """Open the log of what was rendered in a person's trials, each sealed. InputError."""
        return ChainedLog(self.person_folder(schedule.person) / SEALED_FILE, bytes.fromhex(schedule.key))

    def finished(self, person: str) -> None:
        """Record that a person is done, with the ends of their logs: from now on none of it can be cut."""
        folder = self.person_folder(person)
        ends = {name: read_chained(folder / name).chain for name in (SESSION_FILE, SEALED_FILE)}
        with self._log() as log:
            log.write({"finished": {"when": now(), "person": person, "ends": ends}})

    def pause(self, person: str = EVERYBODY, on: bool = True) -> None:
        """Pause a person, or everybody; recorded, so that it holds after every crash. on : else continue.

        InputError where the study is not frozen, or on a person who is not in it. OSError.
        """
        self.require_frozen()
        with self._log() as log:
            pause_person(log, person, on)

    def withdraw(self, person: str, delete: bool = True) -> None:
        """Withdraw a person for good; that they were there stays in the study's log.

        delete : all data of theirs, answers and what was rendered, and all that was unsealed of the study:
        unseal it again. Else what they gave until now is kept. A second call does what was left undone.
        InputError where they are in the study at this moment. OSError.
        """
        with self._log() as log:
            withdraw_person(self.folder, log, person, delete)

    def unseal(
        self, passphrase: str, who: str, why: str, keeper: Path | None = None, despite: bool = False
    ) -> Answers:
        """Return the answers with what their labels hid, and write them to unsealed/; recorded first.

        Trials that are still to be answered stay sealed. who, why : recorded for good. despite : go on where
        people's files were changed: nothing of theirs counts, and the record says so.
        InputError on a wrong passphrase, an empty name or reason, a study that is not whole. OSError.
        """
        from fdvv.study.analysis.unseal import check_words, refuse_problems, unseal_folder

        words = check_words(who=who, why=why)
        holder, plan = self.key_holder(passphrase, keeper), self.plan
        problems = study_problems(self.folder, holder=holder)
        if not despite:
            refuse_problems(self.folder, problems)
        with self._log() as log:
            return unseal_folder(self.folder, plan, log, holder, {**words, "problems": list(problems)})

    def _log(self) -> ChainedLog:
        return open_when_free(self.folder / LOG_FILE)

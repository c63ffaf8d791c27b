"""A study in a folder: declared, frozen, run, unsealed, whatever its kind."""

from __future__ import annotations

import secrets
from pathlib import Path
from typing import Any

from fdvv.errors import InputError
from fdvv.eventlog import Journal
from fdvv.io.files import make_private, write_atomic
from fdvv.rendering.session import now
from fdvv_people.study.admin.planned import PlannedStudy
from fdvv_people.study.analysis.code_book import csv_text
from fdvv_people.study.files import layout
from fdvv_people.study.files.chained_log import ChainedLog, open_when_free, read_chained
from fdvv_people.study.files.counts import Counter, read_counts
from fdvv_people.study.files.folder import study_problems
from fdvv_people.study.files.layout import LOG_FILE, PEOPLE, SESSION_FILE, digest
from fdvv_people.study.files.opened import open_people, page_rows
from fdvv_people.study.files.people import (
    EVERYBODY,
    Schedule,
    free_place,
    keep_person,
    lock_schedule,
    open_schedule,
    pause_person,
    people_of,
    person_of,
    read_locked,
    wipe,
)
from fdvv_people.study.files.run_key import CLOSED, OPEN_FIRST, RunKey
from fdvv_people.study.files.seal import CODE_COST, Cost, KeyHolder, new_code

PAGES = ("person", "page", "question", "answer")
"""Columns of pages.csv: a row is a question."""


class Study(PlannedStudy):
    """A study that lies in a folder; no file is held open between two calls. Made by `declare` or `open`."""

    @property
    def needs_run_key(self) -> bool:
        """Whether people can begin only while sessions are open: in studies that were frozen since 0.1.0."""
        return self.require_frozen().version > 1

    def waits_for_key(self, person: str) -> bool:
        """Whether a person can come back only once sessions are open. InputError."""
        path = self.person_folder(person) / layout.SCHEDULE_FILE
        return not self.sessions_open and path.is_file() and read_locked(path).version > 1

    def open_sessions(self, passphrase: str, keeper: Path | bytes | None = None) -> None:
        """Let sessions run with this object: keep the run key in its memory. That is recorded first.

        keeper : keeper.json, or where it is, if it was moved. InputError on a wrong passphrase, OSError.
        """
        holder = self.key_holder(passphrase, keeper)
        with self.log() as log:
            log.write({"opened": {"when": now(), **self._counted()}})
        self.run_key = holder.run_key
        if (found := read_counts(self.folder)) and found.made_with(self.run_key):
            self.run_key.counted = found.written
        make_private(self.folder / PEOPLE)  # an earlier fdvv let others of this machine read it

    def enrol(
        self, language: str = "", consent: str = "", simulated: bool = False, cost: Cost = CODE_COST
    ) -> tuple[str, str]:
        """Enrol a person: draw their whole schedule and lock it. Return their name and their code.

        language : of the study, its first by default.
        The code is shown to that person alone and not stored. consent : how it was given, if not on a page.
        InputError where the study is not frozen, was changed or was unsealed, where sessions are not open.
        OSError.
        """
        self.require_whole()
        run_key, languages = self._run_key(simulated), self.plan.languages
        language = language or languages[0]
        if language not in languages:
            known = ", ".join(languages)
            raise InputError(language, "language", "is not one of the study", f"name one of {known}")
        with self.log() as log:
            self._check_enrolment(log, simulated)
            people = people_of(log.records)
            person, place = f"P{len(people) + 1:02d}", free_place(people)
            trials, code = self.kind.draw(self, place, simulated), new_code()
            schedule = Schedule(log.about["study"], person, secrets.token_hex(32), trials)
            text = lock_schedule(schedule, self.seal, code, cost, run_key)
            heads = keep_person(self.folder / PEOPLE / person, schedule, text, consent)
            if run_key:
                Counter(self.folder, schedule.study, person, run_key).count_alone(heads, 0)
            about = {"language": language, "place": place, "simulated": simulated}
            log.write({"enrolled": {"person": person, **about, "when": now(), "schedule": digest(text)}})
        return person, code

    def _run_key(self, simulated: bool) -> RunKey | None:
        """Return what a new person's schedule is locked with beside their code; None where that is all."""
        if not simulated and not self.sessions_open and self.needs_run_key:
            raise InputError("study", "sessions", CLOSED, OPEN_FIRST)
        # simulated people have nothing to be blind to, and are run without a key holder
        return self.run_key if self.sessions_open and not simulated else None

    def _check_enrolment(self, log: ChainedLog, simulated: bool) -> None:
        if any("unsealed" in record for record in log.records):
            reason = "was unsealed, nobody can begin it any more"
            raise InputError(self.folder, "study", reason, "declare a new study")
        if any(person.simulated != simulated for person in people_of(log.records)):
            reason = "has people and cannot have simulated ones" if simulated else "has simulated people only"
            raise InputError(self.folder, "study", reason, "declare another study for them")

    def schedule(self, person: str, key: str | KeyHolder) -> Schedule:
        """Open a schedule with its person's code in open sessions, or the key holder's key. **Secret.**

        InputError on a wrong code, a person who withdrew, a study that was changed, closed sessions.
        """
        if self.person(person).state in ("withdrawn", "deleted"):
            raise InputError(person, "person", "has withdrawn", "enrol somebody else")
        self.require_whole(person)
        run_key = self.run_key if self.sessions_open else None
        return open_schedule(self.person_folder(person) / layout.SCHEDULE_FILE, key, run_key)

    def session_log(self, schedule: Schedule) -> ChainedLog:
        """Open the plain log of a person's session, to read and append. InputError, OSError."""
        return ChainedLog(self.person_folder(schedule.person) / SESSION_FILE, bytes.fromhex(schedule.key))

    def sealed_log(self, schedule: Schedule) -> ChainedLog:
        """Open the log of what was rendered in a person's trials, each sealed. InputError."""
        return ChainedLog(
            self.person_folder(schedule.person) / layout.SEALED_FILE, bytes.fromhex(schedule.key)
        )

    def finished(self, person: str) -> None:
        """Record that a person is done, with the ends of their logs: from now on none of it can be cut."""
        folder = self.person_folder(person)
        ends = {name: read_chained(folder / name).chain for name in (SESSION_FILE, layout.SEALED_FILE)}
        with self.log() as log:
            log.write({"finished": {"when": now(), "person": person, "ends": ends, **self._counted()}})

    def _counted(self) -> dict[str, int]:
        """Return how often the counts were written, for a line of the study's log."""
        found = read_counts(self.folder)
        return {"counted": found.written} if found else {}

    def counter(self, schedule: Schedule, key: str | KeyHolder) -> Counter | None:
        """Return what counts the lines of a person's logs; None of people that an earlier fdvv enrolled."""
        if read_locked(self.person_folder(schedule.person) / layout.SCHEDULE_FILE).version == 1:
            return None
        run_key = key.run_key if isinstance(key, KeyHolder) else self.run_key
        assert run_key is not None  # else the schedule was not opened
        return Counter(self.folder, schedule.study, schedule.person, run_key)

    def pause(self, person: str = EVERYBODY, on: bool = True) -> None:
        """Pause a person, or everybody; recorded, so that it holds after every crash. on : else continue.

        InputError where the study is not frozen, or on a person who is not in it. OSError.
        """
        self.require_frozen()
        with self.log() as log:
            pause_person(log, person, on)

    def withdraw(self, person: str, delete: bool = True) -> None:
        """Withdraw a person for good; that they were there stays in the study's log.

        delete : all data of theirs, answers and what was rendered, and all that was unsealed of the study:
        unseal it again. Else what they gave until now is kept. A second call does what was left undone.
        InputError where they are in the study at this moment. OSError.
        """
        with self.log() as log:
            state = person_of(log.records, person).state
            own = self.folder / PEOPLE / person
            if (own / SESSION_FILE).exists():
                remedy = "have them press withdraw, or close their screen"
                busy = InputError(person, "person", "is in the study at this moment", remedy)
                Journal(own / SESSION_FILE, busy).close()
            if state != "deleted" and (delete or state != "withdrawn"):
                # first on record: a process that is killed in between leaves files that verify reports
                log.write({"withdrawn": {"when": now(), "person": person, "deleted": delete}})
            for left in (own, self.folder / layout.UNSEALED) if delete else ():
                wipe(left)

    def unseal(
        self, passphrase: str, who: str, why: str, keeper: Path | None = None, despite: bool = False
    ) -> Any:
        """Return what people did with what labels or codes hid, and write it to unsealed/; recorded first.

        Its type is the kind's. Trials that are still to be done stay sealed. who, why : recorded for good.
        despite : go on where people's files were changed: nothing of theirs counts, and the record says so.
        InputError on a wrong passphrase, an empty name or reason, a study that is not whole. OSError.
        """
        holder, about = self._unsealing(passphrase, who, why, keeper, despite)
        with self.log() as log:
            log.write({"unsealed": {"when": now(), **about}})
            people = people_of(log.records)
            kind, folder = self.kind, self.folder / layout.UNSEALED
            opened = tuple(open_people(self.folder, people, holder, about["problems"], kind.state))
            found = kind.unseal(self.plan, opened, folder)
            write_atomic(folder / layout.PAGES_FILE, csv_text(PAGES, page_rows(opened)))
            make_private(folder)
            return found

    def _unsealing(
        self, passphrase: str, who: str, why: str, keeper: Path | None, despite: bool
    ) -> tuple[KeyHolder, dict[str, Any]]:
        """Return the key holder, and what the record of an unsealing says; see `unseal`."""
        about: dict[str, Any] = {"who": " ".join(who.split()), "why": " ".join(why.split())}
        for name, text in about.items():
            if not text:
                raise InputError(name, "whole", "is empty", "say who unseals the study, and why")
        holder = self.key_holder(passphrase, keeper)
        problems = study_problems(self.folder, holder=holder)
        if problems and not despite:
            more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
            remedy = f"{layout.REMEDY}; --despite goes on without the people concerned"
            raise InputError(self.folder, "study", problems[0] + more, remedy)
        return holder, {**about, "problems": list(problems)}

    def log(self) -> ChainedLog:
        """Open the study's log, to read and append; wait while another process writes it. InputError."""
        return open_when_free(self.folder / LOG_FILE)

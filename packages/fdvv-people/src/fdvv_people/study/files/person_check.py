"""Whether the files of a person are as they were written, and all that was counted is in them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fdvv.errors import InputError
from fdvv_people.study.files import layout
from fdvv_people.study.files.chained_log import ChainRead, read_chained
from fdvv_people.study.files.counts import Counts
from fdvv_people.study.files.layout import PEOPLE, SCHEDULE_FILE
from fdvv_people.study.files.people import Person, open_schedule, read_locked
from fdvv_people.study.files.seal import KeyHolder
from fdvv_people.study.plan.sitting import SittingState


@dataclass(frozen=True)
class PersonCheck:
    """What the files of people are held against.

    folder, study : of the study, and SHA-256 of frozen.json. log : of the study. holder : marks are verified
    with their key. counts : of the study. keyed : it was frozen with a run key. state : of sessions.
    """

    folder: Path
    study: str
    log: ChainRead
    holder: KeyHolder | None
    counts: Counts | None
    keyed: bool
    state: type[SittingState[Any]]

    def problems(self, person: Person) -> Iterator[str]:
        """Return all that is wrong with the files of a person, each from the place in their folder on."""
        own = self.folder / PEOPLE / person.name
        if person.state == "deleted":
            if own.exists():
                yield ": was deleted, and files are still there; withdraw again"
            return
        schedule = own / SCHEDULE_FILE
        if not schedule.is_file() or layout.digest(schedule.read_bytes()) != person.schedule:
            yield f"/{SCHEDULE_FILE}: is missing or was changed"
            return
        try:
            version = read_locked(schedule).version
            key = bytes.fromhex(open_schedule(schedule, self.holder).key) if self.holder else b""
        except InputError as error:
            yield f"/{SCHEDULE_FILE}: {error.reason}"
            return
        if version == 1 and self.keyed and not person.simulated:
            yield f"/{SCHEDULE_FILE}: is opened by a code alone, and the study was frozen with a run key"
            return
        yield from self._logs(own, person, key, version > 1)

    def _logs(self, own: Path, person: Person, key: bytes, counted: bool) -> Iterator[str]:
        for name in (layout.SESSION_FILE, layout.SEALED_FILE):
            found = read_chained(own / name, key)
            for problem in found.problems or self._log(found, name, person, counted):
                yield f"/{name}: {problem}"

    def _log(self, found: ChainRead, name: str, person: Person, counted: bool) -> Iterator[str]:
        about = {"study": self.study, "person": person.name, "log": Path(name).stem}
        if any(found.about.get(key) != value for key, value in about.items()):
            yield "belongs to another person or study"
        done = [r["finished"] for r in self.log.records if r.get("finished", {}).get("person") == person.name]
        if done and done[-1]["ends"].get(name) != found.chain:
            yield "is not as it was when the person was done"
        if counted:
            yield from self._counted(found, name, person.name)
        if person.state == "finished" and name == layout.SESSION_FILE:
            yield from self.state.lacks(found.records)

    def _counted(self, found: ChainRead, name: str, person: str) -> Iterator[str]:
        own = self.counts.people.get(person) if self.counts else None
        if own is None or name not in own.logs:
            yield "was not counted"
            return
        if problem := own.logs[name].problem(found):
            yield problem
        elif name == layout.SESSION_FILE and self.state.kept_in(found.records) < own.answered:
            yield f"has {self.state.kept_in(found.records)} answers, {own.answered} were counted"
        if not found.head_marked:
            yield "has a head that anybody can write"

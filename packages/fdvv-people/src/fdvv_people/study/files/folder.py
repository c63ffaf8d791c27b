"""A study in a folder: what its files say, and whether they are as they were written. Read only."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

from fdvv.errors import InputError
from fdvv_people.study.files import layout
from fdvv_people.study.files.chained_log import ChainRead, read_chained
from fdvv_people.study.files.counts import Counts, counts_problems, read_counts
from fdvv_people.study.files.layout import FROZEN_FILE, KEEPER_FILE, LOG_FILE, PEOPLE, SCHEDULE_FILE, Frozen
from fdvv_people.study.files.people import Person, paused_of, people_of, person_of, read_locked
from fdvv_people.study.files.person_check import PersonCheck
from fdvv_people.study.files.run_key import RunKey
from fdvv_people.study.files.seal import KeyHolder, SealingKey
from fdvv_people.study.kind import StudyKind, kind_of
from fdvv_people.study.plan.plan_file import STUDY_FILE


class StudyFolder:
    """A study that lies in a folder, whatever its kind, to be read.

    No file is held open between two calls.

    Attributes
    ----------
    folder : of the study. run_key : in memory while sessions are open, see `Study.open_sessions`; else None.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = Path(folder)
        self.run_key: RunKey | None = None
        self._plan: tuple[bytes, Any] | None = None

    @cached_property
    def kind(self) -> StudyKind[Any]:
        """What kind of study it is."""
        return kind_of(self.folder)

    @property
    def plan(self) -> Any:
        """The plan, as its kind reads it. InputError where it cannot be read, or is not what was frozen."""
        data = self.plan_text
        if self._plan is None or self._plan[0] != data:
            self._plan = data, self.kind.read_plan(data, self.folder / STUDY_FILE)
        return self._plan[1]

    @property
    def plan_text(self) -> bytes:
        """The file that declares the study. InputError where it is missing, or is not what was frozen."""
        path = self.folder / STUDY_FILE
        data = layout.content(path)
        frozen = self.frozen
        if frozen and frozen.files.get(STUDY_FILE) != layout.digest(data):
            raise InputError(path, "whole file", "was changed since the study was frozen", layout.REMEDY)
        return data

    @property
    def frozen(self) -> Frozen | None:
        """What is frozen; None before. InputError where it cannot be read."""
        found = layout.read_frozen(self.folder)
        return found[0] if found else None

    @property
    def fingerprint(self) -> str:
        """What people write into their preregistration; empty before the study is frozen."""
        found = layout.read_frozen(self.folder)
        return layout.fingerprint_of(found[1]) if found else ""

    @property
    def sessions_open(self) -> bool:
        """Whether this object holds the run key of the study."""
        return self.run_key is not None and self.run_key.seal == self.seal.text

    @property
    def seal(self) -> SealingKey:
        """The public half of the keys. InputError where the study is not frozen."""
        return SealingKey.of(self.require_frozen().seal, self.folder / FROZEN_FILE)

    def require_frozen(self) -> Frozen:
        """Return what is frozen. InputError of a study that is not."""
        frozen = self.frozen
        if frozen is None:
            raise InputError(self.folder, "study", "is not frozen", "freeze it: fdvv study freeze FOLDER")
        return frozen

    def history(self) -> tuple[dict[str, Any], ...]:
        """Return the records of the study's log, each an object with one key; empty before it is frozen."""
        return read_chained(self.folder / LOG_FILE).records

    def people(self) -> tuple[Person, ...]:
        """Return everybody who was enrolled, in that order."""
        return people_of(self.history())

    @property
    def code_alone(self) -> tuple[str, ...]:
        """The people whose code alone opens the blind: they were enrolled before run keys existed.

        Simulated ones are not among them. InputError.
        """
        there = [one for one in self.people() if not one.simulated and one.state != "deleted"]
        paths = {one.name: self.folder / PEOPLE / one.name / SCHEDULE_FILE for one in there}
        return tuple(name for name, path in paths.items() if read_locked(path).version == 1)

    @property
    def simulated(self) -> bool:
        """Whether its people are simulated: a study has these, or people, and never both."""
        return any(person.simulated for person in self.people())

    @property
    def paused(self) -> frozenset[str]:
        """The people who wait; an empty name among them: everybody."""
        return paused_of(self.history())

    def person(self, name: str) -> Person:
        """Return a person by name. InputError."""
        return person_of(self.history(), name)

    def person_folder(self, name: str) -> Path:
        """Return the folder of a person's files. InputError on a name that nobody has."""
        return self.folder / PEOPLE / self.person(name).name

    @property
    def record_end(self) -> str:
        """Fingerprint of the end of the study's log; empty before it is frozen.

        Written down, it can be compared with a later log: all that was recorded until then is still in it.
        """
        chain = read_chained(self.folder / LOG_FILE).chain
        return layout.fingerprint_of(chain) if chain else ""

    def verify(
        self, fingerprint: str = "", passphrase: str = "", keeper: Path | None = None, record: str = ""
    ) -> tuple[str, ...]:
        """Return all that is not as it was written, a line each; empty: the study is whole.

        fingerprint : written down when the study was frozen. passphrase, keeper : with the key holder's key
        the marks of people's lines are verified too. record : a `record_end` that was written down.
        """
        opened = self.key_holder(passphrase, keeper) if passphrase else None
        return study_problems(self.folder, fingerprint, opened, record=record, run_key=self.run_key)

    def require_whole(self, person: str = "") -> None:
        """Raise InputError if the study is not as it was frozen. person : whose files are verified too."""
        people = (person,) if person else ()
        for problem in study_problems(self.folder, people=people, run_key=self.run_key):
            raise InputError(self.folder, "study", problem, layout.REMEDY)

    def key_holder(self, passphrase: str, keeper: Path | bytes | None = None) -> KeyHolder:
        """Open keeper.json. keeper : its content, or where it is, if it was moved.

        InputError on a wrong passphrase.
        """
        path = keeper if isinstance(keeper, Path) else self.folder / KEEPER_FILE
        if not isinstance(keeper, bytes) and not path.is_file():
            raise InputError(path, KEEPER_FILE, "No such file here", "name where it was moved to")
        text = keeper if isinstance(keeper, bytes) else layout.content(path)
        holder = KeyHolder.open(text, passphrase, path)
        if holder.seal != self.seal:
            reason = "is the keeper's file of another study"
            raise InputError(path, "$.seal", reason, "name that of this study")
        return holder


def study_problems(
    folder: Path,
    fingerprint: str = "",
    holder: KeyHolder | None = None,
    people: Sequence[str] | None = None,
    record: str = "",
    run_key: RunKey | None = None,
) -> tuple[str, ...]:
    """Return all that is not as it was written, a line each.

    people : whose files are verified; None: everybody's. fingerprint, record : that were written down.
    run_key : the marks of counts are verified with it, or with the key holder's.
    """
    try:
        found = layout.read_frozen(folder)
    except InputError as error:
        return (f"{FROZEN_FILE}: {error.reason}",)
    if found is None:
        return ("is not frozen",)
    frozen, sha256 = found
    log = read_chained(folder / LOG_FILE)
    problems = [*_frozen(folder, frozen, sha256, fingerprint), *_log(log, sha256, record)]
    try:
        enrolled = people_of(log.records) if not log.problems else ()
    except InputError as error:
        return (*problems, f"{LOG_FILE}: {error.place} {error.reason}")
    if len({person.simulated for person in enrolled}) > 1:
        problems.append(f"{LOG_FILE}: has people and simulated ones")
    if log.problems:
        return tuple(problems)
    fits = run_key is not None and run_key.seal == frozen.seal
    remembered = run_key.counted if run_key and fits else 0
    known = holder.run_key if holder else run_key if fits else None
    counts, wrong = _counts(folder, sha256, log, known, remembered)
    names = {person.name for person in enrolled}
    # an enrolment that was killed was counted, and has no session
    lost = {name for name, one in (counts.people if counts else {}).items() if one.began} - names
    problems += [*wrong, *(f"{LOG_FILE}: {name} was counted, and is not in it" for name in sorted(lost))]
    check = PersonCheck(folder, sha256, log, holder, counts, frozen.version > 1, kind_of(folder).state)
    for person in enrolled:
        if people is None or person.name in people:
            problems += [f"{PEOPLE}/{person.name}{problem}" for problem in check.problems(person)]
    return tuple(problems)


def _frozen(folder: Path, frozen: Frozen, sha256: str, fingerprint: str) -> Iterator[str]:
    found = layout.fingerprint_of(sha256)
    if fingerprint and plain(fingerprint) != plain(found):
        yield f"{FROZEN_FILE}: its fingerprint is {found}, not the one that was written down"
    if layout.digest(frozen.text) != sha256:
        yield f"{FROZEN_FILE}: was changed since the study was frozen"
    for name, wanted in frozen.files.items():
        path = folder / name
        if not path.is_file():
            if name != KEEPER_FILE:  # which may lie elsewhere
                yield f"{name}: is missing"
        elif layout.digest(path.read_bytes()) != wanted:
            yield f"{name}: was changed since the study was frozen"
    for name, wanted in frozen.builtins.items():
        if layout.builtin_digest(name) != wanted:
            yield f"built-in button {name}: is not the one of fdvv {frozen.fdvv}, which froze the study"


def _log(log: ChainRead, sha256: str, record: str) -> Iterator[str]:
    for problem in log.problems:
        yield f"{LOG_FILE}: {problem}"
    if record and plain(record) not in {plain(layout.fingerprint_of(chain)) for chain in log.chains}:
        yield f"{LOG_FILE}: never ended in {record}, which was written down"
    if not log.problems:
        first = log.records[0].get("frozen", {}) if log.records else {}
        if log.about.get("study") != sha256 or first.get("sha256") != sha256:
            yield f"{FROZEN_FILE}: is not the one that {LOG_FILE} began with"


def _counts(
    folder: Path, sha256: str, log: ChainRead, run_key: RunKey | None, remembered: int
) -> tuple[Counts | None, list[str]]:
    try:
        found = read_counts(folder)
    except InputError as error:
        return None, [f"{layout.COUNTS_FILE}: {error.reason}"]
    wrong = counts_problems(found, sha256, log, run_key, remembered)
    return found, [f"{layout.COUNTS_FILE}: {problem}" for problem in wrong]


def plain(fingerprint: str) -> str:
    """Return a fingerprint as typed by people in its plain form: lower case, no blanks, no hyphens."""
    return "".join(fingerprint.lower().split()).replace("-", "")

"""Is a study what it was when it was frozen, and is every line of its logs as it was written?"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from fdvv.errors import InputError
from fdvv.workflow._study_chain import ChainRead, read_chained
from fdvv.workflow._study_files import (
    FROZEN_FILE,
    KEEPER_FILE,
    LOG_FILE,
    PEOPLE,
    SCHEDULE_FILE,
    SEALED_FILE,
    SESSION_FILE,
    Frozen,
    builtin_digest,
    digest,
    fingerprint_of,
    read_frozen,
)
from fdvv.workflow._study_people import Person, open_with_keeper, people_of
from fdvv.workflow._study_seal import Keeper


def study_problems(
    folder: Path,
    fingerprint: str = "",
    keeper: Keeper | None = None,
    people: Sequence[str] | None = None,
    record: str = "",
) -> tuple[str, ...]:
    """Tell all that is not as it was written, each in one line.

    people : whose files are looked at; None: everybody's. fingerprint, record : that were written down.
    """
    try:
        found = read_frozen(folder)
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
    for person in enrolled:
        if people is None or person.name in people:
            problems += [
                f"{PEOPLE}/{person.name}{told}" for told in _person(folder, person, sha256, keeper, log)
            ]
    return tuple(problems)


def _frozen(folder: Path, frozen: Frozen, sha256: str, fingerprint: str) -> Iterator[str]:
    if fingerprint and plain(fingerprint) != plain(fingerprint_of(sha256)):
        yield f"{FROZEN_FILE}: its fingerprint is {fingerprint_of(sha256)}, not the one that was written down"
    if digest(frozen.text) != sha256:
        yield f"{FROZEN_FILE}: was changed since the study was frozen"
    for name, wanted in frozen.files.items():
        path = folder / name
        if not path.is_file():
            if name != KEEPER_FILE:  # which may lie elsewhere
                yield f"{name}: is missing"
        elif digest(path.read_bytes()) != wanted:
            yield f"{name}: was changed since the study was frozen"
    for name, wanted in frozen.builtins.items():
        if builtin_digest(name) != wanted:
            yield f"built-in button {name}: is not the one of fdvv {frozen.fdvv}, which froze the study"


def _log(log: ChainRead, sha256: str, record: str) -> Iterator[str]:
    for problem in log.problems:
        yield f"{LOG_FILE}: {problem}"
    if record and plain(record) not in {plain(fingerprint_of(chain)) for chain in log.chains}:
        yield f"{LOG_FILE}: never ended in {record}, which was written down"
    if not log.problems:
        first = log.records[0].get("frozen", {}) if log.records else {}
        if log.about.get("study") != sha256 or first.get("sha256") != sha256:
            yield f"{FROZEN_FILE}: is not the one that {LOG_FILE} began with"


def _person(
    folder: Path, person: Person, sha256: str, keeper: Keeper | None, log: ChainRead
) -> Iterator[str]:
    """Tell what is wrong with somebody's files, each with what follows their folder."""
    own = folder / PEOPLE / person.name
    if person.state == "deleted":
        if own.exists():
            yield ": was deleted, and files are still there; withdraw again"
        return
    schedule = own / SCHEDULE_FILE
    if not schedule.is_file() or digest(schedule.read_bytes()) != person.schedule:
        yield f"/{SCHEDULE_FILE}: is missing or was changed"
        return
    try:
        key = bytes.fromhex(open_with_keeper(schedule, keeper).key) if keeper else b""
    except InputError as error:
        yield f"/{SCHEDULE_FILE}: {error.reason}"
        return
    for name in (SESSION_FILE, SEALED_FILE):
        yield from (f"/{name}: {told}" for told in _person_log(own / name, key, person, sha256, log))


def _person_log(path: Path, key: bytes, person: Person, sha256: str, log: ChainRead) -> Iterator[str]:
    found = read_chained(path, key)
    yield from found.problems
    if found.problems:
        return
    about = {"study": sha256, "person": person.name, "log": path.stem}
    if any(found.about.get(name) != value for name, value in about.items()):
        yield "belongs to another person or study"
    ends = [r["finished"]["ends"] for r in log.records if r.get("finished", {}).get("person") == person.name]
    if ends and ends[-1].get(path.name) != found.chain:
        yield "is not as it was when the person was done"


def plain(fingerprint: str) -> str:
    """Read a fingerprint as people type it."""
    return "".join(fingerprint.lower().split()).replace("-", "")

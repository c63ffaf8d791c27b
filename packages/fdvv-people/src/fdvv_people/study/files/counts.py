"""What was written for the people of a study, counted: lines that are cut from their logs are missed.

``counts.json`` says how far both logs of everybody go, and how many answers they hold. It is written behind
every event of a session, under the run key: nobody else can lower a number. How often it was written is noted
in the study's log whenever a session closes, and remembered by the run key: an older one is not the newest.
"""

from __future__ import annotations

import os
import time
import zlib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import msgspec
from msgspec import Struct

from fdvv.errors import InputError
from fdvv.io.documents import Kind, pretty
from fdvv.io.files import open_alone, write_atomic
from fdvv.rendering.session import now
from fdvv_people.study.files.chained_log import AT_WORK, ChainRead, PATIENCE_s, open_when_free
from fdvv_people.study.files.layout import COUNTS_FILE, LOG_FILE, REMEDY, content, read_record
from fdvv_people.study.files.log_head import LogHead
from fdvv_people.study.files.run_key import RunKey

COUNTS = Kind("fdvv-counts", 1, "the counts of a study", REMEDY)
COUNTED = "counted"


class LogCount(Struct, frozen=True, forbid_unknown_fields=True):
    """How far a log goes: its lines, and the chain of the last."""

    lines: int
    chain: str

    def problem(self, found: ChainRead) -> str:
        """Return what a log lacks; empty: nothing."""
        if len(found.chains) < self.lines:
            return f"has {len(found.chains)} lines, {self.lines} were counted"
        return "" if found.chains[self.lines - 1] == self.chain else "is not the one that was counted"


class PersonCount(Struct, frozen=True, forbid_unknown_fields=True):
    """What was written for a person. answered : trials, practice included. logs : by file."""

    answered: int
    logs: dict[str, LogCount]

    @property
    def began(self) -> bool:
        """Whether their session began."""
        return any(one.lines > 1 for one in self.logs.values())


class Counts(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """Content of counts.json.

    Attributes
    ----------
    written : how often it was. mark : under the run key, of all of it but crc32. crc32 : of all the rest.
    """

    format: Literal["fdvv-counts"] = "fdvv-counts"
    version: Literal[1] = 1
    study: str
    written: int
    people: dict[str, PersonCount]
    mark: str = ""
    crc32: int = 0

    @property
    def text(self) -> str:
        return pretty(msgspec.to_builtins(self)) + "\n"

    def marked(self, run_key: RunKey) -> Counts:
        bare = msgspec.structs.replace(self, mark="", crc32=0)
        return msgspec.structs.replace(bare, mark=run_key.mark(bare.text)).summed()

    def summed(self) -> Counts:
        bare = msgspec.structs.replace(self, crc32=0)
        return msgspec.structs.replace(bare, crc32=zlib.crc32(bare.text.encode()))

    def made_with(self, run_key: RunKey) -> bool:
        return self == self.marked(run_key)


def read_counts(folder: Path) -> Counts | None:
    """Read the counts of a study; None where nobody was counted. InputError."""
    path = folder / COUNTS_FILE
    if not path.exists():
        return None
    data = content(path)
    found = read_record(data, path, COUNTS, Counts)
    if found.summed().text.encode() != data:
        raise InputError(path, "whole file", "was changed", REMEDY)
    return found


def counts_problems(
    found: Counts | None, study: str, log: ChainRead, run_key: RunKey | None, remembered: int
) -> Iterator[str]:
    """Return all that is wrong with the counts of a study themselves.

    log : of the study. remembered : by the run key, before the counts were read.
    """
    if found is None:
        if any(COUNTED in body for record in log.records for body in record.values()):
            yield "is missing"
        return
    if found.study != study:
        yield "belongs to another study"
    if run_key and not found.made_with(run_key):
        yield "was changed by somebody without the key of this study"
    least = max(_recorded(log.records), remembered)
    if found.written < least:
        yield f"was written {least} times, this one {found.written} times: an older one lies in its place"


def _recorded(records: Sequence[Mapping[str, Any]]) -> int:
    """Return the largest number of writings that the study's log knows of."""
    return max((body.get(COUNTED, 0) for record in records for body in record.values()), default=0)


@dataclass
class Counter:
    """Counts what is written for one person. study : SHA-256 of frozen.json."""

    folder: Path
    study: str
    person: str
    run_key: RunKey

    def count(self, logs: Mapping[str, LogHead], answered: int) -> None:
        """Count, while nobody else does. InputError where the counts were changed or are older. OSError."""
        with _alone(self.folder / LOG_FILE):
            self.count_alone(logs, answered)

    def count_alone(self, logs: Mapping[str, LogHead], answered: int) -> None:
        """Count, where the caller holds the study's log."""
        before = read_counts(self.folder) or Counts(study=self.study, written=0, people={})
        fits = before.made_with(self.run_key) if before.written else True
        if not fits or before.study != self.study or before.written < self.run_key.counted:
            reason = f"was changed, or an older one lies in its place ({before.written} writings)"
            raise InputError(self.folder / COUNTS_FILE, "whole file", reason, REMEDY)
        own = PersonCount(answered, {name: LogCount(one.lines, one.chain) for name, one in logs.items()})
        people = {**before.people, self.person: own}
        after = msgspec.structs.replace(before, written=before.written + 1, people=people)
        write_atomic(self.folder / COUNTS_FILE, after.marked(self.run_key).text, private=True)
        self.run_key.counted = after.written

    def note(self) -> None:
        """Note in the study's log how often the counts were written. InputError, OSError."""
        found = read_counts(self.folder)
        with open_when_free(self.folder / LOG_FILE) as log:
            if found and found.written > _recorded(log.records):
                log.write({COUNTED: {"when": now(), COUNTED: found.written}})


@contextmanager
def _alone(path: Path) -> Iterator[None]:
    """Hold a log of the study as its writers do, without reading it. InputError where it is never free."""
    until = time.monotonic() + PATIENCE_s
    while True:
        try:
            file = open_alone(path)
            break
        except BlockingIOError:
            if time.monotonic() > until:
                raise InputError(path, "whole file", AT_WORK, "close the other one") from None
        time.sleep(0.005)
    try:
        yield
    finally:
        os.close(file)

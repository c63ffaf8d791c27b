"""The records of a session on file, each forced to the disk before the next: people cannot repeat them.

Both files are journals (see `fdvv.eventlog`), with ``{"run": {…}}`` for each start of the program.
``presses.jsonl`` has ``{"press": {…}}`` for every press, used or not, with all columns (`fdvv.io.columns`)
and the table it was made on, ``{"check": {…}}`` for every check of the rig's parts that passed, and
``{"part": {…}}`` where a part was found at fault; ``answers.jsonl`` has ``{"answer": {…}}`` for every answer
of a tuning.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar, Generic, TypeVar

import msgspec

from fdvv.compensation.method import UNTUNED, Tuning
from fdvv.device.recording import pack_record, unpack_press, unpack_surface
from fdvv.errors import InputError
from fdvv.eventlog import Journal, JournalKind, read_bodies
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface

Entry = TypeVar("Entry")


class SessionRun(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One start of the program on a session: when, with which versions, seed and bounds."""

    started: str
    seed: int | None
    versions: dict[str, str]
    acceptance: dict[str, int | float]


class SessionFile(Generic[Entry]):
    """A journal of a session, in memory, and on file for one process at a time if there is a folder.

    Attributes
    ----------
    name, noun : of the file, and what people call its entries.
    kind : the records that it may hold: runs, and entries under another key.
    folder, path : of the session and of the journal; None keeps it in memory.
    runs, entries : including earlier ones.
    warnings : about the file, for people.

    Raises InputError on a file that is damaged or in use, OSError if it cannot be written.
    """

    name: ClassVar[str]
    noun: ClassVar[str]
    kind: ClassVar[JournalKind]

    def __init__(self, folder: Path | None = None) -> None:
        self.folder, self.path = folder, folder / self.name if folder else None
        self.runs: list[SessionRun] = []
        self.entries: list[Entry] = []
        self.warnings: list[str] = []
        self._journal: Journal | None = None
        if self.path:
            reason = "another process is at work on this session"
            busy = InputError(folder, "session", reason, "wait for it, or name another folder")
            self._journal = Journal.resume(self.path, self.kind, busy, self._replay)
            if self._journal.torn:
                kept = f"{self.noun} kept: {len(self.entries)}"
                self.warnings.append(f"{self.path}: the last record is not whole and is left out; {kept}")

    @classmethod
    def read(cls, path: Path) -> tuple[list[SessionRun], list[Entry], int]:
        """Return runs, entries, and the byte where the last whole record ends. Raises InputError."""
        log, end = cls(), 0
        log.path = path
        for key, body, after in read_bodies(path, cls.kind):
            log._replay(key, body)
            end = after
        return log.runs, log.entries, end

    def _replay(self, key: str, body: Any) -> None:
        if key == "run":
            self.runs.append(body)
        else:
            self.entries.append(self._entry(body, len(self.entries) + 1))

    def _entry(self, body: Any, number: int) -> Entry:
        """Return the entry of a record on file, which must have this number. Raises InputError."""
        raise NotImplementedError

    def begin(self, run: SessionRun) -> None:
        """Record that the session is begun or continued."""
        self._write({"run": msgspec.to_builtins(run)})
        self.runs.append(run)

    def _write(self, record: dict[str, Any]) -> None:
        if self._journal:
            self._journal.write(record)

    def close(self) -> None:
        """Close the file; closing twice is harmless."""
        if self._journal:
            self._journal.close()
            self._journal = None


PRESSES = "presses.jsonl"
REMEDY = "begin a new session in another folder"


class CheckRecord(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A check of the rig's parts that passed, with what it could not see; made : when, UTC."""

    unseen: list[str]
    made: str


class PartRecord(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A part that was found at fault: from press from_press on the rig is another, made : when, UTC."""

    from_press: int
    part: str
    seen: str
    remedy: str
    made: str

    def __str__(self) -> str:
        return f"the rig was another from here on: {self.seen}"


PRESSES_KIND = JournalKind(
    {"run": SessionRun, "press": Any, "check": CheckRecord, "part": PartRecord}, REMEDY
)


class PressEntry(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The outcome of one press.

    Attributes
    ----------
    number : counts all presses of the session from 1, including unused ones.
    reason : why it was not used; empty if it was.
    achieved_mm_s : mean speed of the press; None if it has none.
    made : when, UTC.
    """

    number: int
    velocity_mm_s: float
    reason: str
    achieved_mm_s: float | None
    made: str

    @property
    def used(self) -> bool:
        return not self.reason

    def __str__(self) -> str:
        return f"press {self.number} at {self.velocity_mm_s:g} mm/s: {self.reason or 'used'}"


@dataclass(frozen=True, eq=False)
class PressRecord:
    """A press on file; without columns if the device faulted before reporting it.

    tuning : of the controller; on file only where it does something.
    vibrating : the model's vibrations were played; on file only where they were.
    """

    entry: PressEntry
    surface: ForceSurface
    press: Press | None
    tuning: Tuning = UNTUNED
    vibrating: bool = False


class PressLog(SessionFile[PressEntry]):
    """The presses of a session; in memory only what became of each.

    Attributes
    ----------
    checked : the last check of the rig's parts; None before one, and since a part was found at fault.
    parts : that were found at fault. A press made since then is not used, as a rig that changed taught it.
    """

    name, noun, kind = PRESSES, "presses", PRESSES_KIND

    def __init__(self, folder: Path | None = None) -> None:
        self.checked: CheckRecord | None = None
        self.parts: list[PartRecord] = []
        super().__init__(folder)

    def _entry(self, body: Any, number: int) -> PressEntry:
        return _record(self.path, body, number).entry

    def _replay(self, key: str, body: Any) -> None:
        if key == "check":
            self.checked = body
        elif key == "part":
            self._set_apart(body)
        else:
            super()._replay(key, body)

    def records(self) -> Iterator[PressRecord]:
        """Read the presses on file again, with all columns, in order; nothing if there is no file."""
        bodies = read_bodies(self.path, self.kind) if self.path else ()
        presses = (body for key, body, _ in bodies if key == "press")
        for number, body in enumerate(presses, 1):
            yield replace(_record(self.path, body, number), entry=self.entries[number - 1])

    @property
    def used(self) -> int:
        """Number of used presses."""
        return sum(entry.used for entry in self.entries)

    def add(self, record: PressRecord) -> None:
        if self.path is not None:
            self._write({"press": _pack(record)})
        self.entries.append(record.entry)

    def add_check(self, check: CheckRecord) -> None:
        self._write({"check": msgspec.to_builtins(check)})
        self.checked = check

    def set_apart(self, part: PartRecord) -> None:
        """Record a part at fault, and use no press that was made since it is."""
        self._write({"part": msgspec.to_builtins(part)})
        self._set_apart(part)

    def _set_apart(self, part: PartRecord) -> None:
        self.checked = None
        self.parts.append(part)
        self.entries[:] = [
            msgspec.structs.replace(entry, reason=str(part))
            if entry.used and entry.number >= part.from_press
            else entry
            for entry in self.entries
        ]


def _pack(record: PressRecord) -> dict[str, Any]:
    columns = pack_record(record.press) if record.press else None
    tuning = {} if record.tuning == UNTUNED else {"tuning": record.tuning.to_dict()}
    body = {**msgspec.to_builtins(record.entry), "surface": pack_record(record.surface), "columns": columns}
    return body | tuning | ({"vibrating": True} if record.vibrating else {})


def _record(path: Path | None, body: dict[str, Any], number: int) -> PressRecord:
    """Unpack a press, which must have this number."""
    try:
        surface, columns = unpack_surface(body.pop("surface")), body.pop("columns")
        tuning = msgspec.convert(body.pop("tuning", {}), Tuning)
        vibrating = bool(body.pop("vibrating", False))
        entry = msgspec.convert(body, PressEntry)
        if entry.number != number:
            raise ValueError(f"bears the number {entry.number}")
        return PressRecord(entry, surface, unpack_press(columns) if columns else None, tuning, vibrating)
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        raise InputError(path, f"press {number}", str(error), REMEDY) from error


ANSWERS = "answers.jsonl"


class AnswerRecord(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One answer.

    Attributes
    ----------
    number : counts from 1.
    templates : those asked about, in the order they were pressed; numbers among the session's templates.
    answer : a rating from 1 to 7, or "first", "second" or "neither".
    achieved_mm_s : mean speed of each press; None where it has none.
    made : when, UTC.
    """

    number: int
    velocity_mm_s: float
    templates: list[int]
    answer: int | str
    achieved_mm_s: list[float | None]
    made: str

    @property
    def entry(self) -> PressEntry:
        """The answer as a press of the run summary; the speed is that of the last press."""
        achieved = self.achieved_mm_s[-1] if self.achieved_mm_s else None
        return PressEntry(self.number, self.velocity_mm_s, "", achieved, self.made)


ANSWERS_KIND = JournalKind({"run": SessionRun, "answer": AnswerRecord}, REMEDY)


class AnswerLog(SessionFile[AnswerRecord]):
    """The answers of a session."""

    name, noun, kind = ANSWERS, "answers", ANSWERS_KIND

    def _entry(self, body: AnswerRecord, number: int) -> AnswerRecord:
        if body.number != number:
            raise InputError(self.path, f"answer {number}", f"bears the number {body.number}", REMEDY)
        return body

    def add(self, given: AnswerRecord) -> None:
        self._write({"answer": msgspec.to_builtins(given)})
        self.entries.append(given)

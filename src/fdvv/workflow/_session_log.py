"""The presses of a session on file, each as it is made: people cannot repeat them.

``presses.jsonl`` is a journal (see `fdvv.journal`) with the records ``{"run": {…}}`` each time the session is
begun or gone on with and ``{"press": {…}}`` for every press, used or not, with all columns and the table it
was made on. Each is on the disk before the next press begins; columns are packed as `fdvv.columns` tells.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import msgspec

from fdvv.compensate import UNTUNED, Tuning
from fdvv.device import pack_record, unpack_press, unpack_surface
from fdvv.errors import InputError
from fdvv.journal import JournalKind, read_records
from fdvv.model import ForceSurface, Press
from fdvv.workflow._session_file import Run, SessionFile

PRESSES = "presses.jsonl"
REMEDY = "begin a new session in another folder"
KIND = JournalKind(frozenset({"run", "press"}), REMEDY)


class Entry(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What became of one press.

    Attributes
    ----------
    number : counts all presses of the session from 1, those that were not used among them.
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
        """Tell whether it taught or was judged."""
        return not self.reason

    def __str__(self) -> str:
        return f"press {self.number} at {self.velocity_mm_s:g} mm/s: {self.reason or 'used'}"


@dataclass(frozen=True, eq=False)
class Kept:
    """A press as it was kept; without columns if the device faulted before it could tell of it.

    tuning : of the controller; on file only where it does something.
    """

    entry: Entry
    surface: ForceSurface
    press: Press | None
    tuning: Tuning = UNTUNED


class PressLog(SessionFile):
    """The presses of a session, in memory, and on file if there is a folder for it.

    Parameters
    ----------
    folder : of the session, for one process at a time; None keeps only what became of each press.

    Attributes
    ----------
    entries : so far, those of earlier runs among them.
    """

    def __init__(self, folder: Path | None = None) -> None:
        self.folder = folder
        self.entries: list[Entry] = []
        super().__init__(folder / PRESSES if folder else None)

    def _read(self, path: Path) -> int:
        self.runs, self.entries, end = read_log(path)
        return end

    def _count(self) -> int:
        return len(self.entries)

    def _kept_word(self) -> str:
        return "presses"

    def kept(self) -> Iterator[Kept]:
        """Read the presses on file again, with all columns, in order; nothing if there is no file."""
        if self.path is None:
            return
        number = 0
        for record, _ in read_records(self.path, KIND):
            if "press" in record:
                number += 1
                yield _kept(self.path, record["press"], number)

    @property
    def used(self) -> int:
        """Count the presses that were used."""
        return sum(entry.used for entry in self.entries)

    def add(self, kept: Kept) -> None:
        """Keep a press."""
        if self.path is not None:
            self._write({"press": _packed(kept)})
        self.entries.append(kept.entry)


def read_log(path: Path) -> tuple[list[Run], list[Entry], int]:
    """Read what became of each press, and where the last whole record ends. InputError on a damaged file."""
    runs: list[Run] = []
    entries: list[Entry] = []
    end = 0
    for record, after in read_records(path, KIND):
        end = after
        if "run" in record:
            runs.append(_run(path, record["run"]))
        else:
            entries.append(_kept(path, record["press"], len(entries) + 1).entry)
    return runs, entries, end


def _packed(kept: Kept) -> dict[str, Any]:
    columns = pack_record(kept.press) if kept.press else None
    tuning = {} if kept.tuning == UNTUNED else {"tuning": asdict(kept.tuning)}
    found = {**msgspec.to_builtins(kept.entry), "surface": pack_record(kept.surface), "columns": columns}
    return found | tuning


def _run(path: Path, found: Any) -> Run:
    try:
        return msgspec.convert(found, Run)
    except msgspec.ValidationError as error:
        raise _damaged(path, "run", str(error)) from error


def _kept(path: Path, found: dict[str, Any], number: int) -> Kept:
    """Read a press that must bear this number."""
    try:
        surface, columns = unpack_surface(found.pop("surface")), found.pop("columns")
        tuning = Tuning(**found.pop("tuning", {}))
        entry = msgspec.convert(found, Entry)
        if entry.number != number:
            raise ValueError(f"bears the number {entry.number}")
        return Kept(entry, surface, unpack_press(columns) if columns else None, tuning)
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        raise _damaged(path, f"press {number}", str(error)) from error


def _damaged(path: Path, place: str, reason: str) -> InputError:
    return InputError(path, place, reason, REMEDY)

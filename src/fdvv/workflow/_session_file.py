"""A journal of a session: each start of the program, and what a session keeps beside it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from pathlib import Path
from typing import Any

import msgspec

from fdvv.errors import InputError
from fdvv.journal import Journal


class Run(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One start of the program on a session: when, with which versions, seed and bounds."""

    started: str
    seed: int | None
    versions: dict[str, str]
    acceptance: dict[str, int | float]


class SessionFile(ABC):
    """What a session keeps, in memory, and on file for one process at a time if there is a path.

    Attributes
    ----------
    path : of the journal; None keeps it in memory.
    runs : so far, those of earlier runs among them.
    warnings : what a person should know of the file.

    Raises InputError on a file that is damaged or in use, OSError if it cannot be written.
    """

    def __init__(self, path: Path | None) -> None:
        self.path = path
        self.runs: list[Run] = []
        self.warnings: list[str] = []
        self._journal: Journal | None = None
        if path:
            self._journal = Journal(path, _busy(path))
            try:
                self._learn(path, self._journal)
            except BaseException:
                self.close()
                raise

    def _learn(self, path: Path, journal: Journal) -> None:
        """Learn what is there; cut off a record that was not finished."""
        if journal.cut(self._read(path)):
            kept = f"{self._kept_word()} kept: {self._count()}"
            self.warnings.append(f"{path}: the last record is not whole and is left out; {kept}")

    @abstractmethod
    def _read(self, path: Path) -> int:
        """Read what is there; give the byte where the last whole record ends."""

    @abstractmethod
    def _count(self) -> int:
        """Count what is kept."""

    @abstractmethod
    def _kept_word(self) -> str:
        """Name what is kept, as "presses"."""

    def begin(self, run: Run) -> None:
        """Note that the session is begun, or gone on with."""
        self._write({"run": msgspec.to_builtins(run)})
        self.runs.append(run)

    def _write(self, record: dict[str, Any]) -> None:
        if self._journal:
            self._journal.write(record)

    def close(self) -> None:
        """Let go of the file; a second time does nothing."""
        if self._journal:
            self._journal.close()
            self._journal = None


def _busy(path: Path) -> InputError:
    reason = "another process is at work on this session"
    return InputError(path.parent, "session", reason, "wait for it, or name another folder")

"""The answers of a tuning on file, each before the next is asked for: people cannot repeat them.

``answers.jsonl`` is a journal (see `fdvv.journal`) with the records ``{"run": {…}}`` each time the session is
begun or gone on with and ``{"answer": {…}}`` for every answer.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, TypeVar

import msgspec

from fdvv.errors import InputError
from fdvv.journal import JournalKind, read_records
from fdvv.workflow._session_file import Run, SessionFile
from fdvv.workflow._session_log import REMEDY, Entry

ANSWERS = "answers.jsonl"
Read = TypeVar("Read")
KIND = JournalKind(frozenset({"run", "answer"}), REMEDY)


class Given(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
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
    def entry(self) -> Entry:
        """Give it as receipts count it; the speed is that of the last press."""
        achieved = self.achieved_mm_s[-1] if self.achieved_mm_s else None
        return Entry(self.number, self.velocity_mm_s, "", achieved, self.made)


class AnswerLog(SessionFile):
    """The answers of a session, in memory, and on file if there is a folder for it.

    Parameters
    ----------
    folder : of the session, for one process at a time; None keeps them in memory.

    Attributes
    ----------
    answers : so far, those of earlier runs among them.
    """

    def __init__(self, folder: Path | None = None) -> None:
        self.folder = folder
        self.answers: list[Given] = []
        super().__init__(folder / ANSWERS if folder else None)

    def _read(self, path: Path) -> int:
        self.runs, self.answers, end = _given(path)
        return end

    def _count(self) -> int:
        return len(self.answers)

    def _kept_word(self) -> str:
        return "answers"

    def add(self, given: Given) -> None:
        """Keep an answer."""
        self._write({"answer": msgspec.to_builtins(given)})
        self.answers.append(given)


def read_answers(path: Path) -> tuple[list[Run], list[Entry], int]:
    """Read runs, and each answer as an entry of a receipt; also the byte where the last whole record ends.

    Raises InputError on a damaged file.
    """
    runs, answers, end = _given(path)
    return runs, [given.entry for given in answers], end


def _given(path: Path) -> tuple[list[Run], list[Given], int]:
    """Read runs and answers, and where the last whole record ends."""
    runs: list[Run] = []
    answers: list[Given] = []
    end = 0
    for record, after in read_records(path, KIND):
        end = after
        if "run" in record:
            runs.append(_converted(path, "run", record["run"], Run))
        else:
            answers.append(_answer(path, len(answers) + 1, record["answer"]))
    return runs, answers, end


def _answer(path: Path, number: int, found: Any) -> Given:
    given = _converted(path, f"answer {number}", found, Given)
    if given.number != number:
        raise InputError(path, f"answer {number}", f"bears the number {given.number}", REMEDY)
    return given


def _converted(path: Path, place: str, found: Any, kind: type[Read]) -> Read:
    try:
        return msgspec.convert(found, kind)
    except msgspec.ValidationError as error:
        raise InputError(path, place, str(error), REMEDY) from error

"""The ledger of a run: every trial, comparison and line, on the disk before anybody sees it.

``trials.jsonl`` is a journal (see `fdvv.eventlog`) with the records ``{"trial": …}`` of a suggestion,
``{"edit": …}`` of its design, ``{"state": …}`` of what became of it, ``{"pair": …}`` of two designs to be
compared, ``{"answer": …}`` of which was preferred, ``{"line": …}`` of designs in a row and ``{"choice": …}``
of which was liked best.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

import msgspec

from fdvv.errors import InputError
from fdvv.eventlog import Journal, JournalKind, read_bodies
from fdvv.optimize.problem import Answer, Comparison, Line, Trial, TrialState
from fdvv.optimize.space import Design
from fdvv.task.score import Score

LEDGER_FILE = "trials.jsonl"
REMEDY = "move the folder away and begin another run"
NEXT = {
    TrialState.SUGGESTED: frozenset(TrialState) - {TrialState.SUGGESTED},
    TrialState.SHOWN: frozenset({TrialState.DONE, TrialState.FAILED, TrialState.ABANDONED}),
}
"""What may follow a state; a trial that has come to an end stays as it is."""
Read = TypeVar("Read")


class Edited(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A person's own version of a suggestion."""

    number: int
    design: dict[str, float]


class TrialOutcome(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What became of a trial."""

    number: int
    state: TrialState
    scores: dict[str, Score] = {}
    reason: str = ""


class Answered(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Which of two was preferred."""

    number: int
    answer: Answer


class Chosen(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Which stop of a line is liked best."""

    number: int
    best: int


Suggested = Trial | Comparison | Line
Record = Suggested | Edited | TrialOutcome | Answered | Chosen
KIND = JournalKind(
    {
        "trial": Trial,
        "edit": Edited,
        "state": TrialOutcome,
        "pair": Comparison,
        "answer": Answered,
        "line": Line,
        "choice": Chosen,
    },
    REMEDY,
)


class Ledger:
    """Trials, comparisons and lines in memory, and on file for one process at a time if there is a path.

    Parameters
    ----------
    path : of the journal; its folder exists. None keeps all in memory.

    Attributes
    ----------
    warnings : what a person should know of the file.

    Raises InputError on a file that is damaged or at work elsewhere, OSError.
    """

    def __init__(self, path: Path | None = None) -> None:
        self._source: object = path or "ledger"
        self._trials: list[Trial] = []
        self._comparisons: list[Comparison] = []
        self._lines: list[Line] = []
        self._journal: Journal | None = None
        self.warnings: list[str] = []
        if path is not None:
            reason = "another process is at work on this run"
            busy = InputError(path.parent, "optimisation", reason, "close it first, or name another folder")
            self._journal = Journal.resume(path, KIND, busy, self._resume)
            if self._journal.torn:
                self.warnings.append(f"{path}: the last record is not whole and is left out")

    @property
    def trials(self) -> tuple[Trial, ...]:
        return tuple(self._trials)

    @property
    def comparisons(self) -> tuple[Comparison, ...]:
        return tuple(self._comparisons)

    @property
    def lines(self) -> tuple[Line, ...]:
        return tuple(self._lines)

    def suggest(self, design: Design, origin: str, rival: str = "") -> Trial:
        trial = Trial(len(self._trials), dict(design), origin=origin, rival=rival or msgspec.UNSET)
        self._keep("trial", trial)
        return trial

    def edit(self, number: int, design: Design) -> Trial:
        """Put a person's design in the place of a suggestion that nobody has tried yet. Raises InputError."""
        self._keep("edit", Edited(number, dict(design)))
        return self._trials[number]

    def become(
        self, number: int, state: TrialState, scores: dict[str, Score] | None = None, reason: str = ""
    ) -> Trial:
        """Write down what became of a trial. Raises InputError where that cannot follow what it was."""
        self._keep("state", TrialOutcome(number, state, scores or {}, reason))
        return self._trials[number]

    def pair(self, first: Design, second: Design) -> Comparison:
        comparison = Comparison(len(self._comparisons), dict(first), dict(second))
        self._keep("pair", comparison)
        return comparison

    def answer(self, number: int, answer: Answer | str) -> Comparison:
        """Write down which was preferred. Raises InputError where it was answered before."""
        self._keep("answer", Answered(number, Answer(answer)))
        return self._comparisons[number]

    def line(self, stops: Sequence[Design]) -> Line:
        line = Line(len(self._lines), tuple(dict(stop) for stop in stops))
        self._keep("line", line)
        return line

    def choose(self, number: int, best: int) -> Line:
        """Write down which stop is liked best. Raises InputError on no stop, and on a second answer."""
        self._keep("choice", Chosen(number, best))
        return self._lines[number]

    def _keep(self, key: str, body: Any) -> None:
        changed = self._changed(body)
        if self._journal:
            self._journal.write({key: msgspec.to_builtins(body)})
        self._put(changed)

    def _resume(self, _key: str, body: Record) -> None:
        try:
            self._put(self._changed(body))
        except InputError as error:  # the journal adds the line and what to do about a damaged file
            raise ValueError(f"{error.place}: {error.reason}") from error

    def _put(self, changed: Suggested) -> None:
        rows = self._rows(changed)
        # in the place of its number, or at the end
        rows[changed.number : changed.number + 1] = [changed]

    def _rows(self, body: Suggested) -> list[Any]:
        if isinstance(body, Line):
            return self._lines
        return self._trials if isinstance(body, Trial) else self._comparisons

    def _changed(self, body: Record) -> Suggested:
        """Return what was suggested as a record leaves it. Raises InputError where it cannot follow."""
        if isinstance(body, Trial | Comparison | Line):
            if body.number != (count := len(self._rows(body))):
                raise self._refusal(body.number, f"the next number is {count}")
            return body
        if isinstance(body, Answered):
            pair = self._at(self._comparisons, body.number)
            if pair.answer is not None:
                raise self._refusal(body.number, f"was answered: {pair.answer}")
            return replace(pair, answer=body.answer)
        if isinstance(body, Chosen):
            return self._chosen(body)
        trial = self._at(self._trials, body.number)
        if isinstance(body, Edited):
            if trial.state is not TrialState.SUGGESTED:
                raise self._refusal(trial.number, f"is {trial.state} and can no longer be edited")
            return replace(trial, design=body.design, suggested=trial.suggested or trial.design)
        if body.state not in NEXT.get(trial.state, frozenset()):
            raise self._refusal(trial.number, f"is {trial.state} and cannot become {body.state}")
        return replace(trial, state=body.state, scores=body.scores, reason=body.reason)

    def _chosen(self, body: Chosen) -> Line:
        line = self._at(self._lines, body.number)
        if line.best is not None:
            raise self._refusal(body.number, f"was answered: stop {line.best}")
        if not 0 <= body.best < len(line.stops):
            raise self._refusal(body.number, f"has stops 0 to {len(line.stops) - 1}, not {body.best}")
        return replace(line, best=body.best)

    def _at(self, rows: list[Read], number: int) -> Read:
        if not 0 <= number < len(rows):
            raise self._refusal(number, "there is no such trial")
        return rows[number]

    def _refusal(self, number: int, reason: str) -> InputError:
        return InputError(self._source, f"trial {number}", reason, "look at the list of trials")

    def close(self) -> None:
        if self._journal:
            self._journal.close()
            self._journal = None


def read_ledger(path: Path) -> Ledger:
    """Read all that is on file into memory; nothing is written, no lock taken. Raises InputError, OSError."""
    ledger = Ledger()
    for _, body, _ in read_bodies(path, KIND):
        ledger._put(ledger._changed(body))
    return ledger


Step = tuple[tuple[Trial, ...], tuple[Comparison, ...], tuple[Line, ...], Suggested]
"""Trials, comparisons and lines that were known, and what was suggested next."""


def steps_before(path: Path) -> Iterator[Step]:
    """Return every suggestion with what was known before it, for replay. Raises InputError, OSError."""
    ledger = Ledger()
    for _, body, _ in read_bodies(path, KIND):
        if isinstance(body, Trial | Comparison | Line):
            yield ledger.trials, ledger.comparisons, ledger.lines, body
        ledger._put(ledger._changed(body))

"""The ledger of a run: every trial, on the disk before anybody sees it.

``trials.jsonl`` is a journal (see `fdvv.eventlog`) with the records ``{"trial": …}`` of a suggestion,
``{"edit": …}`` of its design and ``{"state": …}`` of what became of it. An earlier fdvv wrote trials of which
the best design is chosen as ``{"pair": …}`` and ``{"line": …}``, and what was chosen as ``{"answer": …}`` and
``{"choice": …}``; each kind had numbers of its own.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import msgspec

from fdvv.errors import InputError
from fdvv.eventlog import Journal, JournalKind, read_bodies
from fdvv_people.optimize.problem import Answer, Trial, TrialState
from fdvv_people.optimize.space import Design
from fdvv_people.task.score import Score

LEDGER_FILE = "trials.jsonl"
REMEDY = "move the folder away and begin another run"
NEXT = {
    TrialState.SUGGESTED: frozenset(TrialState) - {TrialState.SUGGESTED},
    TrialState.SHOWN: frozenset({TrialState.DONE, TrialState.FAILED, TrialState.ABANDONED}),
}
"""What may follow a state; a trial that has come to an end stays as it is."""


class Edited(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A person's own version of a suggestion."""

    number: int
    design: dict[str, float]


class TrialOutcome(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What became of a trial. best : of its designs, where the best is chosen."""

    number: int
    state: TrialState
    scores: dict[str, Score] = {}
    reason: str = ""
    best: tuple[int, ...] | msgspec.UnsetType = msgspec.UNSET


class Pair(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Two designs that are compared, of an earlier fdvv. answer : in a record of its own, never here."""

    number: int
    first: dict[str, float]
    second: dict[str, float]
    answer: None = None

    @property
    def designs(self) -> tuple[dict[str, float], ...]:
        return self.first, self.second


class PairAnswer(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Which of two was preferred, of an earlier fdvv."""

    number: int
    answer: Answer

    @property
    def choice(self) -> tuple[int, ...]:
        return self.answer.best


class Line(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A line of an earlier fdvv.

    stops : its designs in a row. best : in a record of its own, never here.
    """

    number: int
    stops: tuple[dict[str, float], ...]
    best: None = None

    @property
    def designs(self) -> tuple[dict[str, float], ...]:
        return self.stops


class LineChoice(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Which design of a line is liked best, of an earlier fdvv."""

    number: int
    best: int

    @property
    def choice(self) -> tuple[int, ...]:
        return (self.best,)


EarlierRecord = Pair | PairAnswer | Line | LineChoice
Record = Trial | Edited | TrialOutcome
KIND = JournalKind(
    {
        "trial": Trial,
        "edit": Edited,
        "state": TrialOutcome,
        "pair": Pair,
        "answer": PairAnswer,
        "line": Line,
        "choice": LineChoice,
    },
    REMEDY,
)
LINES = "preference-line"
"""The only engine of lines that an earlier fdvv had; of its pairs the engine is not known."""


class Ledger:
    """Trials in memory, and on file for one process at a time if there is a path.

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

    def suggest(self, designs: Sequence[Design], origin: str, rival: str = "") -> Trial:
        """Write down the designs of the next trial: one to be scored, or several of which one is chosen."""
        design, *beside = map(dict, designs)
        number, others = len(self._trials), tuple(beside) or msgspec.UNSET
        trial = Trial(number, design, origin=origin, rival=rival or msgspec.UNSET, beside=others)
        return self._write("trial", trial)

    def edit(self, number: int, design: Design) -> Trial:
        """Put a person's design in the place of a suggestion that nobody has tried yet. Raises InputError."""
        return self._write("edit", Edited(number, dict(design)))

    def become(
        self,
        number: int,
        state: TrialState,
        scores: dict[str, Score] | None = None,
        reason: str = "",
        best: Sequence[int] = (),
    ) -> Trial:
        """Write down what became of a trial. Raises InputError where that cannot follow what it was."""
        outcome = TrialOutcome(number, state, scores or {}, reason, tuple(best) or msgspec.UNSET)
        return self._write("state", outcome)

    def _write(self, key: str, body: Record) -> Trial:
        changed = self._change(body)
        if self._journal:
            self._journal.write({key: msgspec.to_builtins(body)})
        return self._put(changed)

    def _resume(self, _key: str, body: Record | EarlierRecord) -> None:
        try:
            self.read(body)
        except InputError as error:  # the journal adds the line and what to do about a damaged file
            raise ValueError(f"{error.place}: {error.reason}") from error

    def read(self, body: Record | EarlierRecord) -> None:
        """Take over a record that is on file. Raises InputError where it cannot follow those before it."""
        self._put(self._change(self._renew(body) if isinstance(body, EarlierRecord) else body))

    def _put(self, changed: Trial) -> Trial:
        # in the place of its number, or at the end
        self._trials[changed.number : changed.number + 1] = [changed]
        return changed

    def _renew(self, body: EarlierRecord) -> Record:
        """Return a record of an earlier fdvv as it is written now."""
        origin = LINES if isinstance(body, Line | LineChoice) else ""
        numbers = [trial.number for trial in self._trials if trial.beside and trial.origin == origin]
        if isinstance(body, Pair | Line):
            if body.number != len(numbers):
                raise self._refusal(body.number, f"the next number is {len(numbers)}")
            design, *beside = body.designs
            return Trial(len(self._trials), design, origin=origin, beside=tuple(beside))
        if not 0 <= body.number < len(numbers):
            raise self._refusal(body.number, "there is no such trial")
        return TrialOutcome(numbers[body.number], TrialState.DONE, best=body.choice)

    def _change(self, body: Record) -> Trial:
        """Return a trial as a record leaves it. Raises InputError where it cannot follow."""
        if isinstance(body, Trial):
            if body.number != (count := len(self._trials)):
                raise self._refusal(body.number, f"the next number is {count}")
            return body
        if not 0 <= body.number < len(self._trials):
            raise self._refusal(body.number, "there is no such trial")
        trial = self._trials[body.number]
        if isinstance(body, Edited):
            if trial.state is not TrialState.SUGGESTED or trial.beside:
                why = "has several designs" if trial.beside else f"is {trial.state}"
                raise self._refusal(trial.number, f"{why} and can no longer be edited")
            return replace(trial, design=body.design, suggested=trial.suggested or trial.design)
        if body.state not in NEXT.get(trial.state, frozenset()):
            before = f"is {trial.state}" if trial.best is msgspec.UNSET else "was answered"
            raise self._refusal(trial.number, f"{before} and cannot become {body.state}")
        last = len(trial.designs) - 1
        if body.best and not all(0 <= place <= last for place in body.best):
            raise self._refusal(trial.number, f"has designs 0 to {last}, not {max(body.best, key=abs)}")
        return replace(trial, state=body.state, scores=body.scores, reason=body.reason, best=body.best)

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
        ledger.read(body)
    return ledger


def steps_before(path: Path) -> Iterator[tuple[tuple[Trial, ...], Trial]]:
    """Return every suggestion with the trials before it, for replay. Raises InputError, OSError."""
    ledger = Ledger()
    for _, body, _ in read_bodies(path, KIND):
        before = ledger.trials
        ledger.read(body)
        if isinstance(body, Trial | Pair | Line):
            yield before, ledger.trials[-1]

"""The ledger of a run: every trial and comparison, on the disk before anybody sees it.

``trials.jsonl`` is a journal (see `fdvv.journal`) with the records ``{"trial": …}`` of a suggestion,
``{"edit": …}`` of its design, ``{"state": …}`` of what became of it, ``{"pair": …}`` of two designs to be
compared and ``{"answer": …}`` of which was preferred.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal, TypeVar

import msgspec

from fdvv.errors import InputError, ModelError
from fdvv.journal import Journal, JournalKind, read_records
from fdvv.optimize._space import Design
from fdvv.optimize._trial import Answer, Comparison, Score, Trial, TrialState

REMEDY = "move the folder away and begin another run"
KIND = JournalKind(frozenset({"trial", "edit", "state", "pair", "answer"}), REMEDY)
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


class Became(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What became of a trial."""

    number: int
    state: TrialState
    scores: dict[str, Score] = {}
    reason: str = ""


class Answered(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Which of two was preferred."""

    number: int
    answer: Answer


Step = tuple[Literal["trial", "edit", "state", "pair", "answer"], Any]


class Ledger:
    """Trials and comparisons in memory, and on file for one process at a time if there is a path.

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
        self._journal: Journal | None = None
        self.warnings: list[str] = []
        if path is not None:
            reason = "another process is at work on this run"
            busy = InputError(path.parent, "optimisation", reason, "close it first, or name another folder")
            self._journal = Journal(path, busy)
            try:
                self._learn(path, self._journal)
            except BaseException:
                self.close()
                raise

    def _learn(self, path: Path, journal: Journal) -> None:
        end = 0
        for count, (record, after) in enumerate(read_records(path, KIND), 1):
            ((kind, body),) = record.items()
            try:
                self._take(step_of(kind, body))
            except (msgspec.ValidationError, ModelError, InputError) as error:
                raise InputError(path, f"record {count}", str(error), REMEDY) from error
            end = after
        if journal.cut(end):
            self.warnings.append(f"{path}: the last record is not whole and is left out")

    @property
    def trials(self) -> tuple[Trial, ...]:
        """Get all trials, by number."""
        return tuple(self._trials)

    @property
    def comparisons(self) -> tuple[Comparison, ...]:
        """Get all comparisons, by number."""
        return tuple(self._comparisons)

    def suggest(self, design: Design, origin: str) -> Trial:
        """Write down a trial; only then may it be shown."""
        trial = Trial(len(self._trials), dict(design), origin=origin)
        self._keep(("trial", trial))
        return trial

    def edit(self, number: int, design: Design) -> Trial:
        """Put a person's design in the place of a suggestion that nobody has tried yet. InputError."""
        self._keep(("edit", Edited(number, dict(design))))
        return self._trials[number]

    def become(
        self, number: int, state: TrialState, scores: dict[str, Score] | None = None, reason: str = ""
    ) -> Trial:
        """Write down what became of a trial. InputError where that cannot follow what it was."""
        self._keep(("state", Became(number, state, scores or {}, reason)))
        return self._trials[number]

    def pair(self, first: Design, second: Design) -> Comparison:
        """Write down two designs to be compared."""
        comparison = Comparison(len(self._comparisons), dict(first), dict(second))
        self._keep(("pair", comparison))
        return comparison

    def answer(self, number: int, answer: Answer | str) -> Comparison:
        """Write down which was preferred. InputError where it was answered before."""
        self._keep(("answer", Answered(number, Answer(answer))))
        return self._comparisons[number]

    def _keep(self, step: Step) -> None:
        """Check a step, bring it to the disk, and only then count it."""
        changed = self._changed(step)
        if self._journal:
            self._journal.write({step[0]: msgspec.to_builtins(step[1])})
        self._put(changed)

    def _take(self, step: Step) -> None:
        self._put(self._changed(step))

    def _put(self, changed: Trial | Comparison) -> None:
        rows: list[Any] = self._trials if isinstance(changed, Trial) else self._comparisons
        rows[changed.number : changed.number + 1] = [changed]

    def _changed(self, step: Step) -> Trial | Comparison:
        """Give the trial or comparison as the step leaves it. InputError where it cannot be taken."""
        kind, body = step
        if kind in ("trial", "pair"):
            rows: list[Any] = self._trials if kind == "trial" else self._comparisons
            if body.number != len(rows):
                raise self._refusal(body.number, f"the next number is {len(rows)}")
            return body  # type: ignore[no-any-return]
        if kind == "answer":
            pair = self._at(self._comparisons, body.number)
            if pair.answer is not None:
                raise self._refusal(body.number, f"was answered: {pair.answer}")
            return replace(pair, answer=body.answer)
        return self._changed_trial(self._at(self._trials, body.number), body)

    def _changed_trial(self, trial: Trial, body: Edited | Became) -> Trial:
        if isinstance(body, Edited):
            if trial.state is not TrialState.SUGGESTED:
                raise self._refusal(trial.number, f"is {trial.state} and can no longer be edited")
            first = trial.suggested or trial.design
            return replace(trial, design=body.design, suggested=first)
        if body.state not in NEXT.get(trial.state, frozenset()):
            raise self._refusal(trial.number, f"is {trial.state} and cannot become {body.state}")
        return replace(trial, state=body.state, scores=body.scores, reason=body.reason)

    def _at(self, rows: list[Read], number: int) -> Read:
        if not 0 <= number < len(rows):
            raise self._refusal(number, "there is no such trial")
        return rows[number]

    def _refusal(self, number: int, reason: str) -> InputError:
        return InputError(self._source, f"trial {number}", reason, "look at the list of trials")

    def close(self) -> None:
        """Let go of the file; a second time does nothing."""
        if self._journal:
            self._journal.close()
            self._journal = None


def step_of(kind: str, body: Any) -> Step:
    """Read a record's body. msgspec.ValidationError."""
    kinds = {"trial": Trial, "edit": Edited, "state": Became, "pair": Comparison, "answer": Answered}
    return kind, msgspec.convert(body, kinds[kind])  # type: ignore[return-value]


@dataclass(frozen=True)
class Known:
    """What a ledger held at a moment."""

    trials: tuple[Trial, ...]
    comparisons: tuple[Comparison, ...]


def steps_before(path: Path) -> Iterator[tuple[Known, Trial | Comparison]]:
    """Give every suggestion with what was known before it, for replay. InputError, OSError."""
    ledger = Ledger()
    for record, _ in read_records(path, KIND):
        ((kind, body),) = record.items()
        step = step_of(kind, body)
        if kind in ("trial", "pair"):
            yield Known(ledger.trials, ledger.comparisons), step[1]
        ledger._take(step)

"""The journal of a draft: the model it began with, then every change, each on the disk before it counts.

``<name>.draft.jsonl`` is a journal (see `fdvv.journal`) with the record ``{"base": …}`` first, then
``{"change": …}`` in the order they were made. The revision of a draft counts its changes.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal

import msgspec
from msgspec import Struct

from fdvv.errors import InputError, ModelError
from fdvv.journal import Journal, JournalKind, read_records
from fdvv.workflow._draft_history import DraftChange, DraftHistory
from fdvv.workflow._draft_patch import Record, canonical

DRAFT_SUFFIX = ".draft.jsonl"
REMEDY = "move the draft away; the model file beside it stands for itself"
KIND = JournalKind(frozenset({"base", "change"}), REMEDY)


class Base(Struct, frozen=True, forbid_unknown_fields=True):
    """What a draft begins with."""

    model: dict[str, Any]
    time_s: float
    format: Literal["fdvv-draft"] = "fdvv-draft"
    version: Literal[1] = 1


class DraftLog:
    """A draft in memory and on file, for one process at a time.

    Parameters
    ----------
    path : of the journal; its folder exists.

    Attributes
    ----------
    history : None until the draft has a base.
    revision : how many changes were made.

    Raises InputError on a journal that is damaged or at work elsewhere, OSError.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        busy = InputError(path.name, "whole file", "another fdvv works on it", "close the other studio first")
        self._journal = Journal(path, busy)
        self.history: DraftHistory | None = None
        self.revision = 0
        self._known: dict[str, int] = {}
        try:
            self._journal.cut(self._read())
        except BaseException:
            self._journal.close()
            raise

    def _read(self) -> int:
        end = 0
        for record, after in read_records(self.path, KIND):
            try:
                self._take(record)
            except (msgspec.ValidationError, ModelError, InputError) as error:
                place = f"record {self.revision + 2}"
                raise InputError(self.path.name, place, str(error), REMEDY) from error
            end = after
        return end

    def _take(self, record: dict[str, Any]) -> None:
        if "base" in record:
            base = msgspec.convert(record["base"], Base)
            model = canonical(base.model)
            self.history = DraftHistory(model, model)
            return
        change = msgspec.convert(record["change"], DraftChange)
        if self.history is None:
            raise ModelError("a change without a model before it")
        self._count(change, self.history.after(change))

    def _count(self, change: DraftChange, history: DraftHistory) -> None:
        self.history = history
        self.revision += 1
        self._known[change.change_id] = self.revision

    def begin(self, model: Record, time_s: float) -> None:
        """Write what the draft begins with."""
        self._journal.write({"base": msgspec.to_builtins(Base(model, time_s))})
        self.history = DraftHistory(model, model)

    def revision_of(self, change_id: str) -> int | None:
        """Tell the revision that a change made; None if it is not known."""
        return self._known.get(change_id)

    def write(self, change: DraftChange, history: DraftHistory) -> None:
        """Keep a change that leads to a history; it is on the disk when this returns."""
        self._journal.write({"change": msgspec.to_builtins(change)})
        self._count(change, history)

    def was(self, record: Record) -> bool:
        """Tell whether the model was once as this record says."""
        if self.history is None:
            return False
        fresh = DraftHistory(self.history.opening, self.history.opening)
        for found, _ in read_records(self.path, KIND):
            if "change" in found:
                fresh = fresh.after(msgspec.convert(found["change"], DraftChange))
            if fresh.record == record:
                return True
        return False

    def close(self) -> None:
        """Let go of the file."""
        self._journal.close()

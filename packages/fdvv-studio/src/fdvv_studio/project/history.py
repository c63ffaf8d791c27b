"""The edit history of a button, in memory and as a journal; `web/src/model/history.ts` is its twin.

``<name>.draft.jsonl`` is a journal (see `fdvv.eventlog`): first ``{"base": …}``, the initial model, then
``{"change": …}`` in the order they were made, each on the disk before it counts. The revision of a document
is the number of its changes.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import reduce
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta, Struct

from fdvv.errors import InputError, ModelError
from fdvv.eventlog import Journal, JournalKind, read_records
from fdvv_studio.project.patch import Patch, Record, apply_patch, canonical, inverse_patch

Label = Annotated[str, Meta(max_length=400)]
ChangeId = Annotated[str, Meta(min_length=1, max_length=64)]
Count = Annotated[int, Meta(ge=1)]


class EditMade(Struct, frozen=True, forbid_unknown_fields=True, tag_field="type", tag="edit"):
    """An edit. joins : it belongs to the step before it. time_s : when it was made, since 1970."""

    change_id: ChangeId
    label: Label
    patch: Patch
    joins: bool
    time_s: float


class UndoMade(Struct, frozen=True, forbid_unknown_fields=True, tag_field="type", tag="undo"):
    """Steps taken back."""

    change_id: ChangeId
    count: Count


class RedoMade(Struct, frozen=True, forbid_unknown_fields=True, tag_field="type", tag="redo"):
    """Steps done again."""

    change_id: ChangeId
    count: Count


class PinMade(Struct, frozen=True, forbid_unknown_fields=True, tag_field="type", tag="pin"):
    """The present state, kept to compare with."""

    change_id: ChangeId
    label: Label


class UnpinMade(Struct, frozen=True, forbid_unknown_fields=True, tag_field="type", tag="unpin"):
    """A pin let go; index counts the pins from 0."""

    change_id: ChangeId
    index: Annotated[int, Meta(ge=0)]


HistoryChange = EditMade | UndoMade | RedoMade | PinMade | UnpinMade
"""What can happen to a document, as its journal keeps it."""


class EditStep(Struct, frozen=True):
    """One step of undo: patches in the order they were made, and when the last was."""

    label: str
    patches: list[Patch]
    time_s: float


class EditPin(Struct, frozen=True):
    """A state to compare with."""

    label: str
    model: dict[str, Any]


class EditHistory(Struct, frozen=True):
    """A button and everything that was done to it; changes give another one.

    Attributes
    ----------
    opening : the model before the first step.
    record : the model now.
    steps, done : all steps, and how many of them are done; those behind can be redone.
    """

    opening: Record
    record: Record
    steps: tuple[EditStep, ...] = ()
    done: int = 0
    pins: tuple[EditPin, ...] = ()

    def after(self, change: HistoryChange) -> EditHistory:
        """Make a change. ModelError if a patch does not fit, InputError if there is no such step or pin."""
        replace = msgspec.structs.replace
        match change:
            case EditMade():
                return self._edit(change)
            case UndoMade(count=count):
                record = reduce(apply_patch, self._back(count), self.record)
                return replace(self, record=record, done=self.done - count)
            case RedoMade(count=count):
                record = reduce(apply_patch, self._forth(count), self.record)
                return replace(self, record=record, done=self.done + count)
            case PinMade(label=label):
                return replace(self, pins=(*self.pins, EditPin(label, self.record)))
            case UnpinMade(index=index):
                _check(index < len(self.pins), f"there is no pin {index + 1}")
                return replace(self, pins=(*self.pins[:index], *self.pins[index + 1 :]))

    def _edit(self, edit: EditMade) -> EditHistory:
        joins = edit.joins and 0 < self.done == len(self.steps)
        kept = self.steps[: self.done - joins]
        patches = [*self.steps[self.done - 1].patches, edit.patch] if joins else [edit.patch]
        steps = (*kept, EditStep(edit.label, patches, edit.time_s))
        record = apply_patch(self.record, edit.patch)
        return msgspec.structs.replace(self, record=record, steps=steps, done=len(steps))

    def _back(self, count: int) -> Iterator[Patch]:
        _check(count <= self.done, f"there are {self.done} steps to undo, not {count}")
        for step in self.steps[self.done - count : self.done][::-1]:
            yield from map(inverse_patch, step.patches[::-1])

    def _forth(self, count: int) -> Iterator[Patch]:
        rest = len(self.steps) - self.done
        _check(count <= rest, f"there are {rest} steps to redo, not {count}")
        for step in self.steps[self.done : self.done + count]:
            yield from step.patches


def _check(holds: bool, reason: str) -> None:
    if not holds:
        raise InputError("studio", "history", reason, "open the button again")


JOURNAL_SUFFIX = ".draft.jsonl"
REMEDY = "move the journal away; the model file beside it is complete"
KIND = JournalKind({"base": Any, "change": Any}, REMEDY)


class DocumentBase(Struct, frozen=True, forbid_unknown_fields=True):
    """The initial model of a document."""

    model: dict[str, Any]
    time_s: float
    format: Literal["fdvv-draft"] = "fdvv-draft"
    version: Literal[1] = 1


class DocumentLog:
    """An edit history in memory and on file, for one process at a time.

    Parameters
    ----------
    path : of the journal; its folder exists.

    Attributes
    ----------
    history : None until there is a base.
    revision : how many changes were made.

    Raises InputError on a journal that is damaged or at work elsewhere, OSError.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        busy = InputError(path.name, "whole file", "another fdvv works on it", "close the other studio first")
        self._journal = Journal(path, busy)
        self.history: EditHistory | None = None
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
            base = msgspec.convert(record["base"], DocumentBase)
            model = canonical(base.model)
            self.history = EditHistory(model, model)
            return
        change = msgspec.convert(record["change"], HistoryChange)
        if self.history is None:
            raise ModelError("a change without a model before it")
        self._count(change, self.history.after(change))

    def _count(self, change: HistoryChange, history: EditHistory) -> None:
        self.history = history
        self.revision += 1
        self._known[change.change_id] = self.revision

    def begin(self, model: Record, time_s: float) -> None:
        """Write the initial model."""
        self._journal.write({"base": msgspec.to_builtins(DocumentBase(model, time_s))})
        self.history = EditHistory(model, model)

    def revision_of(self, change_id: str) -> int | None:
        """Return the revision that a change made; None if it is not known."""
        return self._known.get(change_id)

    def write(self, change: HistoryChange, history: EditHistory) -> None:
        """Keep a change that leads to a history; it is on the disk when this returns."""
        self._journal.write({"change": msgspec.to_builtins(change)})
        self._count(change, history)

    def was(self, record: Record) -> bool:
        """Return whether the model once equalled this record."""
        if self.history is None:
            return False
        fresh = EditHistory(self.history.opening, self.history.opening)
        for body, _ in read_records(self.path, KIND):
            if "change" in body:
                fresh = fresh.after(msgspec.convert(body["change"], HistoryChange))
            if fresh.record == record:
                return True
        return False

    def close(self) -> None:
        self._journal.close()

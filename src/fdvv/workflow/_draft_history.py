"""What was done to a button, as a line of steps and a place in it; `web/src/model/history.ts` is its twin."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any

import msgspec
from msgspec import Meta, Struct

from fdvv.errors import InputError
from fdvv.workflow._draft_patch import Patch, Record, apply_patch, inverse_patch

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


DraftChange = EditMade | UndoMade | RedoMade | PinMade | UnpinMade
"""What can happen to a draft, as its journal keeps it."""


class DraftStep(Struct, frozen=True):
    """One step of undo: patches in the order they were made, and when the last was."""

    label: str
    patches: list[Patch]
    time_s: float


class DraftPin(Struct, frozen=True):
    """A state to compare with."""

    label: str
    model: dict[str, Any]


class DraftHistory(Struct, frozen=True):
    """A button and everything that was done to it; changes give another one.

    Attributes
    ----------
    opening : the model before the first step.
    record : the model now.
    steps, done : all steps, and how many of them are done; those behind can be redone.
    """

    opening: Record
    record: Record
    steps: tuple[DraftStep, ...] = ()
    done: int = 0
    pins: tuple[DraftPin, ...] = ()

    def after(self, change: DraftChange) -> DraftHistory:
        """Make a change. ModelError if a patch does not fit, InputError if there is no such step or pin."""
        replace = msgspec.structs.replace
        match change:
            case EditMade():
                return self._edited(change)
            case UndoMade(count=count):
                record = self.record
                for patch in self._back(count):
                    record = apply_patch(record, patch)
                return replace(self, record=record, done=self.done - count)
            case RedoMade(count=count):
                record = self.record
                for patch in self._forth(count):
                    record = apply_patch(record, patch)
                return replace(self, record=record, done=self.done + count)
            case PinMade(label=label):
                return replace(self, pins=(*self.pins, DraftPin(label, self.record)))
            case UnpinMade(index=index):
                _check(index < len(self.pins), f"there is no pin {index + 1}")
                return replace(self, pins=(*self.pins[:index], *self.pins[index + 1 :]))

    def _edited(self, edit: EditMade) -> DraftHistory:
        joins = edit.joins and 0 < self.done == len(self.steps)
        kept = self.steps[: self.done - joins]
        patches = [*self.steps[self.done - 1].patches, edit.patch] if joins else [edit.patch]
        steps = (*kept, DraftStep(edit.label, patches, edit.time_s))
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

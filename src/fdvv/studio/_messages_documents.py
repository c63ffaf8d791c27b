"""Messages about a person's own buttons: opened, edited, named."""

from __future__ import annotations

from typing import Annotated, Any

from msgspec import Meta, Struct

from fdvv.workflow import DraftChange, DraftPin, DraftStep, ModelTemplate

ButtonId = Annotated[str, Meta(min_length=1, max_length=300)]
ButtonName = Annotated[str, Meta(max_length=300)]


class DocumentAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask for a button with its history; one that is not the person's own has none."""

    button: ButtonId


class Document(Struct, frozen=True):
    """A button and what was done to it.

    editable : whether it is the person's own; another one is copied first. revision : counts its changes.
    opening : the model before the first step. done : how many of the steps are done.
    """

    button: str
    editable: bool
    revision: int
    opening: dict[str, Any]
    steps: list[DraftStep]
    done: int
    pins: list[DraftPin]


class DocumentChange(Struct, frozen=True, forbid_unknown_fields=True):
    """Change a button; revision is the one the change was made on."""

    button: ButtonId
    revision: Annotated[int, Meta(ge=0)]
    change: DraftChange


class DocumentAnswer(Struct, frozen=True):
    """What became of a change: the newest revision; where it was refused, the button as others left it."""

    revision: int
    conflict: Document | None


class DocumentCopy(Struct, frozen=True, forbid_unknown_fields=True):
    """Copy any button to one of the person's own; a name near that of the button if none is given."""

    button: ButtonId
    name: ButtonName | None


class DocumentCreate(Struct, frozen=True, forbid_unknown_fields=True):
    """Make a button of one's own from a template, or from a model; without a name one is found."""

    name: ButtonName | None
    template: ModelTemplate | None
    model: dict[str, Any] | None


class DocumentRename(Struct, frozen=True, forbid_unknown_fields=True):
    """Give one's own button another name."""

    button: ButtonId
    name: ButtonName


class DocumentDelete(Struct, frozen=True, forbid_unknown_fields=True):
    """Move one's own button to the project's trash."""

    button: ButtonId


class DocumentNamed(Struct, frozen=True):
    """The button that a call made, renamed or deleted."""

    button: str


class DocumentListAsk(Struct, frozen=True, forbid_unknown_fields=True):
    """Ask for the person's own buttons."""


class DocumentRow(Struct, frozen=True):
    """A button of one's own; changed_s : when, since 1970."""

    button: str
    name: str
    changed_s: float
    size_bytes: int


class DocumentRows(Struct, frozen=True):
    """The person's own buttons, the one changed last first."""

    rows: list[DocumentRow]


class DocumentsWatch(Struct, frozen=True, forbid_unknown_fields=True, tag_field="type", tag="watch"):
    """Tell of every change of any button from now on."""


class DocumentsWatching(Struct, frozen=True, tag_field="type", tag="watching"):
    """The watch is in force: what changes from here on is told."""


class DocumentChanged(Struct, frozen=True, tag_field="type", tag="changed"):
    """A button has a new revision; 0 if it is new."""

    button: str
    revision: int


class DocumentGone(Struct, frozen=True, tag_field="type", tag="gone"):
    """A button was deleted, or has another name now."""

    button: str
    renamed_to: str | None

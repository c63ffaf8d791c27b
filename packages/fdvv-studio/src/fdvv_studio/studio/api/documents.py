"""The editor's documents: a person's own buttons, opened, edited, named."""

from __future__ import annotations

from typing import Annotated, Any

from msgspec import Meta, Struct

from fdvv.errors import InputError
from fdvv_studio.project.documents import ChangeSaved, DocumentState, DocumentStore
from fdvv_studio.project.history import EditPin, EditStep, HistoryChange
from fdvv_studio.project.new_document import ModelTemplate, new_model
from fdvv_studio.project.patch import model_of, record_of
from fdvv_studio.studio.contract import Empty, Message, Watchers, call, watch_channel
from fdvv_studio.studio.studio import Studio

ButtonId = Annotated[str, Meta(min_length=1, max_length=300)]
ButtonName = Annotated[str, Meta(max_length=300)]


class DocumentAsk(Message):
    """Name a button."""

    button: ButtonId


class Document(Message):
    """A button and what was done to it.

    editable : whether it is the person's own; another one is copied first. revision : counts its changes.
    opening : the model before the first step. done : how many of the steps are done.
    """

    button: str
    editable: bool
    revision: int
    opening: dict[str, Any]
    steps: list[EditStep]
    done: int
    pins: list[EditPin]


class DocumentChange(DocumentAsk):
    """Change a button; revision is the one the change was made on."""

    revision: Annotated[int, Meta(ge=0)]
    change: HistoryChange


class DocumentAnswer(Message):
    """What became of a change: the newest revision; where it was refused, the button as others left it."""

    revision: int
    conflict: Document | None


class DocumentCopy(DocumentAsk):
    """Copy any button to one of the person's own; a name near that of the button if none is given."""

    name: ButtonName | None


class DocumentCreate(Message):
    """Make a button of one's own from a template, or from a model; without a name one is found."""

    name: ButtonName | None
    template: ModelTemplate | None
    model: dict[str, Any] | None


class DocumentRename(DocumentAsk):
    """Rename one's own button."""

    name: ButtonName


class DocumentNamed(Message):
    """The button that a call made, renamed or deleted."""

    button: str


class DocumentRow(Message):
    """A button of one's own; changed_s : when, since 1970."""

    button: str
    name: str
    changed_s: float
    size_bytes: int


class DocumentRows(Message):
    """The person's own buttons, the one changed last first."""

    rows: list[DocumentRow]


class DocumentChanged(Message, tag_field="type", tag="changed"):
    """A button has a new revision; 0 if it is new."""

    button: str
    revision: int


class DocumentGone(Message, tag_field="type", tag="gone"):
    """A button was deleted, or has another name now."""

    button: str
    renamed_to: str | None


OWN = "own:"


class Documents:
    """The project's documents, and the pages that follow them."""

    def __init__(self, studio: Studio) -> None:
        self.store = DocumentStore(studio.project)
        self.watchers = Watchers[Struct]()

    def close(self) -> None:
        self.store.close()


def _own_name(button: str) -> str:
    """Return the name of an own button; the store looks it up."""
    if not button.startswith(OWN):
        raise InputError("studio", button, "only your own buttons can be edited", "copy it first")
    return button.removeprefix(OWN)


def _document(state: DocumentState) -> Document:
    history = state.history
    steps, pins = list(history.steps), list(history.pins)
    return Document(OWN + state.name, True, state.revision, history.opening, steps, history.done, pins)


@call("document.open")
def open_document(studio: Studio, ask: DocumentAsk) -> Document:
    """Open any button with its history; one that is not the person's own has none."""
    if ask.button.startswith(OWN):
        return _document(studio.part(Documents).store.open(_own_name(ask.button)))
    return Document(ask.button, False, 0, record_of(studio.catalog.model(ask.button)), [], 0, [])


@call("document.change")
def change_document(documents: Documents, ask: DocumentChange) -> DocumentAnswer:
    outcome = documents.store.change(_own_name(ask.button), ask.revision, ask.change)
    if isinstance(outcome, ChangeSaved):
        documents.watchers.tell(DocumentChanged(ask.button, outcome.revision))
        return DocumentAnswer(outcome.revision, None)
    return DocumentAnswer(outcome.head.revision, _document(outcome.head))


@call("document.copy")
def copy_document(studio: Studio, ask: DocumentCopy) -> DocumentNamed:
    store = studio.part(Documents).store
    if ask.button.startswith(OWN):
        model = model_of(store.open(_own_name(ask.button)).history.record, ask.button)
    else:
        model = studio.catalog.model(ask.button)
    # the original stays: two buttons of one name would look the same in every list
    name = ask.name if ask.name is not None else store.free_name(model.name, [model.name])
    return _new(studio, store.create(name, model))


@call("document.create")
def create_document(studio: Studio, ask: DocumentCreate) -> DocumentNamed:
    store = studio.part(Documents).store
    if ask.model is not None:
        model = model_of(ask.model, "model")
    else:
        model = new_model("my button", ask.template or ModelTemplate.TACTILE)
    name = ask.name if ask.name is not None else store.free_name(model.name)
    return _new(studio, store.create(name, model))


def _new(studio: Studio, name: str) -> DocumentNamed:
    studio.part(Documents).watchers.tell(DocumentChanged(OWN + name, 0))
    return DocumentNamed(OWN + name)


@call("document.rename")
def rename_document(documents: Documents, ask: DocumentRename) -> DocumentNamed:
    button = OWN + documents.store.rename(_own_name(ask.button), ask.name)
    if button != ask.button:
        documents.watchers.tell(DocumentGone(ask.button, button))
    return DocumentNamed(button)


@call("document.delete")
def delete_document(documents: Documents, ask: DocumentAsk) -> DocumentNamed:
    """Move one's own button to the project's trash."""
    documents.store.delete(_own_name(ask.button))
    documents.watchers.tell(DocumentGone(ask.button, None))
    return DocumentNamed(ask.button)


@call("document.list")
def list_documents(documents: Documents, _ask: Empty) -> DocumentRows:
    files = documents.store.list()
    return DocumentRows([DocumentRow(OWN + f.name, f.name, f.changed_s, f.size_bytes) for f in files])


CHANNEL = watch_channel("documents", Documents, DocumentChanged, DocumentGone)

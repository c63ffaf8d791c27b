"""A person's own buttons: calls over `fdvv.workflow.Drafts`, and news of them for every open page."""

from __future__ import annotations

from msgspec import Struct

from fdvv.errors import InputError
from fdvv.studio._contract import Call, ChannelKind, Tell
from fdvv.studio._messages_documents import (
    Document,
    DocumentAnswer,
    DocumentAsk,
    DocumentChange,
    DocumentChanged,
    DocumentCopy,
    DocumentCreate,
    DocumentDelete,
    DocumentGone,
    DocumentListAsk,
    DocumentNamed,
    DocumentRename,
    DocumentRow,
    DocumentRows,
    DocumentsWatch,
    DocumentsWatching,
)
from fdvv.studio._studio import Studio
from fdvv.studio._watchers import Watchers
from fdvv.workflow import DraftKept, Drafts, DraftState, ModelTemplate, model_of, new_model, record_of

OWN = "own:"


class Documents:
    """The project's drafts, and the pages that want to know of them."""

    def __init__(self, studio: Studio) -> None:
        self.drafts = Drafts(studio.project)
        self.watchers = Watchers[Struct]()

    def close(self) -> None:
        """Let go of the project."""
        self.drafts.close()


class DocumentsChannel:
    """One page that follows the documents."""

    def __init__(self, studio: Studio, tell: Tell) -> None:
        self._documents, self._tell = studio.part(Documents), tell

    def receive(self, _ask: DocumentsWatch) -> None:
        """Begin."""
        self._documents.watchers.watch(self._tell)
        self._tell(DocumentsWatching())

    def close(self) -> None:
        """End."""
        self._documents.watchers.forget(self._tell)


def _own_name(button: str) -> str:
    """Give the name of an own button; the drafts look it up."""
    if not button.startswith(OWN):
        raise InputError("studio", button, "only your own buttons can be edited", "copy it first")
    return button.removeprefix(OWN)


def _document(state: DraftState) -> Document:
    history = state.history
    steps, pins = list(history.steps), list(history.pins)
    return Document(OWN + state.name, True, state.revision, history.opening, steps, history.done, pins)


def open_document(studio: Studio, ask: DocumentAsk) -> Document:
    """Open any button; only one's own has a history."""
    if ask.button.startswith(OWN):
        return _document(studio.part(Documents).drafts.open(_own_name(ask.button)))
    return Document(ask.button, False, 0, record_of(studio.shelf.model(ask.button)), [], 0, [])


def change_document(studio: Studio, ask: DocumentChange) -> DocumentAnswer:
    """Make a change, or answer with the button as others left it."""
    documents = studio.part(Documents)
    found = documents.drafts.change(_own_name(ask.button), ask.revision, ask.change)
    if isinstance(found, DraftKept):
        documents.watchers.tell(DocumentChanged(ask.button, found.revision))
        return DocumentAnswer(found.revision, None)
    return DocumentAnswer(found.head.revision, _document(found.head))


def copy_document(studio: Studio, ask: DocumentCopy) -> DocumentNamed:
    """Copy any button to one's own."""
    drafts = studio.part(Documents).drafts
    if ask.button.startswith(OWN):
        model = model_of(drafts.open(_own_name(ask.button)).history.record, ask.button)
    else:
        model = studio.shelf.model(ask.button)
    name = ask.name if ask.name is not None else drafts.free_name(model.name)
    return _new(studio, drafts.create(name, model))


def create_document(studio: Studio, ask: DocumentCreate) -> DocumentNamed:
    """Make a button from a model that the page has, or from a template."""
    drafts = studio.part(Documents).drafts
    if ask.model is not None:
        model = model_of(ask.model, "model")
    else:
        model = new_model("my button", ask.template or ModelTemplate.TACTILE)
    name = ask.name if ask.name is not None else drafts.free_name(model.name)
    return _new(studio, drafts.create(name, model))


def _new(studio: Studio, name: str) -> DocumentNamed:
    studio.part(Documents).watchers.tell(DocumentChanged(OWN + name, 0))
    return DocumentNamed(OWN + name)


def rename_document(studio: Studio, ask: DocumentRename) -> DocumentNamed:
    """Rename one's own button."""
    documents = studio.part(Documents)
    button = OWN + documents.drafts.rename(_own_name(ask.button), ask.name)
    if button != ask.button:
        documents.watchers.tell(DocumentGone(ask.button, button))
    return DocumentNamed(button)


def delete_document(studio: Studio, ask: DocumentDelete) -> DocumentNamed:
    """Move one's own button to the trash."""
    documents = studio.part(Documents)
    documents.drafts.delete(_own_name(ask.button))
    documents.watchers.tell(DocumentGone(ask.button, None))
    return DocumentNamed(ask.button)


def list_documents(studio: Studio, _ask: DocumentListAsk) -> DocumentRows:
    """List one's own buttons."""
    files = studio.part(Documents).drafts.list()
    return DocumentRows([DocumentRow(OWN + f.name, f.name, f.changed_s, f.size_bytes) for f in files])


CALLS = (
    Call("document.open", DocumentAsk, Document, open_document),
    Call("document.change", DocumentChange, DocumentAnswer, change_document),
    Call("document.copy", DocumentCopy, DocumentNamed, copy_document),
    Call("document.create", DocumentCreate, DocumentNamed, create_document),
    Call("document.rename", DocumentRename, DocumentNamed, rename_document),
    Call("document.delete", DocumentDelete, DocumentNamed, delete_document),
    Call("document.list", DocumentListAsk, DocumentRows, list_documents),
)
TELLS = (DocumentsWatching, DocumentChanged, DocumentGone)
CHANNELS = (ChannelKind("documents", (DocumentsWatch,), TELLS, DocumentsChannel),)

"""The buttons of a person's own, in a project folder: created, edited, renamed, deleted, never lost.

``buttons/<name>.fdvv.json`` are the models, ``drafts/<name>.draft.jsonl`` their edit histories (see
`fdvv_studio.project.history`), ``trash`` holds what was deleted.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from threading import RLock
from uuid import uuid4

from fdvv.errors import InputError
from fdvv.eventlog import Journal
from fdvv.io.files import sync_folder, write_atomic
from fdvv.model.file import MODEL_SUFFIX, load_model, model_to_json, save_model
from fdvv.model.model import FDVVModel
from fdvv_studio.library.catalog import BUTTONS
from fdvv_studio.project.history import JOURNAL_SUFFIX, DocumentLog, EditHistory, EditMade, HistoryChange
from fdvv_studio.project.new_document import check_name, free_name
from fdvv_studio.project.patch import Record, canonical, model_of, patch_between, record_of


@dataclass(frozen=True)
class DocumentState:
    """A button as it is kept.

    Attributes
    ----------
    name : of its files.
    revision : counts every change of it.
    history : what was done to it; ``history.record`` is the model now.
    """

    name: str
    revision: int
    history: EditHistory


@dataclass(frozen=True)
class ChangeSaved:
    """A change was made, and is on the disk; revision is the one it made."""

    revision: int


@dataclass(frozen=True)
class ChangeConflict:
    """A change was refused: it was made on another state than the newest one, the head."""

    head: DocumentState


class Document:
    """One button with its edit history, kept on disk; not for two threads at once.

    Parameters
    ----------
    name : of the button.
    model_path : of its model file; may be missing if the journal exists.
    journal_path : of its journal; made from the model file if it does not exist.
    now_s : time, s since 1970.

    On opening the journal wins over a model file that is behind it or broken; a broken one is moved to
    ``trash_path``. A model file that was changed by hand becomes an edit. Raises InputError, OSError.
    """

    def __init__(
        self, name: str, model_path: Path, journal_path: Path, trash_path: Path, now_s: float
    ) -> None:
        self.name, self.model_path, self._trash_path = name, model_path, trash_path
        self._seen: tuple[int, int, int] | None = None
        self._log = DocumentLog(journal_path)
        try:
            if self._log.history is None:
                self._log.begin(record_of(load_model(model_path)), now_s)
            self.look(now_s)
        except BaseException:
            self.close()
            raise

    @property
    def history(self) -> EditHistory:
        assert self._log.history is not None
        return self._log.history

    @property
    def state(self) -> DocumentState:
        return DocumentState(self.name, self._log.revision, self.history)

    def change(self, revision: int, change: HistoryChange, now_s: float) -> ChangeSaved | ChangeConflict:
        """Make a change on a revision; it is on the disk when this returns.

        One that was made before, by its id, is not made twice. Raises ModelError or InputError if it breaks
        the model or fits nothing, and then nothing has changed; OSError if it cannot be kept.
        """
        self.look(now_s)
        made = self._log.revision_of(change.change_id)
        if made is not None:
            return ChangeSaved(made)
        if revision != self._log.revision:
            return ChangeConflict(self.state)
        history = self.history.after(change)
        model = model_of(history.record, self.name)
        self._log.write(change, history)
        self._follow(model_to_json(model))
        return ChangeSaved(self._log.revision)

    def look(self, now_s: float) -> None:
        """Record a change of the model file made outside, or rewrite a file that is behind."""
        if self._seen is not None and self._seen == self._stamp():
            return
        record = self._on_file()
        if record is None or self._behind(record):
            self._follow(model_to_json(model_of(self.history.record, self.name)))
            return
        self._seen = self._stamp()
        patch = patch_between(self.history.record, record)
        if patch.fields or patch.curves or patch.vibrations:
            edit = EditMade(uuid4().hex, "changed outside", patch, False, now_s)
            self._log.write(edit, self.history.after(edit))

    def _on_file(self) -> Record | None:
        """Read the model file; None if there is none, or none that can be read (that one is set aside)."""
        if not self.model_path.exists():
            return None
        try:
            return record_of(load_model(self.model_path))
        except InputError:
            self._trash_path.parent.mkdir(parents=True, exist_ok=True)
            self.model_path.replace(self._trash_path)
            return None

    def _behind(self, record: Record) -> bool:
        """Return whether a killed process left the file: an earlier state, older than the journal."""
        if record == canonical(self.history.record):
            return False
        older = self.model_path.stat().st_mtime_ns <= self._log.path.stat().st_mtime_ns
        return older and self._log.was(record)

    def _follow(self, text: str) -> None:
        """Write the model file; if that fails the journal has the change, and the next one writes again."""
        try:
            write_atomic(self.model_path, text)
        except OSError:
            self._seen = None
        else:
            self._seen = self._stamp()

    def _stamp(self) -> tuple[int, int, int] | None:
        try:
            stat = self.model_path.stat()
        except FileNotFoundError:
            return None
        return stat.st_mtime_ns, stat.st_ino, stat.st_size

    def close(self) -> None:
        self._log.close()


JOURNALS, TRASH, LOCK = "drafts", "trash", ".lock"
MOST_OPEN = 32
"""Buttons whose journals are held open, each a file descriptor; the one used longest ago is closed first."""


@dataclass(frozen=True)
class DocumentFile:
    """A button of the list. changed_s : when its files were last written, since 1970."""

    name: str
    changed_s: float
    size_bytes: int


class DocumentStore:
    """A person's own buttons; safe for many threads, for one process at a time.

    Parameters
    ----------
    project : folder of the person's work; made when something is first kept in it.
    now_s : gives the time, s since 1970.

    Every change is on the disk when its call returns. Raises InputError on a name that is none or not there,
    and if another process works on the project; OSError. The studio has a lock of its own beside that of this
    class: it keeps devices and jobs to one studio from its start on, this one protects the buttons from any
    other program that opens them, and only once something is kept.
    """

    def __init__(self, project: Path, now_s: Callable[[], float] = time.time) -> None:
        self.project, self._now_s = project, now_s
        self._lock = RLock()
        self._held: Journal | None = None
        self._open: dict[str, Document] = {}

    def list(self) -> list[DocumentFile]:
        """Return all buttons, the one changed last first."""
        by_name: dict[str, list[Path]] = {}
        for folder, suffix in ((BUTTONS, MODEL_SUFFIX), (JOURNALS, JOURNAL_SUFFIX)):
            for path in (self.project / folder).glob(f"*{suffix}"):
                if not path.name.startswith(".") and path.stat().st_size:
                    by_name.setdefault(path.name.removesuffix(suffix), []).append(path)
        stats = {name: [path.stat() for path in paths] for name, paths in by_name.items()}
        files = [
            DocumentFile(name, max(s.st_mtime for s in kept), sum(s.st_size for s in kept))
            for name, kept in stats.items()
        ]
        return sorted(files, key=lambda file: (-file.changed_s, file.name))

    def open(self, name: str) -> DocumentState:
        """Open a button: the model and its history."""
        with self._lock:
            document = self._document(name)
            document.look(self._now_s())
            return document.state

    def change(self, name: str, revision: int, change: HistoryChange) -> ChangeSaved | ChangeConflict:
        """Make a change on a revision of a button; refused as ChangeConflict if that is not its newest.

        Raises ModelError, InputError if the change breaks the model: then nothing has changed.
        """
        with self._lock:
            return self._document(name).change(revision, change, self._now_s())

    def create(self, name: str, model: FDVVModel) -> str:
        """Keep a model as a new button of that name; gives the name as it is kept."""
        with self._lock:
            self._hold()
            name = check_name(name, self._names())
            save_model(model.renamed(name), self._model_path(name))
            self._document(name)
            return name

    def free_name(self, wanted: str, others: Iterable[str] = ()) -> str:
        """Return a free name near the wanted one. others : names that count as taken too."""
        with self._lock:
            return free_name(wanted, [*self._names(), *others])

    def rename(self, name: str, to: str) -> str:
        """Rename a button with its history; returns the name as it is kept."""
        with self._lock:
            self._document(name)
            to = check_name(to, [other for other in self._names() if other != name])
            if to == name:
                return to
            self._release(name)
            # the journal first: killed in between, both names are there and nothing is lost
            self._journal_path(name).replace(self._journal_path(to))
            self._model_path(name).replace(self._model_path(to))
            self._sync(BUTTONS, JOURNALS)
            self._name_inside(to)
            return to

    def delete(self, name: str) -> None:
        """Move a button, with its history, into the project's trash."""
        with self._lock:
            self._document(name)
            self._release(name)
            folder = self._trash(name)
            folder.mkdir(parents=True)
            for path in (self._model_path(name), self._journal_path(name)):
                path.replace(folder / path.name)
            self._sync(BUTTONS, JOURNALS, TRASH)

    def close(self) -> None:
        """Release the project."""
        with self._lock:
            for name in list(self._open):
                self._release(name)
            if self._held:
                self._held.close()
                self._held = None

    def _hold(self) -> None:
        if self._held:
            return
        for folder in (BUTTONS, JOURNALS):
            (self.project / folder).mkdir(parents=True, exist_ok=True)
        reason, remedy = "another studio works on this project", "close it first, or use another project"
        busy = InputError(self.project.name, "whole folder", reason, remedy)
        self._held = Journal(self.project / JOURNALS / LOCK, busy)

    def _document(self, name: str) -> Document:
        """Find a button at work, or open it: names are looked up, never trusted."""
        if name in self._open:
            self._open[name] = self._open.pop(name)  # used last
        else:
            if name not in self._names():
                remedy = "choose one from the library"
                raise InputError("studio", name[:80], "no such button of your own", remedy)
            self._hold()
            trash = self._trash(name) / f"{name}{MODEL_SUFFIX}"
            paths = (self._model_path(name), self._journal_path(name), trash)
            while len(self._open) >= MOST_OPEN:
                self._release(next(iter(self._open)))
            self._open[name] = Document(name, *paths, self._now_s())
        return self._open[name]

    def _release(self, name: str) -> None:
        self._open.pop(name).close()

    def _names(self) -> set[str]:
        return {file.name for file in self.list()}

    def _name_inside(self, name: str) -> None:
        """Set the model's name to that of its file, as an edit."""
        document = self._document(name)
        named = {**document.history.record, "name": name}
        patch = patch_between(document.history.record, named)
        if patch.fields:
            edit = EditMade(uuid4().hex, f"rename to {name}", patch, False, self._now_s())
            document.change(document.state.revision, edit, self._now_s())

    def _model_path(self, name: str) -> Path:
        return self.project / BUTTONS / f"{name}{MODEL_SUFFIX}"

    def _journal_path(self, name: str) -> Path:
        return self.project / JOURNALS / f"{name}{JOURNAL_SUFFIX}"

    def _trash(self, name: str) -> Path:
        """Name a folder in the trash that is not there yet."""
        when = datetime.fromtimestamp(self._now_s(), UTC).strftime("%Y%m%dT%H%M%SZ")
        return self.project / TRASH / f"{name} {when} {uuid4().hex[:6]}"

    def _sync(self, *folders: str) -> None:
        for folder in folders:
            sync_folder(self.project / folder)

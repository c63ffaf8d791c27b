"""The buttons of a person's own, in a project folder: created, edited, renamed, deleted, never lost.

``buttons/<name>.fdvv.json`` are the models, ``drafts/<name>.draft.jsonl`` what was done to them (see
`fdvv.workflow._draft_log`), ``trash`` keeps what was deleted.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from threading import RLock
from uuid import uuid4

from fdvv.errors import InputError
from fdvv.files import sync_folder
from fdvv.journal import Journal
from fdvv.model import SUFFIX, FDVVModel, save_model
from fdvv.workflow._draft import Draft, DraftKept, DraftStale, DraftState
from fdvv.workflow._draft_history import DraftChange, EditMade
from fdvv.workflow._draft_log import DRAFT_SUFFIX
from fdvv.workflow._draft_name import check_name, free_name
from fdvv.workflow._draft_patch import patch_between
from fdvv.workflow._shelf import BUTTONS

DRAFTS, TRASH, LOCK = "drafts", "trash", ".lock"


@dataclass(frozen=True)
class DraftFile:
    """A button of the list. changed_s : when its files were last written, since 1970."""

    name: str
    changed_s: float
    size_bytes: int


class Drafts:
    """A person's own buttons; safe for many threads, for one process at a time.

    Parameters
    ----------
    project : folder of the person's work; made when something is first kept in it.
    now_s : gives the time, s since 1970.

    Every change is on the disk when its call returns. Raises InputError on a name that is none or not there,
    and if another process works on the project; OSError.
    """

    def __init__(self, project: Path, now_s: Callable[[], float] = time.time) -> None:
        self.project, self._now_s = project, now_s
        self._lock = RLock()
        self._held: Journal | None = None
        self._open: dict[str, Draft] = {}

    def list(self) -> list[DraftFile]:
        """Give the buttons there are, the one changed last first."""
        found: dict[str, list[Path]] = {}
        for folder, suffix in ((BUTTONS, SUFFIX), (DRAFTS, DRAFT_SUFFIX)):
            for path in (self.project / folder).glob(f"*{suffix}"):
                if not path.name.startswith(".") and path.stat().st_size:
                    found.setdefault(path.name.removesuffix(suffix), []).append(path)
        files = [_listed(name, paths) for name, paths in found.items()]
        return sorted(files, key=lambda file: (-file.changed_s, file.name))

    def open(self, name: str) -> DraftState:
        """Open a button: the model and its history."""
        with self._lock:
            draft = self._draft(name)
            draft.look(self._now_s())
            return draft.state

    def change(self, name: str, revision: int, change: DraftChange) -> DraftKept | DraftStale:
        """Make a change on a revision of a button; refused as DraftStale if that is not its newest.

        Raises ModelError, InputError if the change breaks the model: then nothing has changed.
        """
        with self._lock:
            return self._draft(name).change(revision, change, self._now_s())

    def create(self, name: str, model: FDVVModel) -> str:
        """Keep a model as a new button of that name; gives the name as it is kept."""
        with self._lock:
            self._hold()
            name = check_name(name, self._names())
            save_model(model.renamed(name), self._model_path(name))
            self._draft(name)
            return name

    def free_name(self, wanted: str) -> str:
        """Give a name near the wanted one that can be created."""
        with self._lock:
            return free_name(wanted, self._names())

    def rename(self, name: str, to: str) -> str:
        """Give a button another name, its history with it; gives the name as it is kept."""
        with self._lock:
            self._draft(name)
            to = check_name(to, [other for other in self._names() if other != name])
            if to == name:
                return to
            self._release(name)
            # the draft first: killed in between, both names are there and nothing is lost
            self._draft_path(name).replace(self._draft_path(to))
            self._model_path(name).replace(self._model_path(to))
            self._synced(BUTTONS, DRAFTS)
            self._name_inside(to)
            return to

    def delete(self, name: str) -> None:
        """Move a button, with its history, into the project's trash."""
        with self._lock:
            self._draft(name)
            self._release(name)
            folder = self._trash(name)
            folder.mkdir(parents=True)
            for path in (self._model_path(name), self._draft_path(name)):
                path.replace(folder / path.name)
            self._synced(BUTTONS, DRAFTS, TRASH)

    def close(self) -> None:
        """Let go of the project; nothing more is asked of it."""
        with self._lock:
            for name in list(self._open):
                self._release(name)
            if self._held:
                self._held.close()
                self._held = None

    def _hold(self) -> None:
        """Take the project for this process."""
        if self._held:
            return
        for folder in (BUTTONS, DRAFTS):
            (self.project / folder).mkdir(parents=True, exist_ok=True)
        reason, remedy = "another studio works on this project", "close it first, or use another project"
        busy = InputError(self.project.name, "whole folder", reason, remedy)
        self._held = Journal(self.project / DRAFTS / LOCK, busy)

    def _draft(self, name: str) -> Draft:
        """Find a button at work, or open it: names are looked up, never trusted."""
        if name not in self._open:
            if name not in self._names():
                raise InputError(
                    "studio", name[:80], "no such button of your own", "choose one from the library"
                )
            self._hold()
            paths = self._model_path(name), self._draft_path(name), self._trash(name) / f"{name}{SUFFIX}"
            self._open[name] = Draft(name, *paths, self._now_s())
        return self._open[name]

    def _release(self, name: str) -> None:
        self._open.pop(name).close()

    def _names(self) -> set[str]:
        return {file.name for file in self.list()}

    def _name_inside(self, name: str) -> None:
        """Let the model bear the name of its file, as an edit."""
        draft = self._draft(name)
        named = {**draft.history.record, "name": name}
        patch = patch_between(draft.history.record, named)
        if patch.fields:
            edit = EditMade(uuid4().hex, f"rename to {name}", patch, False, self._now_s())
            draft.change(draft.state.revision, edit, self._now_s())

    def _model_path(self, name: str) -> Path:
        return self.project / BUTTONS / f"{name}{SUFFIX}"

    def _draft_path(self, name: str) -> Path:
        return self.project / DRAFTS / f"{name}{DRAFT_SUFFIX}"

    def _trash(self, name: str) -> Path:
        """Name a folder in the trash that is not there yet."""
        when = datetime.fromtimestamp(self._now_s(), UTC).strftime("%Y%m%dT%H%M%SZ")
        return self.project / TRASH / f"{name} {when} {uuid4().hex[:6]}"

    def _synced(self, *folders: str) -> None:
        for folder in folders:
            sync_folder(self.project / folder)


def _listed(name: str, paths: list[Path]) -> DraftFile:
    stats = [path.stat() for path in paths]
    return DraftFile(name, max(s.st_mtime for s in stats), sum(s.st_size for s in stats))

"""One button of a person's own: its draft, and the model file that follows it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from uuid import uuid4

from fdvv.errors import InputError
from fdvv.files import write_atomic
from fdvv.model import load_model, model_to_json
from fdvv.workflow._draft_history import DraftChange, DraftHistory, EditMade
from fdvv.workflow._draft_log import DraftLog
from fdvv.workflow._draft_patch import Record, canonical, model_of, patch_between, record_of


@dataclass(frozen=True)
class DraftState:
    """A button as it is kept.

    Attributes
    ----------
    name : of its files.
    revision : counts every change of it.
    history : what was done to it; ``history.record`` is the model now.
    """

    name: str
    revision: int
    history: DraftHistory


@dataclass(frozen=True)
class DraftKept:
    """A change was made, and is on the disk; revision is the one it made."""

    revision: int


@dataclass(frozen=True)
class DraftStale:
    """A change was refused: it was made on another state than the newest one, the head."""

    head: DraftState


class Draft:
    """A draft at work; not for two threads at once.

    Parameters
    ----------
    name : of the button.
    model_path : of its model file; may be missing if the draft is there.
    draft_path : of its journal; made from the model file if it is not there.
    now_s : time, s since 1970.

    On opening the draft wins over a model file that is a moment behind it or broken; a broken one is kept in
    ``trash_path``. A model file that was changed by hand becomes an edit. Raises InputError, OSError.
    """

    def __init__(self, name: str, model_path: Path, draft_path: Path, trash_path: Path, now_s: float) -> None:
        self.name, self.model_path, self._trash_path = name, model_path, trash_path
        self._seen: tuple[int, int, int] | None = None
        self._log = DraftLog(draft_path)
        try:
            if self._log.history is None:
                self._log.begin(record_of(load_model(model_path)), now_s)
            self.look(now_s)
        except BaseException:
            self.close()
            raise

    @property
    def history(self) -> DraftHistory:
        """Get what was done."""
        assert self._log.history is not None
        return self._log.history

    @property
    def state(self) -> DraftState:
        """Get the button as it is kept."""
        return DraftState(self.name, self._log.revision, self.history)

    def change(self, revision: int, change: DraftChange, now_s: float) -> DraftKept | DraftStale:
        """Make a change on a revision; it is on the disk when this returns.

        One that was made before, by its id, is not made twice. Raises ModelError or InputError if it breaks
        the model or fits nothing, and then nothing has changed; OSError if it cannot be kept.
        """
        self.look(now_s)
        made = self._log.revision_of(change.change_id)
        if made is not None:
            return DraftKept(made)
        if revision != self._log.revision:
            return DraftStale(self.state)
        history = self.history.after(change)
        model = model_of(history.record, self.name)
        self._log.write(change, history)
        self._follow(model_to_json(model))
        return DraftKept(self._log.revision)

    def look(self, now_s: float) -> None:
        """Take notice of a model file that somebody else changed, or mend one that is behind."""
        if self._seen is not None and self._seen == self._stamp():
            return
        found = self._on_file()
        if found is None or self._behind(found):
            self._follow(model_to_json(model_of(self.history.record, self.name)))
            return
        self._seen = self._stamp()
        patch = patch_between(self.history.record, found)
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

    def _behind(self, found: Record) -> bool:
        """Tell whether a file is one that a killed process left: an earlier state, older than the draft."""
        if found == canonical(self.history.record):
            return False
        older = self.model_path.stat().st_mtime_ns <= self._log.path.stat().st_mtime_ns
        return older and self._log.was(found)

    def _follow(self, text: str) -> None:
        """Write the model file; where that fails the draft has the change, and the next one writes again."""
        try:
            write_atomic(self.model_path, text)
        except OSError:
            self._seen = None
            return
        self._seen = self._stamp()

    def _stamp(self) -> tuple[int, int, int] | None:
        try:
            found = self.model_path.stat()
        except FileNotFoundError:
            return None
        return found.st_mtime_ns, found.st_ino, found.st_size

    def close(self) -> None:
        """Let go of the journal."""
        self._log.close()

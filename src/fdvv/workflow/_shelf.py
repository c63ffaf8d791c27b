"""The shelf: every button a person can reach, each by an id. No id is ever joined to a path."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Sequence
from pathlib import Path
from threading import Lock

from fdvv.errors import InputError
from fdvv.model import SUFFIX, FDVVModel, builtin_names, load_builtin, load_model
from fdvv.workflow._fit import fit_file
from fdvv.workflow._kind import MODEL, own_kind
from fdvv.workflow._shelf_files import ShelfFile, own_files, source_files
from fdvv.workflow._shelf_read import measured_button

KEPT = 64
"""Opened buttons kept in memory; a model takes some 20 kB."""


BUTTONS = "buttons"
"""The folder of a project that holds the person's own models."""


class Shelf:
    """The built-in buttons, the models of a project and the measured files of folders.

    Parameters
    ----------
    project : the person's own models lie in its folder ``buttons``; nothing is written.
    sources : folders of measured files; one that is not there is empty.

    Any thread may call any method.
    """

    def __init__(self, project: Path, sources: Sequence[Path] = ()) -> None:
        self.project, self.sources = Path(project), tuple(Path(s) for s in sources)
        self._files: dict[str, ShelfFile] = {}
        self._opened: OrderedDict[tuple[str, str, bool], FDVVModel] = OrderedDict()
        self._lock = Lock()

    def scan(self) -> tuple[ShelfFile, ...]:
        """List the files that may hold a button as they are now: the person's own, then the sources'."""
        found = (*own_files(self.project / BUTTONS), *source_files(self.sources))
        self._files = {file.id: file for file in found}
        return found

    def model(self, button_id: str) -> FDVVModel:
        """Open a button; a measured one is fitted. Raises InputError."""
        return self._open(button_id, fitted=True)

    def curves(self, button_id: str) -> FDVVModel:
        """Open a button as its row is read: a measured one as polylines of its means. Raises InputError."""
        return self._open(button_id, fitted=False)

    def _open(self, button_id: str, fitted: bool) -> FDVVModel:
        origin, _, name = button_id.partition(":")
        if origin == "builtin" and name in builtin_names():
            return load_builtin(name)
        file = self._file(button_id)
        key = (button_id, file.stamp, fitted)
        with self._lock:
            if key in self._opened:
                self._opened.move_to_end(key)
                return self._opened[key]
        model = _read(file.path, fitted)
        with self._lock:
            self._opened[key] = model
            while len(self._opened) > KEPT:
                self._opened.popitem(last=False)
        return model

    def _file(self, button_id: str) -> ShelfFile:
        """Find the file of a button as it is now, also one that came after the last scan."""
        file = self._files.get(button_id)
        current = file and file.again()
        if current is None:
            self.scan()
            current = self._files.get(button_id)
        if current is None:
            raise InputError(
                "shelf", "button", f"no button is called {button_id!r:.80}", "choose one of the library"
            )
        return current


def _read(path: Path, fitted: bool) -> FDVVModel:
    if path.name.endswith(SUFFIX) or own_kind(path) == MODEL:
        return load_model(path)
    return fit_file(path).model if fitted else measured_button(path)[0]

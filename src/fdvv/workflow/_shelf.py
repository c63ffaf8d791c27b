"""The buttons a person can choose from, by id."""

from __future__ import annotations

from pathlib import Path

from fdvv.errors import InputError
from fdvv.model import SUFFIX, FDVVModel, load_builtin, load_model

BUTTONS = "buttons"
"""Folder of a project that holds the person's own models."""


class Shelf:
    """Built-in buttons and the person's own ones.

    Parameters
    ----------
    project : folder of a person's work; its ``buttons`` holds models.
    sources : folders of measured switches.
    """

    def __init__(self, project: Path, sources: tuple[Path, ...] = ()) -> None:
        self.project, self.sources = project, sources

    def model(self, button_id: str) -> FDVVModel:
        """Give the model of an id such as ``builtin:mx-clear`` or ``own:my-button``. Raises InputError."""
        kind, _, name = button_id.partition(":")
        if kind == "builtin":
            return load_builtin(name)
        if kind == "own" and name in (found := self._own()):
            return load_model(found[name])
        raise InputError("studio", button_id, "no such button", "choose one from the library")

    def _own(self) -> dict[str, Path]:
        """Find the person's models: names are looked up here, never joined to a path."""
        folder = self.project / BUTTONS
        return {path.name.removesuffix(SUFFIX): path for path in sorted(folder.glob(f"*{SUFFIX}"))}

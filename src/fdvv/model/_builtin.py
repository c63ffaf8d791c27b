"""The models that are shipped: every ``builtin/*.fdvv.json`` file beside this module, by its name."""

from __future__ import annotations

from importlib import resources
from importlib.resources.abc import Traversable

from fdvv.errors import InputError
from fdvv.model._file import SUFFIX, model_from_json
from fdvv.model._model import FDVVModel


def _files() -> dict[str, Traversable]:
    """Find the shipped files: name without suffix to file."""
    folder = resources.files("fdvv.model").joinpath("builtin")
    return {f.name.removesuffix(SUFFIX): f for f in folder.iterdir() if f.name.endswith(SUFFIX)}


def builtin_names() -> tuple[str, ...]:
    """Give the names of the shipped models, sorted."""
    return tuple(sorted(_files()))


def load_builtin(name: str) -> FDVVModel:
    """Read a shipped model by its name. Raises InputError that lists the names there are."""
    files = _files()
    if name not in files:
        remedy = f"use one of: {', '.join(sorted(files))}"
        raise InputError("built-in model", "name", f"no model is called {name!r}", remedy)
    return model_from_json(files[name].read_bytes(), files[name].name)

"""Open a button from whatever names one: a built-in, a model file or a file of measured curves."""

from __future__ import annotations

from pathlib import Path

from fdvv.errors import InputError
from fdvv.model import SUFFIX, FDVVModel, builtin_names, load_builtin, load_model
from fdvv.workflow._fit import FitSettings, fit_file


def open_model(spec: str, settings: FitSettings | None = None) -> FDVVModel:
    """Give the model that spec names.

    A built-in's name, a ``*.fdvv.json`` file, or a file of measured curves, which is fitted.
    Raises InputError.
    """
    if spec in builtin_names():
        return load_builtin(spec)
    path = Path(spec)
    if path.name.endswith(SUFFIX):
        return load_model(path)
    if not path.is_file():
        known = ", ".join(builtin_names())
        reason = "is a folder, one button is needed" if path.is_dir() else "no such file or built-in button"
        raise InputError(spec, "argument", reason, f"name a file or one of {known}")
    return fit_file(path, settings).model


def expand_folder(folder: str) -> list[str]:
    """Give every model file of a folder, or every file of measured curves if it holds no model."""
    from fdvv.capture import find_force_files

    models = sorted(Path(folder).rglob(f"*{SUFFIX}"))
    return [str(path) for path in models or find_force_files(Path(folder))]

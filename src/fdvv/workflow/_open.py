"""Open a button from whatever names one: a built-in, a model file or a file of measured curves."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from fdvv.errors import InputError
from fdvv.model import SUFFIX, FDVVModel, builtin_names, load_builtin, load_model
from fdvv.workflow._fit import FitSettings, fit_file, fit_folder


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


def open_models(specs: Sequence[str], refused: list[str] | None = None) -> list[FDVVModel]:
    """Open every button that specs name; a folder stands for its model files, else for its measured files.

    refused : gains one line per file of a folder that cannot be used. A button named by itself must be
    usable: raises InputError.
    """
    models: list[FDVVModel] = []
    for spec in specs:
        if Path(spec).is_dir():
            models += _open_folder(Path(spec), [] if refused is None else refused)
        else:
            models.append(open_model(spec))
    return models


def _open_folder(folder: Path, refused: list[str]) -> list[FDVVModel]:
    found: list[FDVVModel] = []
    paths = sorted(folder.rglob(f"*{SUFFIX}"))
    for path in paths:
        try:
            found.append(load_model(path))
        except InputError as error:
            refused.append(str(error))
    for result in () if paths else fit_folder(folder):
        if result.fit:
            found.append(result.fit.model)
        else:
            refused.append(result.reason)
    return found

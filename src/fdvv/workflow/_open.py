"""Open a button from whatever names one: a built-in, a model file or a file of measured curves."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from fdvv.errors import InputError
from fdvv.model import SUFFIX, FDVVModel, builtin_names, load_builtin, load_model
from fdvv.workflow._fit import FitSettings, fit_file
from fdvv.workflow._folder import fit_files, measured_files
from fdvv.workflow._kind import MODEL, own_kind


def open_model(spec: str, settings: FitSettings | None = None) -> FDVVModel:
    """Give the model that spec names.

    A built-in's name, a file that fdvv wrote, or a file of measured curves, which is fitted.
    Raises InputError.
    """
    if spec in builtin_names():
        return load_builtin(spec)
    path = Path(spec)
    if path.name.endswith(SUFFIX) or own_kind(path) == MODEL:
        return load_model(path)
    if not spec or not path.is_file():
        known = ", ".join(builtin_names())
        reason = (
            "is a folder, one button is needed"
            if spec and path.is_dir()
            else "no such file or built-in button"
        )
        raise InputError(spec or "''", "argument", reason, f"name a file or one of {known}")
    return fit_file(path, settings).model


@dataclass(frozen=True, eq=False)
class FolderButton:
    """What became of one file of a folder: a button, or the reason why not."""

    file: Path
    model: FDVVModel | None
    reason: str = ""


def button_files(folder: Path) -> list[Path]:
    """List the model files below a folder, or, if there is none, its measured files. Raises InputError."""
    return sorted(folder.rglob(f"*{SUFFIX}")) or measured_files(folder)


def open_files(files: Sequence[Path]) -> Iterator[FolderButton]:
    """Open files that button_files lists, in order; a refused one yields its reason."""
    if not files[0].name.endswith(SUFFIX):
        for result in fit_files(files):
            yield FolderButton(result.file, result.fit.model if result.fit else None, result.reason)
        return
    for path in files:
        try:
            yield FolderButton(path, load_model(path))
        except InputError as error:
            yield FolderButton(path, None, str(error))


def open_models(
    specs: Sequence[str],
    refused: list[str] | None = None,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> list[FDVVModel]:
    """Open every button that specs name; a folder stands for its model files, else for its measured files.

    refused : gains one line per file of a folder that cannot be used. A button named by itself must be
    usable: raises InputError. progress : called after every file of a folder.
    """
    models: list[FDVVModel] = []
    for spec in specs:
        if not spec or not Path(spec).is_dir():
            models.append(open_model(spec))
            continue
        files = button_files(Path(spec))
        for done, button in enumerate(open_files(files), start=1):
            progress(done, len(files))
            if button.model:
                models.append(button.model)
            elif refused is not None:
                refused.append(button.reason)
    return models

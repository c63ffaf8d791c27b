"""Open a program from whatever names one: a shipped program, a program file or an image."""

from __future__ import annotations

from pathlib import Path

from fdvv.errors import InputError
from fdvv.model import FDVVModel
from fdvv.program import SUFFIX, Program, load_program, load_shipped, make, programs
from fdvv.workflow._open import open_model


def names_program(spec: str) -> bool:
    """Tell whether spec names a program: a shipped one, or a file of that ending."""
    return spec.endswith(SUFFIX) or spec in [recipe.name for recipe in programs()]


def open_program(spec: str) -> Program:
    """Give the program that spec names: a shipped one, or a *.fdvv-program.json file. Raises InputError."""
    names = [recipe.name for recipe in programs()]
    if spec in names:
        return load_shipped(spec)
    if not spec or not Path(spec).is_file():
        reason = "no such file or shipped program"
        raise InputError(spec or "''", "argument", reason, f"name a *{SUFFIX} or one of {', '.join(names)}")
    return load_program(spec)


def make_program(name: str, base: str | None, given: tuple[str, ...]) -> Program:
    """Make a shipped program over a button, as `open_model` opens it, with NAME=VALUE parameters.

    Raises InputError.
    """
    model: FDVVModel | None = open_model(base) if base is not None else None
    return make(name, model, **dict(_parameter(text) for text in given))


def _parameter(text: str) -> tuple[str, float]:
    name, equals, value = text.partition("=")
    try:
        if not equals:
            raise ValueError
        return name.strip().replace("-", "_"), float(value)
    except ValueError:
        raise InputError(
            "--set", "parameter", f"{text!r} is not NAME=NUMBER", "write e.g. trigger_mm=1.2"
        ) from None

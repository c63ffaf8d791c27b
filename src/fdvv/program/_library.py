"""The shipped programs by name, with their parameters."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from importlib import resources

from fdvv.errors import InputError
from fdvv.model import FDVVModel, load_builtin
from fdvv.program import _ideas
from fdvv.program._button import button_program
from fdvv.program._file import SUFFIX, program_from_json
from fdvv.program._program import Program

BASE = "mx-red"
"""The built-in that shipped programs stand on by default: linear, so that nothing distracts."""


@dataclass(frozen=True)
class Parameter:
    """A number that a shipped program takes; its unit is the last part of its name."""

    name: str
    default: float


@dataclass(frozen=True)
class Recipe:
    """A shipped program before it is made.

    Attributes
    ----------
    name : what `make` calls it.
    summary : what it does, one line.
    details : its promises, and what its parameters mean.
    parameters : with their defaults.
    """

    name: str
    summary: str
    details: str
    parameters: tuple[Parameter, ...]


def _button(base: FDVVModel) -> Program:
    """Be the base itself, with its key report and its vibrations.

    Key 1 between the base's actuation and reset.
    """
    return button_program(base)


MAKERS: dict[str, Callable[..., Program]] = {
    "button": _button,
    "dwell-ticks": _ideas.dwell_ticks,
    "fast-tapping": _ideas.fast_tapping,
    "multi-level": _ideas.multi_level,
    "non-newtonian": _ideas.non_newtonian,
    "rapid-trigger": _ideas.rapid_trigger,
    "returning-later": _ideas.returning_later,
}


def programs() -> tuple[Recipe, ...]:
    """List the shipped programs, sorted by name."""
    return tuple(_recipe(name) for name in sorted(MAKERS))


def _recipe(name: str) -> Recipe:
    told = inspect.getdoc(MAKERS[name]) or ""
    summary, _, details = told.partition("\n\n")
    given = list(inspect.signature(MAKERS[name]).parameters.values())[1:]
    return Recipe(name, summary, details, tuple(Parameter(p.name, p.default) for p in given))


def make(name: str, base: FDVVModel | str | None = None, /, **parameters: float) -> Program:
    """Make a shipped program.

    base : the model it stands on, or the name of a built-in; mx-red by default.
    parameters : those of the program; the others have their defaults.
    Raises InputError for an unknown name or parameter, or a value out of range. The result is not checked.
    """
    if name not in MAKERS:
        remedy = f"use one of: {', '.join(sorted(MAKERS))}"
        raise InputError("program", "name", f"none is called {name!r}", remedy)
    known = {p.name: p.default for p in _recipe(name).parameters}
    for parameter, value in parameters.items():
        if parameter not in known:
            remedy = f"use one of: {', '.join(known) or 'none'}"
            raise InputError(f"program {name!r}", "parameter", f"none is called {parameter!r}", remedy)
        if isinstance(known[parameter], int):
            if value != int(value):
                reason = f"must be a whole number, got {value:g}"
                raise InputError(f"program {name!r}", parameter, reason, "round it")
            parameters[parameter] = int(value)
    model = load_builtin(base or BASE) if base is None or isinstance(base, str) else base
    return MAKERS[name](model, **parameters)


def load_shipped(name: str) -> Program:
    """Read a shipped program as it is made with the default base and parameters, from its file."""
    folder = resources.files("fdvv.program").joinpath("library")
    known = sorted(f.name.removesuffix(SUFFIX) for f in folder.iterdir() if f.name.endswith(SUFFIX))
    if name not in known:
        raise InputError("program", "name", f"none is called {name!r}", f"use one of: {', '.join(known)}")
    return program_from_json(folder.joinpath(name + SUFFIX).read_bytes(), name + SUFFIX)

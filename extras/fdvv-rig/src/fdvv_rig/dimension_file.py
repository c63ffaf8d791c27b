"""Read dimensions from a person: a TOML file of names and values, and NAME=VALUE words on top of it."""

from __future__ import annotations

import dataclasses
import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from fdvv.errors import InputError, did_you_mean
from fdvv.io.files import read_limited
from fdvv_rig.dimensions import CLASS, NAMES, Dimensions, meaning_of, source_of
from fdvv_rig.fits import check_fits

LARGEST_BYTES = 1_000_000


def load_dimensions(path: Path | str | None = None, words: Iterable[str] = ()) -> Dimensions:
    """Read dimensions and check that the parts they give fit each other.

    path : a TOML file whose keys are names of dimensions; what is left out keeps its default.
    words : NAME=VALUE each, over the file's.
    Raises InputError that names file or word, the dimension and the remedy.
    """
    values: dict[str, float] = {}
    if path is not None:
        values |= _of_file(Path(path))
    for word in words:
        name, found, value = word.partition("=")
        if not found:
            raise InputError("--set", repr(word), "has no equals sign", "write NAME=VALUE, as travel_mm=4")
        values[name.strip()] = _number("--set", name.strip(), value)
    made = dataclasses.replace(Dimensions(), **values)
    check_fits(made)
    return made


def dimensions_toml(dimensions: Dimensions) -> str:
    """Write all dimensions as TOML, one a line, with meaning and source beside it."""
    lines = ["# Dimensions of the rig; a name left out keeps its default.", ""]
    usual = dataclasses.asdict(Dimensions())
    for name, value in dataclasses.asdict(dimensions).items():
        mark = source_of(name) if value == usual[name] else f"set, {usual[name]:g} by default"
        lines.append(f"{f'{name} = {value!r}':<32}# {meaning_of(name)}; {mark}")
    return "\n".join(lines) + "\n"


def assumed() -> tuple[str, ...]:
    """Return the names of the dimensions that were not read from a data sheet: measure these."""
    return tuple(name for name in NAMES if source_of(name) == CLASS)


def _of_file(path: Path) -> dict[str, float]:
    data = read_limited(path, LARGEST_BYTES, "pass a TOML file of dimensions")
    try:
        found = tomllib.loads(data.decode())
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise InputError(path, "whole file", f"not TOML ({error})", "write NAME = VALUE lines") from error
    return {name: _number(path, name, value) for name, value in found.items()}


def _number(source: object, name: str, value: Any) -> float:
    if name not in NAMES:
        remedy = did_you_mean(name, NAMES, "see fdvv hardware parts --dimensions")
        raise InputError(source, repr(name), "is no dimension of the rig", remedy)
    if isinstance(value, bool) or not isinstance(value, str | float | int):
        raise InputError(source, name, f"{value!r} is not a number", "write a number of millimetres")
    try:
        return float(value)
    except (OverflowError, ValueError):
        raise InputError(source, name, f"{value!r} is not a number", "write a number") from None

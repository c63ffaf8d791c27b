"""Rigs and fingers as documented TOML: every parameter with its unit, range and source beside it."""

from __future__ import annotations

import dataclasses
import difflib
import tomllib
from importlib import resources
from pathlib import Path
from typing import Any, TypeVar, cast

from fdvv.errors import InputError, ModelError
from fdvv.twin._finger import Finger
from fdvv.twin._quantity import About, about, check_value
from fdvv.twin._rig import Rig

Record = TypeVar("Record", Rig, Finger)
SI = "Everything is in SI units, as the name of each parameter says; a parameter left out keeps its default."
COMMENT_COLUMN = 36


def rig_to_toml(rig: Rig) -> str:
    """Write a rig as TOML text, one line per parameter, with what it is, its range and its source."""
    return _to_toml(rig, "A rig for the twin: coil, mover, stops, sensors and controller.")


def finger_to_toml(finger: Finger) -> str:
    """Write a finger as TOML text, one line per parameter, with what it is, its range and its source."""
    return _to_toml(finger, "A finger for the twin: impedance, pulp and habit.")


def load_rig(name: Path | str) -> Rig:
    """Read a shipped rig by its name ("default", "light", "paper"), or any by its path.

    InputError names file, key, bound and remedy of the first thing that is wrong.
    """
    return _load_named(name, Rig)


def load_finger(name: Path | str) -> Finger:
    """Read a shipped finger by its name ("paper"), or any by its path; InputError as load_rig."""
    return _load_named(name, Finger)


def _load_named(name: Path | str, kind: type[Record]) -> Record:
    folder = resources.files("fdvv.twin").joinpath(f"{kind.__name__.lower()}s")
    if isinstance(name, str) and name.isidentifier() and (shipped := folder / f"{name}.toml").is_file():
        with resources.as_file(shipped) as path:
            return _load(path, kind)
    return _load(Path(name), kind)


def _to_toml(record: Rig | Finger, title: str) -> str:
    lines = [f"# {title}", f"# {SI}"]
    for section in dataclasses.fields(record):
        part = getattr(record, section.name)
        lines += ["", f"[{section.name}]"]
        lines += [_line(field, getattr(part, field.name)) for field in dataclasses.fields(part)]
    return "\n".join(lines) + "\n"


def _line(field: dataclasses.Field[Any], value: float | str) -> str:
    known = about(field)
    text = f'{field.name} = "{value}"' if known.choices else f"{field.name} = {value!r}"
    return f"{text:<{COMMENT_COLUMN}} # {_comment(known)}"


def _comment(known: About) -> str:
    if known.choices:
        extent = " or ".join(known.choices)
    else:
        low, high = known.plausible or known.bounds
        extent = " ".join(f"{low:g} to {high:g} {known.unit}".split())
    return f"{known.text}; {extent}; {known.source}"


def _load(path: Path, kind: type[Record]) -> Record:
    data = _parse(path)
    sections = {field.name: field for field in dataclasses.fields(kind)}
    for name in data:
        if name not in sections:
            raise _unknown(path, name, list(sections), "section")
    parts = {name: _section(path, name, sections[name], data.get(name, {})) for name in sections}
    try:
        return cast("type[Any]", kind)(**parts)  # type: ignore[no-any-return]
    except ModelError as error:
        raise InputError(path, "whole file", str(error), "change one of the two") from error


def _parse(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        reason = error.strerror or str(error)
        raise InputError(path, "whole file", f"cannot be read ({reason})", "check the path") from error
    except UnicodeDecodeError as error:
        raise InputError(path, f"byte {error.start}", "is not UTF-8 text", "save it as UTF-8") from error
    except tomllib.TOMLDecodeError as error:
        raise InputError(path, "TOML", str(error), "correct it; see the shipped default.toml") from error


def _section(path: Path, name: str, field: dataclasses.Field[Any], values: object) -> object:
    """Build one section's dataclass; the default factory of its field is the class itself."""
    kind = cast("type[Any]", field.default_factory)
    if not isinstance(values, dict):
        raise InputError(
            path, name, f"must be a section, got {values!r}", f"write [{name}] above its parameters"
        )
    fields = {f.name: f for f in dataclasses.fields(kind)}
    for key, value in values.items():
        if key not in fields:
            raise _unknown(path, f"{name}.{key}", list(fields), "parameter")
        wrong = check_value(key, value, about(fields[key]), int if fields[key].type == "int" else float)
        if wrong:
            raise InputError(path, f"{name}.{key}", wrong, _advice(about(fields[key])))
    try:
        return kind(**values)
    except ModelError as error:
        raise InputError(path, name, str(error), "change one of the two") from error


def _advice(known: About) -> str:
    if known.choices:
        return "write one of these words in quotes"
    low, high = known.plausible or known.bounds
    return " ".join(f"choose a value in range, plausible is {low:g} to {high:g} {known.unit}".split())


def _unknown(path: Path, place: str, names: list[str], what: str) -> InputError:
    near = difflib.get_close_matches(place.rpartition(".")[2], names, 1, 0.5)
    remedy = f'did you mean "{near[0]}"?' if near else f"known are {', '.join(names)}"
    return InputError(path, place, f"unknown {what}", remedy)

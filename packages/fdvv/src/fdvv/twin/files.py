"""Rigs, fingers and real buttons as TOML: every parameter with its unit, range and source beside it."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Callable, Mapping
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeVar, cast

import numpy as np

from fdvv.errors import InputError, ModelError, did_you_mean
from fdvv.io.documents import read_toml
from fdvv.io.files import read_limited
from fdvv.twin.button import BUILT, BuiltCam, ButtonPhysics
from fdvv.twin.finger import Finger
from fdvv.twin.quantity import About, about, check_value
from fdvv.twin.rig import Rig
from fdvv.units import FloatArray

Record = TypeVar("Record", Rig, Finger, ButtonPhysics)
Reader = Callable[[Path, str, object], object]
SUFFIX = ".toml"
SI = "Everything is in SI units, as the name of each parameter says; a parameter left out keeps its default."
COMMENT_COLUMN = 36  # the longest parameter of a shipped file has 31 letters; comments behind it align
WORDS = ("name", "source", "licence")
FORCES = ("press_N", "release_N")
FORCES_PER_LINE = 10  # a row of 93 letters, easy to count: 0.2 mm in steps of 20 um
CAM, PRELOAD = "cam", "preload_N"
CAM_DIGITS = {"elastic_N": 5, "height_m": 8, "rail_N": 5, "friction_ratio": 4}


def rig_to_toml(rig: Rig) -> str:
    """Write a rig as TOML text, one line per parameter, with what it is, its range and its source."""
    return _to_toml(rig, "A rig for the twin: coil, mover, stops, sensors and controller.")


def finger_to_toml(finger: Finger) -> str:
    """Write a finger as TOML text, one line per parameter, with what it is, its range and its source."""
    return _to_toml(finger, "A finger for the twin: impedance, pulp and habit.")


def load_rig(name: Path | str) -> Rig:
    """Read a shipped rig by its name ("recommended", "voltage", "light", "paper"), or any by its path.

    InputError names file, key, bound and remedy of the first thing that is wrong.
    """
    return _load_named(current_rig_name(name), Rig)


FIRST_RIG = "recommended"
"""The rig to use unless there is a reason for another; lists begin with it."""
OLD_RIG_NAMES = {"default": "voltage"}
"""Names that rigs had before, as they are in older files and in habits."""


def current_rig_name(name: Path | str) -> Path | str:
    """Return the name that a shipped rig has now; any other name or path as it is."""
    return OLD_RIG_NAMES.get(name, name) if isinstance(name, str) else name


def rig_files() -> dict[str, Path]:
    """Return the files of the shipped rigs by their names, FIRST_RIG first."""
    folder = Path(str(resources.files("fdvv.twin"))) / "rigs"
    files = {path.stem: path for path in sorted(folder.glob("*.toml"))}
    return {FIRST_RIG: files[FIRST_RIG], **files}


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
    return "\n".join([f"# {title}", f"# {SI}", *_section_lines(record)]) + "\n"


def _section_lines(record: Rig | Finger | ButtonPhysics) -> list[str]:
    lines: list[str] = []
    for name in _sections(type(record)):
        part = getattr(record, name)
        lines += ["", f"[{name}]"]
        lines += [_line(field, getattr(part, field.name)) for field in dataclasses.fields(part)]
    return lines


def _sections(kind: type[Rig | Finger | ButtonPhysics]) -> dict[str, dataclasses.Field[Any]]:
    return {f.name: f for f in dataclasses.fields(kind) if f.default_factory is not dataclasses.MISSING}


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


def _load(path: Path, kind: type[Record], readers: Mapping[str, Reader] = MappingProxyType({})) -> Record:
    """Read the sections of a record, and the keys outside of sections by their readers."""
    data = _parse(path)
    sections: dict[str, dataclasses.Field[Any]] = _sections(kind)
    names = [*readers, *sections]
    for name in data:
        if name not in names:
            raise _name_error(path, name, names, "key" if readers else "section")
    try:
        parts: dict[str, Any] = {name: read(path, name, data.get(name)) for name, read in readers.items()}
        parts |= {name: _section(path, name, field, data.get(name, {})) for name, field in sections.items()}
        return cast("type[Any]", kind)(**parts)  # type: ignore[no-any-return]
    except ModelError as error:
        raise InputError(path, "whole file", str(error), "change one of the two") from error


LARGEST_bytes = 1_000_000  # assumed; the longest shipped file has 10 kB


def _parse(path: Path) -> dict[str, Any]:
    remedy = "correct it; see the shipped voltage.toml"
    return read_toml(read_limited(path, LARGEST_bytes, remedy), path, remedy)


def _section(path: Path, name: str, field: dataclasses.Field[Any], values: object) -> object:
    """Build one section's dataclass; the default factory of its field is the class itself."""
    kind = cast("type[Any]", field.default_factory)
    if not isinstance(values, dict):
        reason = f"must be a section, got {values!r}"
        raise InputError(path, name, reason, f"write [{name}] above its parameters")
    fields = {f.name: f for f in dataclasses.fields(kind)}
    for key, value in values.items():
        if key not in fields:
            raise _name_error(path, f"{name}.{key}", list(fields), "parameter")
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


def _name_error(path: Path, place: str, names: list[str], what: str) -> InputError:
    return InputError(path, place, f"unknown {what}", did_you_mean(place.rpartition(".")[2], names))


def button_names() -> tuple[str, ...]:
    """Return the names of the shipped buttons, sorted."""
    return tuple(sorted(_button_files()))


def _button_files() -> dict[str, Traversable]:
    folder = resources.files("fdvv.twin").joinpath("buttons")
    return {f.name.removesuffix(SUFFIX): f for f in folder.iterdir() if f.name.endswith(SUFFIX)}


def load_button(name: Path | str) -> ButtonPhysics:
    """Read a shipped button by its name, or any by its path.

    InputError names file, key, bound and remedy of the first thing that is wrong.
    """
    shipped = _button_files()
    if str(name) in shipped:
        with resources.as_file(shipped[str(name)]) as path:
            return _load_button(path)
    path = Path(name)
    if path.suffix != SUFFIX and not path.exists():
        remedy = f"use a TOML file or one of: {', '.join(sorted(shipped))}"
        raise InputError("button", "name", f"no button is called {str(name)!r}", remedy)
    return _load_button(path)


def _load_button(path: Path) -> ButtonPhysics:
    readers: dict[str, Reader] = dict.fromkeys(WORDS, _word)
    return _load(path, ButtonPhysics, {**readers, **dict.fromkeys(FORCES, _forces), CAM: _cam})


def _word(path: Path, name: str, value: object) -> str:
    if not isinstance(value, str):
        raise InputError(path, name, f"must be a text, got {value!r}", f'write {name} = "..." at the top')
    return value


def _forces(path: Path, name: str, values: object) -> FloatArray:
    if not isinstance(values, list) or not all(_is_force(value) for value in values):
        raise InputError(path, name, "must be a list of finite forces in N", f"write {name} = [0.0, ...]")
    return np.array(values, dtype=np.float64)


def _cam(path: Path, name: str, data: object) -> BuiltCam | None:
    if data is None:
        return None
    fields, place = (*BUILT, PRELOAD), f"[{name}]"
    if not isinstance(data, dict) or set(data) != set(fields):
        raise InputError(path, place, "is not whole", f"write {', '.join(fields)}, or leave {place} out")
    if not _is_force(data[PRELOAD]):
        raise InputError(path, f"{place} {PRELOAD}", "must be a number", "write the leaf's preload in N")
    columns = {name: _forces(path, name, data[name]) for name in BUILT}
    return BuiltCam(**columns, preload_N=float(data[PRELOAD]))


def _is_force(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def button_to_toml(button: ButtonPhysics) -> str:
    """Write a button as TOML text: words, the two curves, then one line per parameter."""
    lines = ["# A real button for the twin: its slow curves and its physics. Simulated.", f"# {SI}", ""]
    # a string of JSON is one of TOML
    lines += [f"{name} = {json.dumps(getattr(button, name), ensure_ascii=False)}" for name in WORDS]
    text = "# slow force at 0, curve.step_m, ... up to the bottom stop; press upward, release downward"
    lines += ["", text]
    for name in FORCES:
        lines += [f"{name} = [", *_wrap(getattr(button, name)), "]"]
    return "\n".join(lines + _section_lines(button) + _cam_lines(button.cam)) + "\n"


def _cam_lines(cam: BuiltCam | None) -> list[str]:
    if cam is None:
        return []
    head = "# coil, cam and friction as built, at the places of press_N; the slow curves tell nothing then"
    lines = ["", head, f"[{CAM}]", f"{PRELOAD} = {cam.preload_N:.5f}"]
    for name in BUILT:
        lines += [f"{name} = [", *_wrap(getattr(cam, name), CAM_DIGITS[name]), "]"]
    return lines


def _wrap(forces_N: FloatArray, digits: int = 5) -> list[str]:
    words, n = [f"{force:.{digits}f}" for force in forces_N], FORCES_PER_LINE
    return [f"    {', '.join(words[i : i + n])}," for i in range(0, len(words), n)]

"""Buttons as documented TOML: the slow curves, and every parameter with its unit, range and source."""

from __future__ import annotations

import dataclasses
import math
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

import numpy as np

from fdvv.errors import InputError, ModelError
from fdvv.twin._button import BUILT, BuiltCam, ButtonPhysics
from fdvv.twin._toml import SI, _line, _parse, _section, _unknown
from fdvv.units import FloatArray

SUFFIX = ".toml"
WORDS = ("name", "source", "licence")
FORCES = ("press_N", "release_N")
FORCES_PER_LINE = 10
CAM, PRELOAD = "cam", "preload_N"
CAM_DIGITS = {"elastic_N": 5, "height_m": 8, "rail_N": 5, "friction_ratio": 4}


def button_names() -> tuple[str, ...]:
    """Give the names of the shipped buttons, sorted."""
    return tuple(sorted(_shipped()))


def _shipped() -> dict[str, Traversable]:
    folder = resources.files("fdvv.twin").joinpath("buttons")
    return {f.name.removesuffix(SUFFIX): f for f in folder.iterdir() if f.name.endswith(SUFFIX)}


def load_button(name: Path | str) -> ButtonPhysics:
    """Read a shipped button by its name, or any by its path.

    InputError names file, key, bound and remedy of the first thing that is wrong.
    """
    shipped = _shipped()
    if str(name) in shipped:
        with resources.as_file(shipped[str(name)]) as path:
            return _load(path)
    path = Path(name)
    if path.suffix != SUFFIX and not path.exists():
        remedy = f"use a TOML file or one of: {', '.join(sorted(shipped))}"
        raise InputError("button", "name", f"no button is called {str(name)!r}", remedy)
    return _load(path)


def _load(path: Path) -> ButtonPhysics:
    data = _parse(path)
    sections = _sections()
    known = [*WORDS, *FORCES, *sections, CAM]
    for key in data:
        if key not in known:
            raise _unknown(path, key, known, "key")
    parts: dict[str, Any] = {name: _word(path, name, data.get(name)) for name in WORDS}
    parts |= {name: _forces(path, name, data.get(name)) for name in FORCES}
    parts |= {name: _section(path, name, field, data.get(name, {})) for name, field in sections.items()}
    try:
        return ButtonPhysics(**parts, cam=_cam(path, data[CAM]) if CAM in data else None)
    except ModelError as error:
        raise InputError(path, "whole file", str(error), "change one of the two") from error


def _sections() -> dict[str, dataclasses.Field[Any]]:
    return {f.name: f for f in dataclasses.fields(ButtonPhysics) if f.name not in (*WORDS, *FORCES, CAM)}


def _word(path: Path, name: str, value: object) -> str:
    if not isinstance(value, str):
        raise InputError(path, name, f"must be a text, got {value!r}", f'write {name} = "..." at the top')
    return value


def _forces(path: Path, name: str, values: object) -> FloatArray:
    if not isinstance(values, list) or not all(_is_force(value) for value in values):
        raise InputError(path, name, "must be a list of finite forces in N", f"write {name} = [0.0, ...]")
    return np.array(values, dtype=np.float64)


def _cam(path: Path, data: object) -> BuiltCam:
    """Read what a designed leaf switch is built as."""
    fields = (*BUILT, PRELOAD)
    if not isinstance(data, dict) or set(data) != set(fields):
        raise InputError(path, f"[{CAM}]", "is not whole", f"write {', '.join(fields)}, or leave [{CAM}] out")
    if not _is_force(data[PRELOAD]):
        raise InputError(path, f"[{CAM}] {PRELOAD}", "must be a number", "write the leaf's preload in N")
    columns = {name: _forces(path, name, data[name]) for name in BUILT}
    return BuiltCam(**columns, preload_N=float(data[PRELOAD]))


def _is_force(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def button_to_toml(button: ButtonPhysics) -> str:
    """Write a button as TOML text: words, the two curves, then one line per parameter."""
    lines = ["# A real button for the twin: its slow curves and its physics. Simulated.", f"# {SI}", ""]
    lines += [f"{name} = {_quoted(getattr(button, name))}" for name in WORDS]
    lines += [
        "",
        "# slow force at 0, curve.step_m, ... up to the bottom stop; press upward, release downward",
    ]
    for name in FORCES:
        lines += [f"{name} = [", *_wrapped(getattr(button, name)), "]"]
    for name in _sections():
        part = getattr(button, name)
        lines += ["", f"[{name}]"]
        lines += [_line(field, getattr(part, field.name)) for field in dataclasses.fields(part)]
    return "\n".join(lines + _cam_lines(button.cam)) + "\n"


def _cam_lines(cam: BuiltCam | None) -> list[str]:
    if cam is None:
        return []
    lines = [
        "",
        "# coil, cam and friction as built, at the places of press_N; the slow curves tell nothing then",
    ]
    lines += [f"[{CAM}]", f"{PRELOAD} = {cam.preload_N:.5f}"]
    for name in BUILT:
        lines += [f"{name} = [", *_wrapped(getattr(cam, name), CAM_DIGITS[name]), "]"]
    return lines


def _quoted(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def _wrapped(forces_N: FloatArray, digits: int = 5) -> list[str]:
    words = [f"{force:.{digits}f}" for force in forces_N]
    return [
        "    " + ", ".join(words[i : i + FORCES_PER_LINE]) + ","
        for i in range(0, len(words), FORCES_PER_LINE)
    ]

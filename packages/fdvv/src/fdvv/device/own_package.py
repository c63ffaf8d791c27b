"""A package for a rig of one's own: a simulated one that works, with what to replace marked."""

from __future__ import annotations

import keyword
import re
from importlib.resources import files
from pathlib import Path
from string import Template

from fdvv import extras
from fdvv.errors import InputError
from fdvv.io.files import write_atomic

NAME = re.compile(r"[a-z][a-z0-9]*(-[a-z0-9]+)*")
TEMPLATES = ("rig.py", "pyproject.toml", "test_rig.py", "README.md")


def write_package(name: str, folder: Path) -> tuple[Path, ...]:
    """Write the package of a rig into a new folder; return its files, the physics first.

    name : lower-case letters, digits and hyphens. Raises InputError on another name, one that is taken, and
    a folder that holds something.
    """
    module = name.replace("-", "_")
    if not NAME.fullmatch(name) or keyword.iskeyword(module):
        raise InputError("NAME", name, "cannot name a package", "use lower-case letters, digits and hyphens")
    if name in (*extras.names("devices"), *extras.names("rigs"), "twin", "host", "serial", "replay", "rig"):
        raise InputError("NAME", name, "is the name of another device", "choose another name")
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise InputError("-o", str(folder), "exists and is not empty", "choose a new folder")
    source = folder / "src" / module
    places = (
        source / "rig.py",
        folder / "pyproject.toml",
        folder / "tests" / "test_rig.py",
        folder / "README.md",
    )
    for template, place in zip(TEMPLATES, places, strict=True):
        place.parent.mkdir(parents=True, exist_ok=True)
        text = (files("fdvv.device") / "own_template" / f"{template}.txt").read_text("utf-8")
        write_atomic(place, Template(text).substitute(name=name, module=module).encode())
    write_atomic(source / "__init__.py", f'"""The rig {name}."""\n'.encode())
    return places

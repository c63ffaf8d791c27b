"""Studies to begin with: a commented file of each kind, and the buttons it names."""

from __future__ import annotations

import json
import re
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path

from fdvv.errors import InputError
from fdvv.files import write_atomic
from fdvv.study._plan_check import is_file
from fdvv.study._plan_file import read_plan_text

STUDY_FILE = "study.toml"
"""Name of the file that declares a study, in its folder."""
SUFFIX = ".toml"
LONGEST_NAME = 60
NAME_LINE = re.compile(r'^name = "[^"]*"', re.MULTILINE)


def template_names() -> tuple[str, ...]:
    """Give the names of the shipped studies, one of each kind, sorted; the name is the kind's."""
    return tuple(sorted(_files()))


def template_text(name: str) -> str:
    """Give the text of a shipped study. InputError lists the names there are."""
    files = _files()
    if name not in files:
        remedy = f"use one of: {', '.join(sorted(files))}"
        raise InputError("shipped study", "kind", f"no study is called {name!r}", remedy)
    return files[name].read_text(encoding="utf-8")


def template_buttons(name: str) -> dict[str, bytes]:
    """Give the files of buttons that a shipped study names, by their place beside it."""
    plan = read_plan_text(template_text(name), name)
    stimuli = [s for item in plan.items for s in (*item.stimuli, item.reference) if s is not None]
    folder = resources.files("fdvv.study").joinpath("templates")
    return {s.button: folder.joinpath(s.button).read_bytes() for s in stimuli if is_file(s.button)}


def write_template(name: str, folder: Path, study_name: str | None = None) -> Path:
    """Write a shipped study and its buttons into a folder; gives the study's file.

    study_name : what it is called instead; cut where it is too long. InputError where one of its files is
    there already, or no shipped study has that name. OSError.
    """
    text, buttons = template_text(name), template_buttons(name)
    path = folder / STUDY_FILE
    for there in (path, *(folder / button for button in buttons)):
        if there.exists():
            raise InputError(there, "output", "is there already", "name another folder")
    for button, content in buttons.items():
        write_atomic(folder / button, content)
    write_atomic(path, text if study_name is None else _called(text, study_name))
    return path


def _called(text: str, study_name: str) -> str:
    """Put another name in the place of the first one, which is the study's; a JSON string is one of TOML."""
    plain = "".join(c for c in study_name if c.isprintable()).strip()[:LONGEST_NAME].strip()
    if not plain:
        return text
    quoted = json.dumps(plain, ensure_ascii=False)
    return NAME_LINE.sub(lambda _: f"name = {quoted}", text, count=1)


def _files() -> dict[str, Traversable]:
    folder = resources.files("fdvv.study").joinpath("templates")
    return {f.name.removesuffix(SUFFIX): f for f in folder.iterdir() if f.name.endswith(SUFFIX)}

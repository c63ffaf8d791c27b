"""The file of a study, TOML that people write: reading, checking, and the shipped templates."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Sequence
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any, TypeVar, get_args

import msgspec

from fdvv.errors import InputError, did_you_mean
from fdvv.io.documents import read_toml
from fdvv.io.files import read_limited, write_atomic
from fdvv_people.study.plan.plan import StudyPlan
from fdvv_people.study.plan.plan_check import plan_problems
from fdvv_people.study.plan.tasks import task_of

REMEDY = "see docs/reference/study-file.md, or begin with fdvv study new"
LIMIT_bytes = 1_000_000
Plan = TypeVar("Plan", bound=msgspec.Struct)
TEXTS = ("title", "text", "question", "low", "high")
STUDY_FILE = "study.toml"
"""Name of the file that declares a study, in its folder."""

SUFFIX, TEMPLATES = ".toml", resources.files("fdvv_people.study").joinpath("templates")
LONGEST_NAME = 60  # that of `fdvv_people.study.plan.plan.Name`: a longer name could not be read again
NAME_LINE = re.compile(r'^name = "[^"]*"', re.MULTILINE)


def read_plan(path: Path) -> tuple[StudyPlan, Path]:
    """Read the plan of a file, or of a study's folder, unchecked; return its file too. InputError."""
    data, path = read_plan_file(path)
    return read_plan_text(data, path), path


def read_plan_file(path: Path) -> tuple[bytes, Path]:
    """Return the text of a study's file, or of that in a folder, and where it is. InputError."""
    path = path / STUDY_FILE if path.is_dir() else path
    return read_limited(path, LIMIT_bytes, "name the file of a study, or begin with fdvv study new"), path


def read_plan_text(text: str | bytes, source: object) -> StudyPlan:
    """Read the TOML text of a study; `check_plan` checks whether it makes sense too.

    InputError names source, the place in it, and what to do: what is no TOML, an unknown or missing field, a
    value of the wrong kind or outside its range.
    """
    plan = read_declared(text, source, StudyPlan, "fdvv-study")
    task_of(plan.kind, source)
    return plan


def read_declared(text: str | bytes, source: object, kind: type[Plan], format_: str) -> Plan:
    """Read a plan from TOML text. format_ : the name of the format. InputError, see `read_plan_text`."""
    if len(text) > LIMIT_bytes:
        raise InputError(source, "whole file", f"longer than {LIMIT_bytes} characters", REMEDY)
    data = read_toml(text, source, REMEDY)
    _check_head(data, source, format_)
    try:
        return msgspec.convert(data, kind)
    except (msgspec.ValidationError, RecursionError) as error:
        raise _refused(data, source, error, kind) from error


def check_plan(plan: StudyPlan, source: object) -> None:
    """Raise InputError on a plan that cannot be run or analysed as it says, with all that is wrong."""
    refuse_problems(plan_problems(plan), source)


def refuse_problems(problems: Sequence[str], source: object) -> None:
    """Raise InputError if there are problems of a plan, each "place: reason", with all of them."""
    if problems:
        place, _, reason = problems[0].partition(": ")
        more = f" (and {len(problems) - 1} more: {' | '.join(problems[1:])})" if problems[1:] else ""
        raise InputError(source, place, reason + more, REMEDY)


def _check_head(data: dict[str, Any], source: object, format_: str) -> None:
    if data.get("format", format_) != format_:
        reason = f'{data["format"]!r:.60} is not a study (it must be "{format_}")'
        raise InputError(source, "format", reason, REMEDY)
    if data.get("version", 1) != 1:
        reason = f"version {data['version']!r:.40}, this fdvv reads version 1"
        raise InputError(source, "version", reason, "install the fdvv that wrote it, or a newer one")


def _refused(
    data: dict[str, Any], source: object, error: Exception, kind: type[msgspec.Struct]
) -> InputError:
    reason, _, path = str(error).partition(" - at ")
    keys = re.findall(r"[A-Za-z_][\w-]*|\[\d*\]|\[\.\.\.\]", path.strip("`").removeprefix("$"))
    reason = (
        reason.replace("Object", "this table").replace("`object`", "a table").replace("`array`", "a list")
    )
    return InputError(source, _place(data, keys), reason, _remedy(reason, keys, kind))


def _place(data: Any, keys: list[str]) -> str:
    parts = []
    for key in keys:
        number = re.fullmatch(r"\[(\d+)\]", key)
        if not number:
            parts.append(key)
            data = data.get(key) if isinstance(data, dict) else None
            continue
        index = int(number[1])
        data = data[index] if isinstance(data, list) and index < len(data) else None
        name = data.get("name") if isinstance(data, dict) else None
        parts[-1:] = [f"{parts[-1] if parts else ''}[{index + 1}]" + (f" ({name!r:.62})" if name else "")]
    return ", ".join(parts) or "whole file"


def _remedy(reason: str, keys: list[str], plan: type[msgspec.Struct]) -> str:
    unknown = re.search(r"unknown field `(.*)`", reason)
    if unknown:
        return _near(unknown[1], keys, plan)
    if "Expected a table, got `str`" in reason and keys and keys[-1] in TEXTS:
        return f'give it by language, as {keys[-1]}.en = "…"'
    return REMEDY


def _near(name: str, keys: list[str], plan: type[msgspec.Struct]) -> str:
    words = [key for key in keys if not key.startswith("[")]
    kind = dict(_tables(plan)).get(words[-1], plan) if words else plan
    known = [field.name for field in msgspec.structs.fields(kind)]
    return did_you_mean(name, known)


def _tables(kind: type[msgspec.Struct]) -> Iterator[tuple[str, type[msgspec.Struct]]]:
    """Yield the tables that a record may hold, and those in them, by the names of their fields."""
    for field in msgspec.structs.fields(kind):
        for part in (field.type, *get_args(field.type)):
            if isinstance(part, type) and issubclass(part, msgspec.Struct):
                yield field.name, part
                yield from _tables(part)


def template_names(format_: str = "fdvv-study") -> tuple[str, ...]:
    """Return the names of the shipped studies of a format, sorted; each is called as its kind."""
    head = f'format = "{format_}"'
    return tuple(sorted(name for name, file in _files().items() if head in file.read_text(encoding="utf-8")))


def template_text(name: str) -> str:
    """Return the text of a shipped study. InputError lists the names there are."""
    files = _files()
    if name not in files:
        remedy = f"use one of: {', '.join(sorted(files))}"
        raise InputError("shipped study", "kind", f"no study is called {name!r}", remedy)
    return files[name].read_text(encoding="utf-8")


def template_buttons(name: str) -> dict[str, bytes]:
    """Return the files of buttons that a shipped study names, by their place beside it."""
    text = template_text(name)
    places = {f"buttons/{file.name}": file for file in TEMPLATES.joinpath("buttons").iterdir()}
    return {place: file.read_bytes() for place, file in places.items() if f'"{place}"' in text}


def write_template(name: str, folder: Path, study_name: str | None = None) -> Path:
    """Write a shipped study and its buttons into a folder; return the study's file.

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
    write_atomic(path, text if study_name is None else called(text, study_name))
    return path


def called(text: str, study_name: str) -> str:
    """Return the text of a study under another name, cut where that is too long."""
    plain = "".join(c for c in study_name if c.isprintable()).strip()[:LONGEST_NAME].strip()
    if not plain:
        return text
    quoted = json.dumps(plain, ensure_ascii=False)
    return NAME_LINE.sub(lambda _: f"name = {quoted}", text, count=1)


def _files() -> dict[str, Traversable]:
    return {f.name.removesuffix(SUFFIX): f for f in TEMPLATES.iterdir() if f.name.endswith(SUFFIX)}

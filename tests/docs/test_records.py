"""Every field of every file, message of the studio and parameter of the twin is told where people look."""

from __future__ import annotations

import dataclasses
import importlib
import pkgutil
import re
from typing import Any, Literal, get_args, get_origin, get_type_hints

import msgspec
import pytest
from tests.docs.pages import DOCS
from tools import make_record_reference, record_types
from tools.make_record_reference import FILES, is_told, messages, thing_of
from tools.record_types import fields, reached

import fdvv
from fdvv.twin import ButtonPhysics, Finger, Rig
from fdvv.twin._quantity import about

REFERENCE = DOCS / "reference"
ANEW = f"run {make_record_reference.COMMAND}"
NOT_IMPORTED = ("__main__", "libfdvv")
EXTRAS = ("fdvv.hardware.cad", "fdvv.optimize._botorch", "fdvv.optimize._torch")
"""Modules that need what is mostly not installed; they hold no files."""
TOLD_BY_HAND = {
    "model-file.md": ("Model",),
    "program-file.md": ("Program",),
    "recording-file.md": ("Recording",),
    "study-file.md": ("Study",),
    "answers-file.md": ("Code book",),
}
"""Pages that people read, each with the kinds of file it tells; files.md has every field of every kind."""


@pytest.mark.parametrize("name", make_record_reference.PAGES)
def test_a_page_of_records_is_that_of_the_code(name: str) -> None:
    made = make_record_reference.PAGES[name]()
    assert (REFERENCE / name).read_text(encoding="utf-8") == made, ANEW


def silent(records: list[type[Any]]) -> list[str]:
    """Give the fields of which nothing is said."""
    found = []
    for record in records:
        told = {part.name: part for part in thing_of(record).parts}
        found += [f"{record.__name__}.{f.name}" for f in fields(record) if not is_told(f, told[f.name])]
    return found


def test_every_field_of_every_file_is_told() -> None:
    records = [record for kind in FILES for record in reached(kind.classes)]
    assert len(records) > 60
    assert silent(records) == [], (
        "write `name : what it is` into their docstrings or into tools/api_words.toml"
    )
    assert [record for record in records if thing_of(record).said is None] == []


def test_every_message_of_the_studio_is_told() -> None:
    assert len(messages()) > 150
    assert silent(messages()) == [], (
        "write `name : what it is` into their docstrings or into tools/api_words.toml"
    )
    assert [record for record in messages() if thing_of(record).said is None] == []


def structs() -> list[type[msgspec.Struct]]:
    """Give every struct of the package."""
    for module in pkgutil.walk_packages(fdvv.__path__, "fdvv."):
        if not module.name.endswith(NOT_IMPORTED) and not module.name.startswith(EXTRAS):
            importlib.import_module(module.name)
    found, waiting = [], [msgspec.Struct]
    while waiting:
        below = waiting.pop().__subclasses__()
        found += below
        waiting += below
    return [record for record in found if record.__module__.startswith("fdvv.")]


def test_every_kind_of_file_with_a_format_is_on_the_page_of_files() -> None:
    known = {record for kind in FILES for record in reached(kind.classes)}
    missing = [f"{r.__module__}:{r.__name__}" for r in structs() if _has_format(r) and r not in known]
    assert missing == [], f"add each to tools/file_kinds.toml, then {ANEW}"


def _has_format(record: type[msgspec.Struct]) -> bool:
    if "format" not in record.__struct_fields__:
        return False
    kind = get_type_hints(record)["format"]
    return get_origin(kind) is Literal and str(get_args(kind)[0]).startswith("fdvv-")


@pytest.mark.parametrize(("page", "titles"), TOLD_BY_HAND.items())
def test_a_page_written_by_hand_names_every_field(page: str, titles: tuple[str, ...]) -> None:
    text = (REFERENCE / page).read_text(encoding="utf-8")
    names = {
        field.encode_name
        for kind in FILES
        if kind.title in titles
        for record in reached(kind.classes)
        for field in fields(record)
    }
    assert names
    missing = sorted(name for name in names if not re.search(rf"`[^`]*\b{name}\b[^`]*`|\b{name}\b =", text))
    assert missing == [], f"docs/reference/{page} says nothing of them"


@pytest.mark.parametrize(
    ("root", "page"), [(Rig, "rig.md"), (Finger, "rig.md"), (ButtonPhysics, "button.md")]
)
def test_every_parameter_of_the_twin_has_its_meaning_source_and_line(root: type[Any], page: str) -> None:
    text = (REFERENCE / page).read_text(encoding="utf-8")
    parameters = list(_parameters(root))
    assert len(parameters) > 10
    for field in parameters:
        known = about(field)
        assert known.text, f"{field.name} has no meaning"
        assert known.source, f"{field.name} has no source"
        lines = [row for row in text.splitlines() if row.startswith(f"{field.name} = ") and known.text in row]
        assert lines, f"{page} has no line of {field.name}: run python tools/make_rig_reference.py"
        assert known.unit in lines[0]
        assert known.source in lines[0]


def _parameters(root: type[Any]) -> list[dataclasses.Field[Any]]:
    hints = get_type_hints(root)
    found = []
    for field in dataclasses.fields(root):
        if "about" in field.metadata:
            found.append(field)
        elif dataclasses.is_dataclass(hints[field.name]):
            found += _parameters(hints[field.name])
    return found


class Inner(msgspec.Struct):
    """Something."""

    size_mm: float


class Outer(msgspec.Struct):
    """Something that holds it."""

    inner: list[Inner]
    word: Literal["a", "b"] | None = None


def test_a_type_is_told_in_words() -> None:
    inner, word = record_types.fields(Outer)
    assert record_types.in_words(inner.type) == "list of `Inner`"
    assert record_types.in_words(word.type) == '`"a"` or `"b"` or null'
    assert reached((Outer,)) == [Outer, Inner]

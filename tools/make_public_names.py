"""Write docs/reference/public-names.txt: every name that a room exports, with its signature.

``--check`` only tells whether it is stale. ``--since FILE`` tells what went or changed since an older one,
and ends with status 1 if CHANGELOG.md does not name it.
"""

from __future__ import annotations

import dataclasses
import enum
import importlib
import inspect
import pkgutil
import re
import sys
import typing
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import fdvv

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "reference" / "public-names.txt"
CLOSED = ("fdvv._native", "fdvv.cli")
"""Rooms whose names are nobody's to import: the loader of the library, and the commands."""
INTRODUCTION = """\
# Every name that a room exports, with its signature: what docs/explanation/stability.md promises to keep.
# Made by tools/make_public_names.py; do not edit.
"""


def rooms() -> Iterator[str]:
    """Give the rooms: what stands right below the package."""
    for module in pkgutil.iter_modules(fdvv.__path__, "fdvv."):
        if module.name not in (*CLOSED, "fdvv.__main__"):
            yield module.name


def reference() -> str:
    """Give the page's text."""
    lines = [line for room in sorted(rooms()) for line in room_lines(room)]
    return INTRODUCTION + "".join(f"{line}\n" for line in lines)


def room_lines(room: str) -> Iterator[str]:
    """Give the lines of a room: a class is followed by its members."""
    module = importlib.import_module(room)
    own = [name for name, value in vars(module).items() if getattr(value, "__module__", None) == room]
    for name in sorted(getattr(module, "__all__", [n for n in own if not n.startswith("_")])):
        value = getattr(module, name)
        yield f"{room}.{name}{head(value)}"
        if inspect.isclass(value):
            yield from (f"{room}.{name}.{line}" for line in members(value))


def head(value: Any) -> str:
    """Give what follows a name: the call, or what kind of thing it is."""
    if inspect.isclass(value):
        if issubclass(value, enum.Enum):
            return "{" + ", ".join(value.__members__) + "}"
        return signature(value) if callable_class(value) else ""
    if inspect.isroutine(value):
        return signature(value)
    return ": alias" if typing.get_origin(value) else f": {type(value).__name__}"


def callable_class(kind: type) -> bool:
    """Tell whether a class has a way of its own to be made."""
    return dataclasses.is_dataclass(kind) or "__init__" in vars(kind)


def signature(value: Any) -> str:
    """Write a signature; defaults that are no plain values are left as dots, for their text may differ."""
    try:
        found = inspect.signature(value)
    except (TypeError, ValueError):
        return "(…)"
    parameters = [
        part.replace(default=_told(part.default), annotation=_bare(part.annotation))
        for part in found.parameters.values()
    ]
    text = str(found.replace(parameters=parameters, return_annotation=_bare(found.return_annotation)))
    return text.removesuffix(" -> None") if inspect.isclass(value) else text


class _Text:
    """Something whose text is given."""

    def __init__(self, text: str) -> None:
        self.text = text

    def __repr__(self) -> str:
        return self.text


def _told(default: Any) -> Any:
    if isinstance(default, enum.Enum):
        return default.value
    plain = default is inspect.Parameter.empty or isinstance(default, int | float | str | None)
    return default if plain else _Text("…")


def _bare(annotation: Any) -> Any:
    """Take the quotes from an annotation that is kept as text."""
    return _Text(annotation) if isinstance(annotation, str) else annotation


def members(kind: type) -> Iterator[str]:
    """Give the public methods and properties that a class has of its own."""
    for name, value in sorted(vars(kind).items()):
        if name.startswith("_"):
            continue
        if isinstance(value, property):
            yield f"{name}: {annotation(value)}"
        elif isinstance(value, classmethod | staticmethod):
            yield f"{name}{signature(getattr(kind, name))}"
        elif inspect.isfunction(value):
            yield f"{name}{signature(value)}"


def annotation(value: property) -> str:
    """Give what a property returns."""
    return str(inspect.get_annotations(value.fget).get("return", "…")) if value.fget else "…"


def gone(old: str, new: str) -> list[str]:
    """Give the names whose line went or changed between two pages."""
    before, after = old.splitlines(), set(new.splitlines())
    return [name_of(line) for line in before if line.startswith("fdvv.") and line not in after]


def name_of(line: str) -> str:
    """Give the name that a line begins with."""
    return re.split(r"[({:]", line, maxsplit=1)[0]


def unannounced(old: str, new: str, changelog: str) -> list[str]:
    """Give the names that went or changed without the newest section of the changelog telling."""
    newest = changelog.split("\n## ", 2)[1]
    return [name for name in gone(old, new) if f"`{name}`" not in newest]


def main() -> None:
    """Write the page, or hold it against what is there."""
    text = reference()
    if "--check" in sys.argv:
        sys.exit(PAGE.read_text(encoding="utf-8") != text)
    if "--since" in sys.argv:
        old = Path(sys.argv[sys.argv.index("--since") + 1]).read_text(encoding="utf-8")
        missing = unannounced(old, text, (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"))
        sys.exit("\n".join(f"CHANGELOG.md does not tell of `{name}`" for name in missing) or 0)
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()

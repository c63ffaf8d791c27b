"""Write docs/reference/api from the package itself: ``python -m tools.make_api_reference``."""

from __future__ import annotations

import importlib
import inspect
from pathlib import Path

from tools.api_docstrings import Said
from tools.api_reading import EVERYWHERE, WORDS, Part, Thing, class_homes, classes_in, rooms, things
from tools.markdown import escaped, slugs, table

from fdvv.files import write_atomic

FOLDER = Path(__file__).parents[1] / "docs" / "reference" / "api"
COMMAND = "python -m tools.make_api_reference"
MADE = f"Made from the code by `{COMMAND}`; do not edit."
INTRODUCTION = f"""# The package, from Python

{MADE}

Every public name of every room: what it is, how it is called, its parameters and fields with type, unit and
default. A room is a module that people import from; which room may import which is told in
[ARCHITECTURE.md](../../../ARCHITECTURE.md). What this version promises to keep is what stands here.

## How to read it

- The unit is the last part of a name: `travel_mm`, `force_cN`, `velocity_mm_s`; a `_ratio` has none.
- An array is one-dimensional, (n,), and arrays of one call or record go together sample by sample, unless the
  text gives another shape. Where a plain number will do, so will an array of any shape (`ArrayLike`).
- Displacement is positive into the button and 0 at first contact, force positive against the finger, velocity
  always positive: the mean speed of a stroke ([frames](../../../ARCHITECTURE.md#coordinates-signs-clocks)).
- Records are frozen: make another with `dataclasses.replace`. What is wrong raises when it is made.
- What a person did wrong raises [`InputError`](errors.md#inputerror) with place, reason and remedy; the other
  errors are in [fdvv.errors](errors.md).
- A parameter without a default is needed. One whose meaning is left empty is told in the text above it.

"""
KINDS = {
    "record": "record",
    "enumeration": "enumeration",
    "error": "error",
    "contract": "contract",
    "class": "class",
    "function": "function",
    "value": "constant",
}


def pages() -> dict[str, str]:
    """Give every page by the name of its file."""
    return {"README.md": index(), **{f"{_short(room)}.md": page(room) for room in rooms()}}


def index() -> str:
    """Give the page that leads to the others, with the words that mean the same everywhere."""
    rows = [
        (f"[{room}]({_short(room)}.md)", f"{len(things(room))}", escaped(_head(room))) for room in rooms()
    ]
    text = INTRODUCTION + "## Rooms\n\n" + table(("room", "names", "what it holds"), rows)
    text += "\n## Words\n\nWhat a parameter or field means where its own text says nothing else.\n\n"
    everywhere = [(f"`{name}`", escaped(told)) for name, told in WORDS[EVERYWHERE].items()]
    return text + table(("name", "meaning"), everywhere)


def page(room: str) -> str:
    """Give the page of one room."""
    found = things(room)
    marks = slugs([room, *(thing.name for thing in found)])[1:]
    doc = inspect.cleandoc(importlib.import_module(room).__doc__ or "")
    rows = [
        (f"[`{thing.name}`](#{mark})", KINDS[thing.kind], escaped(thing.said.head if thing.said else ""))
        for thing, mark in zip(found, marks, strict=True)
    ]
    top = f"# {room}\n\n{escaped(doc)}\n\n{MADE} [How to read this](README.md#how-to-read-it).\n"
    contents = table(("name", "", "what it is"), rows) if rows else "Nothing is offered here yet.\n"
    return "\n".join([top, contents, *(_section(thing) for thing in found)])


def _section(thing: Thing) -> str:
    parts = [f"## {thing.name}\n", f"```python\n{thing.signature}\n```\n", *_told(thing.said)]
    if thing.parts:
        parts.append(_parts(thing))
    for method in thing.methods:
        parts += [f"```python\n{thing.name}.{method.signature}\n```\n", *_told(method.said)]
        if method.parts:
            parts.append(_parts(method))
    return "\n".join(parts)


def _told(said: Said | None) -> list[str]:
    if said is None:
        return []
    return [f"{escaped(said.head)}\n", *(_paragraph(text) for text in said.body)]


def _paragraph(text: str) -> str:
    if text.startswith("    "):
        return f"```text\n{inspect.cleandoc(text)}\n```\n"
    return f"{escaped(text)}\n"


def _parts(thing: Thing) -> str:
    if thing.kind == "enumeration":
        return table(("member", "value", "meaning"), [_member(part) for part in thing.parts])
    rows = [(*_row(part), _meaning(part, thing.room)) for part in thing.parts]
    return table(("name", "type", "default", "unit", "meaning"), rows)


def _member(part: Part) -> tuple[str, str, str]:
    return f"`{part.name}`", f"`{part.type}`", escaped(part.meaning)


def _row(part: Part) -> tuple[str, str, str, str]:
    type_, default = (f"`{text}`" if text else "" for text in (part.type, part.default))
    return f"`{part.name}`", type_, default, part.unit


def _meaning(part: Part, room: str) -> str:
    """Give the meaning; where there is none, what its type leads to."""
    if part.meaning:
        return escaped(part.meaning)
    return ", ".join(_link(name, room) for name in dict.fromkeys(classes_in(part.type)))


def _link(name: str, room: str) -> str:
    home = class_homes()[name]
    found = [thing.name for thing in things(home)]
    mark = slugs([home, *found])[1 + found.index(name)]
    return f"[`{name}`]({'' if home == room else f'{_short(home)}.md'}#{mark})"


def _short(room: str) -> str:
    return room.removeprefix("fdvv.")


def _head(room: str) -> str:
    return (inspect.getdoc(importlib.import_module(room)) or "").partition("\n")[0]


if __name__ == "__main__":
    made = pages()
    for old in set(FOLDER.glob("*.md")) - {FOLDER / name for name in made}:
        old.unlink()
    for name, text in made.items():
        write_atomic(FOLDER / name, text)
    print(FOLDER)

"""Write the reference of every file and every studio message: ``python -m tools.make_record_reference``."""

from __future__ import annotations

import importlib
import json
import tomllib
import typing
from dataclasses import dataclass, replace
from functools import cache
from inspect import isclass
from pathlib import Path
from typing import Any

from msgspec import NODEFAULT, inspect, to_builtins
from tools.api_reading import Part, Thing, class_thing
from tools.api_signatures import LONGEST_VALUE
from tools.markdown import escaped, table
from tools.record_types import fields, in_words, reached, records_in

from fdvv.files import write_atomic
from fdvv.studio import load_parts

REFERENCE = Path(__file__).parents[1] / "docs" / "reference"
COMMAND = "python -m tools.make_record_reference"


@dataclass(frozen=True)
class FileKind:
    """A kind of file.

    Attributes
    ----------
    title : what people call it. names : of such files. told : what it is for, in Markdown.
    records : module and name below fdvv of what its lines, or the whole of it, hold.
    """

    title: str
    names: str
    told: str
    records: tuple[str, ...]

    @property
    def classes(self) -> tuple[type[Any], ...]:
        """Get the records; a union stands for all that it joins."""
        return tuple(cls for name in self.records for cls in _classes(name))


def _classes(name: str) -> tuple[type[Any], ...]:
    module, _, attribute = name.partition(":")
    found = getattr(importlib.import_module(f"fdvv.{module}"), attribute)
    return typing.get_args(found) or (found,)


KINDS_FILE = Path(__file__).with_name("file_kinds.toml")
FILES = tuple(
    FileKind(it["title"], it["names"], " ".join(it["told"].split()), tuple(it["records"]))
    for it in tomllib.loads(KINDS_FILE.read_text(encoding="utf-8"))["file"]
)
SAME = {
    "recording._records:HeadRecord": "recording:Recording",
    "recording._records:BenchRecord": "recording:Bench",
    "recording._records:TakeRecord": "recording:Take",
    "recording._records:StreamRecord": "recording:Stream",
    "recording._records:MarkRecord": "recording:Mark",
    "recording._records:MendRecord": "recording:Mend",
    "compensate._rig_file:RigRecord": "compensate:KnownRig",
    "vibration._exciter_file:ExciterRecord": "vibration:KnownExciter",
}
"""Records of files whose fields are those of a record in memory, which tells their meaning."""
FILES_HEAD = f"""# Files, field by field

Made from the records that check them, by `{COMMAND}`; do not edit.

Every file that this package writes for people or for itself, and every field of it. What is not named
here belongs in no file, and most readers refuse it by its name. A field without a default must be there.
Units are the last part of a name. Numbers are finite. An array in JSON is a
[column](recording-file.md#a-column): exact to the bit.

Files of people's own numbers are told elsewhere: [rig and finger](rig.md), [real button](button.md),
[force files](force-files.md), [logs](log-files.md).

## Journals

A journal is a text file of JSON lines, `{{"crc32": …, "record": …}}`, that only grows; each line is forced to
the disk before anything follows from it. `crc32` is that of the record's bytes as they stand in the line. A
last line that is cut short is left out, a damaged one before it is refused with its number. One process at a
time writes.
"""
MESSAGES_HEAD = f"""# Messages of the studio

Made from their types by `{COMMAND}`; do not edit. The same types make `web/src/net/messages.ts`.

The page and `fdvv studio` speak JSON. A **call** is `POST /api/NAME` with one message and is answered with
one, or with a status of 400 or above and a line of text. A **channel** is part of the one WebSocket of a
page: messages come and go, each tagged by `type`. Whatever is not named here is refused. Nothing is answered
without the token of the address that was printed ([what else is refused](../explanation/studio.md)). These
messages may change with any version: page and server come from one package.
"""


def files_page() -> str:
    """Give the page of all files."""
    rows = [(f"[{kind.title}](#{_mark(kind.title)})", kind.names, kind.told) for kind in FILES]
    parts = [FILES_HEAD, table(("file", "names", ""), rows)]
    for kind in FILES:
        parts.append(f"## {kind.title}\n\n{kind.names}. {kind.told}\n")
        parts += [_section(record, "###") for record in reached(kind.classes)]
    return "\n".join(parts)


def messages_page() -> str:
    """Give the page of all calls and channels."""
    found = load_parts()
    calls = [
        (f"`{call.name}`", _linked(call.ask), _linked(call.answer)) for _, call in sorted(found.calls.items())
    ]
    channels = [
        (f"`{name}`", ", ".join(map(_linked, kind.asks)), ", ".join(map(_linked, kind.tells)))
        for name, kind in sorted(found.channels.items())
    ]
    parts = [
        MESSAGES_HEAD,
        f"## Calls\n\n{table(('call', 'asks', 'answers'), calls)}",
        f"## Channels\n\n{table(('channel', 'the page sends', 'the server sends'), channels)}",
        "## Records\n",
    ]
    return "\n".join([*parts, *(_section(record, "###") for record in messages())])


@cache
def messages() -> list[type[Any]]:
    """Give every record of the studio's messages, by name."""
    found = load_parts()
    roots = [cls for call in found.calls.values() for cls in (call.ask, call.answer)]
    roots += [cls for kind in found.channels.values() for cls in (*kind.asks, *kind.tells)]
    return sorted(reached(tuple(roots)), key=lambda cls: (cls.__name__.lower(), cls.__name__))


def thing_of(record: type[Any]) -> Thing:
    """Read a record with what is said of it."""
    if record not in _THINGS:
        _THINGS[record] = _thing(record)
    return _THINGS[record]


_THINGS: dict[type[Any], Thing] = {}


def _thing(record: type[Any]) -> Thing:
    room = ".".join(record.__module__.split(".")[:2])
    found = class_thing(record.__name__, room, record)
    twin = SAME.get(f"{record.__module__.removeprefix('fdvv.')}:{record.__name__}")
    if twin is None:
        return found
    (cls,) = _classes(twin)
    told = {part.name: part for part in class_thing(cls.__name__, room, cls).parts}
    parts = (
        replace(p, meaning=told[p.name].meaning, told=True) if p.name in told else p for p in found.parts
    )
    return replace(found, parts=tuple(parts))


def is_told(field: inspect.Field, part: Part) -> bool:
    """Tell whether it is said what a field is, by itself, by the text around it or by the record in it."""
    return part.told or bool(list(records_in(field.type)))


def _section(record: type[Any], mark: str) -> str:
    thing = thing_of(record)
    said = [thing.said.head, *thing.said.body] if thing.said else []
    parts = [f"{mark} {record.__name__}\n", *(f"{escaped(text)}\n" for text in said)]
    told = {part.name: part for part in thing.parts}
    rows = [_row(field, told[field.name]) for field in fields(record)]
    info = inspect.type_info(record)
    if isinstance(info, inspect.StructType) and info.tag_field:
        rows.insert(0, (f"`{info.tag_field}`", f'`"{info.tag}"`', "", "", "tells it from others"))
    return "\n".join([*parts, table(("field", "type", "default", "unit", "meaning"), rows) if rows else ""])


def _row(field: inspect.Field, part: Part) -> tuple[str, str, str, str, str]:
    shown = f"`{_default(field)}`" if not field.required else ""
    return f"`{field.encode_name}`", in_words(field.type), shown, part.unit, escaped(part.meaning)


def _default(field: inspect.Field) -> str:
    """Give what stands for a field that is left out, as JSON."""
    made = field.default
    if made is NODEFAULT:
        if not isclass(field.default_factory):
            return "…"  # made anew each time, as a date is
        made = field.default_factory()
    text = json.dumps(to_builtins(made), ensure_ascii=False)
    return text if len(text) <= LONGEST_VALUE else "…"


def _linked(record: type[Any]) -> str:
    return f"[{record.__name__}](#{_mark(record.__name__)})"


def _mark(title: str) -> str:
    return title.lower().replace(" ", "-")


PAGES = {"files.md": files_page, "studio-messages.md": messages_page}

if __name__ == "__main__":
    for name, page in PAGES.items():
        write_atomic(REFERENCE / name, page())
        print(REFERENCE / name)

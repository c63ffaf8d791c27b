"""Write the tables of every file and every studio message, for the site."""

from __future__ import annotations

import json
from collections.abc import Collection
from functools import cache
from inspect import isclass
from typing import Any

from msgspec import NODEFAULT, inspect, to_builtins
from tools.file_kinds import FILES, FileKind, members
from tools.make_studio_types import shown_settings
from tools.markdown import escaped, slug, table
from tools.record_docs import FieldDoc, describe
from tools.record_types import fields, in_words, reached

from fdvv.cli.settings import option_name
from fdvv.settings import Setting, settings_of
from fdvv_studio.studio.parts import load_parts

COLUMNS = ("setting", "option", "allowed", "default", "meaning")
MAX_DEFAULT = 60
"""A longer default is shown as an ellipsis."""


def files_tables() -> str:
    """Return the tables of all files."""
    rows = [(f"[{kind.title}](#{slug(kind.title)})", kind.names, kind.purpose) for kind in FILES]
    return "\n".join([table(("file", "names", "purpose"), rows), *(_kind(kind) for kind in FILES)])


def _kind(kind: FileKind) -> str:
    parts = [f"## {kind.title}\n\n{kind.names}. {kind.purpose}\n"]
    if len(kind.records) > 1:
        rows = [(f"`{where}`", _linked(*members(record))) for where, record in kind.records.items()]
        parts.append(table(("file or line", "record"), rows))
    return "\n".join([*parts, *(_record(record, kind.needed) for record in reached(kind.classes))])


def message_tables() -> str:
    """Return the tables of all calls, channels and their records."""
    studio = load_parts()
    calls = [
        (f"`{call.name}`", _linked(call.ask), _linked(call.answer))
        for _, call in sorted(studio.calls.items())
    ]
    channels = [
        (f"`{name}`", _linked(*channel.asks), _linked(*channel.tells))
        for name, channel in sorted(studio.channels.items())
    ]
    parts = [
        f"## Calls\n\n{table(('call', 'request', 'answer'), calls)}",
        f"## Channels\n\n{table(('channel', 'the page sends', 'the server sends'), channels)}",
        "## Records\n",
    ]
    return "\n".join([*parts, *(_record(record) for record in messages())])


def settings_tables() -> str:
    """Return a table for the settings of each use case: what they mean and allow, in every door."""
    return "\n".join(
        f"## {name.capitalize()}\n\n{table(COLUMNS, [_setting_row(one) for one in settings_of(kind)])}"
        for name, kind in shown_settings().items()
    )


def _setting_row(setting: Setting) -> tuple[str, str, str, str, str]:
    several = f"1 to {setting.longest} of " if setting.several else ""
    default = f"`{json.dumps(setting.default)}`"
    return (
        f"`{setting.name}`",
        f"`{option_name(setting)}`",
        several + setting.allowed,
        default,
        escaped(setting.help),
    )


@cache
def messages() -> list[type[Any]]:
    """Return every record of the studio's messages, by name."""
    studio = load_parts()
    roots = [cls for call in studio.calls.values() for cls in (call.ask, call.answer)]
    roots += [cls for channel in studio.channels.values() for cls in (*channel.asks, *channel.tells)]
    return sorted(reached(tuple(roots)), key=lambda cls: (cls.__name__.lower(), cls.__name__))


def _record(record: type[Any], needed: Collection[str] = ()) -> str:
    doc = describe(record)
    texts = [doc.text.summary, *doc.text.paragraphs] if doc.text else []
    rows = [_row(field, doc.fields[field.name], needed) for field in fields(record)]
    info = inspect.type_info(record)
    if isinstance(info, inspect.StructType) and info.tag_field:
        rows.insert(0, (f"`{info.tag_field}`", f'`"{info.tag}"`', "", "", "names the record"))
    parts = [f"### {record.__name__}\n", *(f"{escaped(text)}\n" for text in texts)]
    return "\n".join([*parts, table(("field", "type", "default", "unit", "meaning"), rows) if rows else ""])


def _row(field: inspect.Field, doc: FieldDoc, needed: Collection[str]) -> tuple[str, str, str, str, str]:
    default = "" if field.required or field.name in needed else f"`{_default(field)}`"
    return f"`{field.encode_name}`", in_words(field.type), default, doc.unit, escaped(doc.meaning)


def _default(field: inspect.Field) -> str:
    """Return a default as JSON."""
    value = field.default
    if value is NODEFAULT:
        if not isclass(field.default_factory):
            return "…"  # new at each call, for example a date
        value = field.default_factory()
    text = json.dumps(to_builtins(value), ensure_ascii=False)
    return text if len(text) <= MAX_DEFAULT else "…"


def _linked(*records: type[Any]) -> str:
    return ", ".join(f"[{record.__name__}](#{slug(record.__name__)})" for record in records)

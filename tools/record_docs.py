"""Describe the records of files and messages: text, and the meaning and unit of each field."""

from __future__ import annotations

import ast
import dataclasses
import inspect
import tomllib
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import msgspec
from tools.docstrings import Text, mentions, read
from tools.record_types import fields, records_in

WORDS: dict[str, str] = tomllib.loads(
    Path(__file__).with_name("field_words.toml").read_text(encoding="utf-8")
)
COMPOUND_UNITS = {
    "N_s_m": "N s/m",
    "N_m": "N/m",
    "N_A": "N/A",
    "K_W": "K/W",
    "m_s2": "m/s²",
    "mm_s2": "mm/s²",
    "mm_s": "mm/s",
    "m_s": "m/s",
    "px_s": "px/s",
    "cN_mm": "cN/mm",
    "cN_s": "cN/s",
    "cN2": "cN²",
    "N_s": "N/s",
    "1_s": "1/s",
    "1_s2": "1/s²",
    "1_m": "1/m",
    "um16": "1/16 µm",
    "mm_s16": "1/16 mm/s",
    "cN64": "1/64 cN",
    "q15": "1/32768",
    "ratio": "1",
    "us": "µs",
    "um": "µm",
    "ohm": "Ω",
    "degC": "°C",
    "usd": "US$",
    "jnd": "JND",
}
PLAIN_UNITS = [
    "mm",
    "m",
    "cN",
    "N",
    "gf",
    "s",
    "ms",
    "Hz",
    "kHz",
    "kg",
    "g",
    "K",
    "W",
    "V",
    "mV",
    "A",
    "J",
    "mJ",
    "dB",
    "rad",
    "lx",
    "Pa",
    "px",
    "percent",
    "kB",
    "bytes",
    "JND",
]
UNITS = {unit: unit for unit in PLAIN_UNITS} | COMPOUND_UNITS


@dataclass(frozen=True)
class FieldDoc:
    """A field of a record: its meaning and whether its record's text or its type explain it as well."""

    name: str
    meaning: str
    explained: bool

    @property
    def unit(self) -> str:
        """Return the unit at the end of the name, or an empty string."""
        return unit_of(self.name)


@dataclass(frozen=True)
class RecordDoc:
    """The text of a record and its fields by name."""

    text: Text | None
    fields: dict[str, FieldDoc]


def unit_of(name: str) -> str:
    """Return the unit at the end of a name, or an empty string."""
    pieces = name.split("_")
    ends = ("_".join(pieces[first:]) for first in range(1, len(pieces)))
    return next((UNITS[end] for end in ends if end in UNITS), "")


def describe(record: type[Any]) -> RecordDoc:
    text, meanings, doc = _own(record)
    described = {}
    for field in fields(record):
        own_type = _has_own_type(field.type)
        meaning = meanings.get(field.name) or _word(record, field.name, own_type)
        explained = bool(meaning) or own_type or mentions(doc, field.name)
        described[field.name] = FieldDoc(field.name, meaning, explained)
    return RecordDoc(text, described)


def _has_own_type(kind: msgspec.inspect.Type) -> bool:
    """Return whether a type is, or contains, a record or an enumeration, which explains itself."""
    kinds = kind.types if isinstance(kind, msgspec.inspect.UnionType) else (kind,)
    return any(True for _ in records_in(kind)) or any(
        isinstance(one, msgspec.inspect.EnumType) for one in kinds
    )


def _word(record: type[Any], name: str, own_type: bool) -> str:
    return WORDS.get(f"{record.__name__}.{name}") or ("" if own_type else WORDS.get(name, ""))


def _own(record: type[Any]) -> tuple[Text | None, dict[str, str], str]:
    """Return a record's text, the meanings that its source and its bases state, and their docstrings."""
    by_dataclass = (record.__doc__ or "").startswith(f"{record.__name__}(")
    doc = "" if by_dataclass else inspect.cleandoc(record.__doc__ or "")
    text, entries = read(doc, _names(record))
    entries = _beside_fields(record) | entries
    for base in record.__mro__[1:]:
        if issubclass(base, msgspec.Struct) and base.__struct_fields__:
            shared = inspect.cleandoc(base.__doc__ or "")
            entries, doc = read(shared, _names(record))[1] | entries, f"{doc} {shared}"
    return text, entries, doc


def _names(record: type[Any]) -> tuple[str, ...]:
    if dataclasses.is_dataclass(record):
        return tuple(field.name for field in dataclasses.fields(record))
    return tuple(field.name for field in fields(record))


def _beside_fields(record: type[Any]) -> dict[str, str]:
    """Return the meanings stated at the fields: a string below, metadata, a description of the schema."""
    meanings: dict[str, str] = {}
    for base in reversed(record.__mro__):
        if base.__module__.startswith("fdvv"):
            meanings |= _strings_below(base)
    if dataclasses.is_dataclass(record):
        meanings |= {f.name: text for f in dataclasses.fields(record) if (text := _metadata(f))}
    elif issubclass(record, msgspec.Struct):
        schemas = {f.name: getattr(f.type, "extra_json_schema", None) or {} for f in fields(record)}
        meanings |= {
            name: schema["description"] for name, schema in schemas.items() if "description" in schema
        }
    return meanings


def _metadata(field: dataclasses.Field[Any]) -> str:
    about = field.metadata.get("about")
    meaning = about.text if about else field.metadata.get("meaning", "")
    source = about.source if about else field.metadata.get("source", "")
    return f"{meaning} (source: {source})" if source else str(meaning)


@cache
def _tree(path: str) -> ast.Module:
    return ast.parse(Path(path).read_text(encoding="utf-8"))


def _strings_below(record: type[Any]) -> dict[str, str]:
    classes = (n for n in ast.walk(_tree(inspect.getfile(record))) if isinstance(n, ast.ClassDef))
    body = next((node.body for node in classes if node.name == record.__name__), [])
    return {
        node.target.id: inspect.cleandoc(after.value.value)
        for node, after in pairwise(body)
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name)
        if isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant)
        if isinstance(after.value.value, str)
    }

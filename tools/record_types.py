"""Types of records in words, as a reader of JSON meets them, with their bounds."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from msgspec import inspect

PLAIN: dict[type[Any], str] = {
    inspect.AnyType: "anything",
    inspect.NoneType: "null",
    inspect.BoolType: "true or false",
    inspect.IntType: "whole number",
    inspect.FloatType: "number",
    inspect.StrType: "text",
    inspect.BytesType: "text in base64",
    inspect.RawType: "anything",
    inspect.DateTimeType: "ISO 8601",
}
RECORDS = (inspect.StructType, inspect.DataclassType)
LISTS = (inspect.ListType, inspect.VarTupleType, inspect.SetType)


def in_words(kind: inspect.Type) -> str:
    """Return a type in words; a record of the package is its name, as code."""
    if isinstance(kind, inspect.Metadata):
        return in_words(kind.type)
    if isinstance(kind, RECORDS):
        return f"`{kind.cls.__name__}`"
    if isinstance(kind, inspect.EnumType):
        return " or ".join(_literal(member.value) for member in kind.cls)
    if isinstance(kind, inspect.LiteralType):
        return " or ".join(_literal(value) for value in kind.values)
    if isinstance(kind, inspect.UnionType):
        return " or ".join(in_words(one) for one in kind.types)
    if isinstance(kind, LISTS):
        return f"list of {in_words(kind.item_type)}{_length(kind)}"
    if isinstance(kind, inspect.TupleType):
        return f"list of {len(kind.item_types)}: {', '.join(in_words(one) for one in kind.item_types)}"
    if isinstance(kind, inspect.DictType):
        return f"object of {in_words(kind.value_type)} by {in_words(kind.key_type)}"
    return PLAIN[type(kind)] + _bounds(kind)


def _literal(value: object) -> str:
    return f'`"{value}"`' if isinstance(value, str) else f"`{value}`"


def _bounds(kind: inspect.Type) -> str:
    marks = (("ge", "≥"), ("gt", ">"), ("le", "≤"), ("lt", "<"))
    limits = [f"{mark} {value:g}" for name, mark in marks if (value := getattr(kind, name, None)) is not None]
    return (f" {', '.join(limits)}" if limits else "") + _length(kind)


def _length(kind: inspect.Type) -> str:
    low, high = getattr(kind, "min_length", None), getattr(kind, "max_length", None)
    if low is not None and high is not None:
        return f" ({low} to {high} long)"
    if high is not None:
        return f" (at most {high} long)"
    return f" (at least {low} long)" if low else ""


def fields(record: type[Any]) -> tuple[inspect.Field, ...]:
    """Return the fields of a record."""
    if record not in _FIELDS:
        info = inspect.type_info(record)
        assert isinstance(info, RECORDS), record
        _FIELDS[record] = info.fields
    return _FIELDS[record]


_FIELDS: dict[type[Any], tuple[inspect.Field, ...]] = {}


def reached(records: tuple[type[Any], ...]) -> list[type[Any]]:
    """Return records and all that they hold, each once, outer ones first."""
    found: dict[type[Any], None] = {}

    def follow(record: type[Any]) -> None:
        if record not in found:
            found[record] = None
            for field in fields(record):
                for inner in records_in(field.type):
                    follow(inner)

    for record in records:
        follow(record)
    return list(found)


def records_in(kind: inspect.Type) -> Iterator[type[Any]]:
    """Return the records that a type names."""
    if isinstance(kind, RECORDS):
        yield kind.cls
    elif isinstance(kind, inspect.UnionType):
        for one in kind.types:
            yield from records_in(one)
    elif isinstance(kind, inspect.TupleType):
        for one in kind.item_types:
            yield from records_in(one)
    elif isinstance(kind, LISTS):
        yield from records_in(kind.item_type)
    elif isinstance(kind, inspect.DictType):
        yield from records_in(kind.value_type)
    elif isinstance(kind, inspect.Metadata):
        yield from records_in(kind.type)

"""Random values for messages: right by type, or wrong in every way a stranger may think of."""

from __future__ import annotations

import random
from typing import Any

import msgspec
from msgspec import inspect

NASTY = (
    *("../../../etc/passwd", "..\\..\\secret", "/etc/passwd", "own:../../x", "builtin:../builtin/mx-clear"),
    *("measured:zz", "own:", ":", "%2e%2e%2f", "a" * 5000, "\u0000", "\u202e", "\ud83d", "💥", "own:a/b"),
    *("<img src=x onerror=alert(1)>", "'; DROP TABLE x; --", "__proto__", "con", "..", ".", "", "NaN"),
    *("builtin:mx-clear", "shipped:button"),
)
NUMBERS = (0, -1, 1, 2**31, 2**53, -(2**63), 2**64, 1e308, -1e308, 5e-324, 0.1, 1e9, 3.5)


def any_value(draw: random.Random, depth: int = 0) -> Any:
    kind = draw.randrange(8 if depth < 4 else 5)
    if kind == 0:
        return draw.choice((None, True, False))
    if kind < 3:
        return draw.choice(NUMBERS)
    if kind < 5:
        return draw.choice(NASTY)
    if kind == 5:
        return [any_value(draw, depth + 1) for _ in range(draw.randrange(5))]
    return {draw.choice(("name", "type", "id", "curves", "x")): any_value(draw, depth + 1) for _ in range(3)}


def typed_value(kind: inspect.Type, draw: random.Random, depth: int = 0) -> Any:
    """Return a value that a type may take; now and then one that it may not."""
    if draw.random() < 0.03:
        return any_value(draw)
    if isinstance(kind, inspect.Metadata):
        return typed_value(kind.type, draw, depth)
    if isinstance(kind, inspect.StructType):
        fields = [f for f in kind.fields if f.required or (depth < 3 and draw.random() < 0.7)]
        tag = {kind.tag_field: kind.tag} if kind.tag_field else {}
        return {**tag, **{f.encode_name: typed_value(f.type, draw, depth + 1) for f in fields}}
    if isinstance(kind, inspect.UnionType):
        return typed_value(draw.choice(kind.types), draw, depth)
    if isinstance(kind, inspect.ListType | inspect.VarTupleType | inspect.SetType):
        return [typed_value(kind.item_type, draw, depth + 1) for _ in range(draw.randrange(4))]
    if isinstance(kind, inspect.TupleType):
        return [typed_value(t, draw, depth + 1) for t in kind.item_types]
    if isinstance(kind, inspect.DictType):
        return {draw.choice(NASTY): typed_value(kind.value_type, draw, depth + 1) for _ in range(2)}
    if isinstance(kind, inspect.EnumType):
        return draw.choice([m.value for m in kind.cls])
    if isinstance(kind, inspect.LiteralType):
        return draw.choice(kind.values)
    return _plain(kind, draw)


def _plain(kind: inspect.Type, draw: random.Random) -> Any:
    if isinstance(kind, inspect.BoolType):
        return draw.random() < 0.5
    if isinstance(kind, inspect.IntType):
        return draw.choice((0, 1, 2, 3, -1, 10**6, 2**62))
    if isinstance(kind, inspect.FloatType):
        return draw.choice(NUMBERS)
    if isinstance(kind, inspect.StrType):
        return draw.choice(NASTY)
    return None if isinstance(kind, inspect.NoneType) else any_value(draw)


def question(ask: type[msgspec.Struct], draw: random.Random) -> Any:
    """Return what a stranger may send where ``ask`` is wanted."""
    return typed_value(inspect.type_info(ask), draw)

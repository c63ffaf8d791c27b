"""Structures of the C kernels as ctypes classes, read from the headers that lie beside the library."""

from __future__ import annotations

import ctypes
import re
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any, cast

from fdvv.errors import BuildError

HEADERS = ("fdvv.h", "rig.h", "button.h", "twin.h")
COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
STRUCT = re.compile(r"typedef struct \{([^{}]*)\} (\w+);")
FIELD = re.compile(r"(?:const )?(\w+) (\*?)(\w+)(?:\[(\d+)\])?")
SCALARS = {"double": ctypes.c_double, "int64_t": ctypes.c_int64}


@cache
def structure(name: str) -> type[ctypes.Structure]:
    """Return the ctypes class of a structure of doubles, int64_t, pointers, arrays and such structures."""
    fields: list[tuple[str, Any]] = []
    for declaration in filter(None, map(str.strip, _bodies()[name].split(";"))):
        match = FIELD.fullmatch(declaration)
        if not match:
            raise BuildError(f"{name}: {declaration!r} cannot be read from the C header")
        base, pointer, field, count = match.groups()
        kind: Any = ctypes.c_void_p if pointer else SCALARS.get(base) or structure(base)
        fields.append((field, kind * int(count) if count else kind))
    return cast("type[ctypes.Structure]", type(name, (ctypes.Structure,), {"_fields_": fields}))


def fill(name: str, values: Mapping[str, Any]) -> ctypes.Structure:
    """Return a structure with these values: a mapping or structure for a nested one, a sequence for an array.

    Raises TypeError unless the keys are the names of all its fields.
    """
    record = structure(name)()
    fields: dict[str, Any] = {field[0]: field[1] for field in record._fields_}
    if fields.keys() != values.keys():
        raise TypeError(f"{name}: wrong or missing fields {sorted(fields.keys() ^ values.keys())}")
    for field, kind in fields.items():
        value = values[field]
        if isinstance(value, Mapping):
            value = fill(kind.__name__, value)
        elif issubclass(kind, ctypes.Array):
            value = kind(*value)
        setattr(record, field, value)
    return record


@cache
def _bodies() -> dict[str, str]:
    folder = Path(__file__).parent
    text = COMMENT.sub("", "".join((folder / header).read_text(encoding="utf-8") for header in HEADERS))
    return {name: body for body, name in STRUCT.findall(text)}

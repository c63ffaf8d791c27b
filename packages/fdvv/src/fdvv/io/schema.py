"""The JSON schemas of files: the docstring of a record says what its fields mean."""

from __future__ import annotations

import inspect
import re
from collections.abc import Sequence
from typing import Any

import msgspec

from fdvv.io.documents import PLAIN, Kind, Layout

DIALECT = "https://json-schema.org/draft/2020-12/schema"


def schema_of(record: type, kind: Kind, layout: Layout = PLAIN) -> dict[str, Any]:
    """Return the JSON schema of a file of one record."""
    (ref,), parts = components([record], layout)
    add_head(parts[record.__name__], kind)
    return {"$schema": DIALECT, **ref, "$defs": parts}


def components(records: Sequence[type], layout: Layout = PLAIN) -> tuple[list[Any], dict[str, Any]]:
    """Return a reference to each record, and the schemas of all of them and of their parts by name."""
    refs, parts = msgspec.json.schema_components(records, ref_template="#/$defs/{name}")
    for part in parts.values():
        if "description" in part:  # before Python 3.13 a docstring keeps its indentation
            part["description"] = inspect.cleandoc(part["description"])
        if "properties" in part:
            describe(part, layout)
    return list(refs), parts


def add_head(schema: dict[str, Any], kind: Kind) -> None:
    """Put the head of a kind before the fields of a record."""
    head = {
        "format": {"description": "tells the file from other JSON", "enum": [kind.format]},
        "version": {"description": "of this format", "enum": list(kind.versions)},
    }
    schema["properties"] = head | schema["properties"]
    schema["required"] = [*head, *schema["required"]]


ENTRY = re.compile(r"^(\w+(?:, \w+)*) : (.*(?:\n .*)*)", re.MULTILINE)


def describe(schema: dict[str, Any], layout: Layout) -> None:
    """Complete a dataclass's schema: what its docstring says, the order of fields, and which are needed."""
    meanings = {
        name: " ".join(meaning.split()).rstrip(".").replace("None", "null")
        for names, meaning in ENTRY.findall(schema["description"])
        for name in names.split(", ")
    }
    schema["description"] = " ".join(schema["description"].partition("\n\n")[0].split())
    properties = schema["properties"]
    schema["properties"] = {
        name: {"description": meanings[name], **properties[name]} for name in layout.sort(properties)
    }
    for name in properties.keys() & set(layout.needed):
        schema["properties"][name].pop("default", None)
    schema["required"] = [
        name for name in schema["properties"] if name in schema["required"] or name in layout.needed
    ]
    schema["additionalProperties"] = False

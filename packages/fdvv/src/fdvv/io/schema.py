"""The JSON schemas of files: the docstring of a record says what its fields mean."""

from __future__ import annotations

import inspect
import re
from typing import Any

import msgspec

from fdvv.io.documents import PLAIN, Kind, Layout, tidy_schema


def schema_of(record: type, kind: Kind, layout: Layout = PLAIN) -> dict[str, Any]:
    """Return the JSON schema of a file of one record."""
    schema = tidy_schema(msgspec.json.schema(record))
    for part in schema["$defs"].values():
        if "properties" in part:
            describe(part, layout)
    top = schema["$defs"][record.__name__]
    head = {
        "format": {"description": "tells the file from other JSON", "enum": [kind.format]},
        "version": {"description": "of this format", "enum": list(kind.versions)},
    }
    top["properties"] = head | top["properties"]
    top["required"] = [*head, *top["required"]]
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}


ENTRY = re.compile(r"^(\w+(?:, \w+)*) : (.*(?:\n .*)*)", re.MULTILINE)


def describe(schema: dict[str, Any], layout: Layout) -> None:
    """Complete a dataclass's schema: what its docstring says, the order of fields, and which are needed."""
    text = inspect.cleandoc(schema["description"])
    schema["description"] = " ".join(text.partition("\n\n")[0].split())
    meanings = {
        name: " ".join(meaning.split()).rstrip(".").replace("None", "null")
        for names, meaning in ENTRY.findall(text)
        for name in names.split(", ")
    }
    properties = schema["properties"]
    schema["properties"] = {
        name: {"description": meanings[name], **properties[name]} for name in layout.sort(properties)
    }
    schema["required"] = [
        name for name in schema["properties"] if name in schema["required"] or name in layout.needed
    ]
    schema["additionalProperties"] = False

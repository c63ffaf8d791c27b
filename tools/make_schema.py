"""Write the published JSON schemas of model and program files: ``python tools/make_schema.py``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from fdvv.files import write_atomic
from fdvv.model import schema
from fdvv.program import schema as program_schema

REFERENCE = Path(__file__).parents[1] / "docs" / "reference"
OUTPUT = REFERENCE / "fdvv.schema.json"
PROGRAM_OUTPUT = REFERENCE / "fdvv-program.schema.json"


def text(found: dict[str, Any] | None = None) -> str:
    """Give a schema as it is published; by default that of the model file."""
    return json.dumps(schema() if found is None else found, indent=2, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    for path, found in ((OUTPUT, schema()), (PROGRAM_OUTPUT, program_schema())):
        write_atomic(path, text(found))
        print(path)

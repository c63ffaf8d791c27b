"""Write the published JSON schemas of models, programs, recordings: ``python tools/make_schema.py``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from fdvv.io.files import write_atomic
from fdvv.model.file import schema
from fdvv.program.file import schema as program_schema
from fdvv.recording.file import schema as recording_schema

REFERENCE = Path(__file__).parents[1] / "docs" / "reference"
OUTPUT = REFERENCE / "fdvv.schema.json"
PROGRAM_OUTPUT = REFERENCE / "fdvv-program.schema.json"
RECORDING_OUTPUT = REFERENCE / "fdvv-recording.schema.json"


def text(found: dict[str, Any] | None = None) -> str:
    """Return a schema as it is published; by default that of the model file."""
    return json.dumps(schema() if found is None else found, indent=2, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    every = {OUTPUT: schema(), PROGRAM_OUTPUT: program_schema(), RECORDING_OUTPUT: recording_schema()}
    for path, found in every.items():
        write_atomic(path, text(found))
        print(path)

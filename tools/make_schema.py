"""Write the published JSON schema of the model file: ``python tools/make_schema.py``."""

from __future__ import annotations

import json
from pathlib import Path

from fdvv.files import write_atomic
from fdvv.model import schema

OUTPUT = Path(__file__).parents[1] / "docs" / "reference" / "fdvv.schema.json"


def text() -> str:
    """Give the schema as it is published."""
    return json.dumps(schema(), indent=2, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    write_atomic(OUTPUT, text())
    print(OUTPUT)

"""What other people's programs say of random answers: made by files/answers.R, and by pingouin 0.7.0."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

FILES = Path(__file__).parent / "files"


def golden(name: str, file: str = "answers", least: int = 200) -> list[Any]:
    found: list[Any] = json.loads((FILES / f"{file}.json").read_text())[name]
    assert len(found) >= least
    return found

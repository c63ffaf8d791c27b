"""What other people's programs say of random answers: made by files/answers.R, and by pingouin 0.7.0."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from tests.support.campaign import campaign

FILES = Path(__file__).parent / "files"
TENTHS = campaign("start", range(10), part=1)
"""Of what other people's programs say: every tenth answer from the start that is drawn."""


def golden(name: str, file: str = "answers", least: int = 200) -> list[Any]:
    found: list[Any] = json.loads((FILES / f"{file}.json").read_text())[name]
    assert len(found) >= least
    return found

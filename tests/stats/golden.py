"""What other people's programs say of random answers: made by files/answers.R, and by pingouin 0.7.0."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

FILES = Path(__file__).parent / "files"
EVERY = pytest.mark.parametrize("every", [10, pytest.param(1, marks=pytest.mark.slow)])
"""Of what other people's programs say: a tenth by default, all of it in the slow run."""


def golden(name: str, file: str = "answers", least: int = 200) -> list[Any]:
    found: list[Any] = json.loads((FILES / f"{file}.json").read_text())[name]
    assert len(found) >= least
    return found

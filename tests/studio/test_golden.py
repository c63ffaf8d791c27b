"""The numbers that the page is checked against are those of the code."""

from __future__ import annotations

import importlib.util
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]


def test_the_golden_numbers_are_those_of_the_code() -> None:
    spec = importlib.util.spec_from_file_location("golden", REPOSITORY / "tools" / "make_studio_golden.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    for name, text in module.reference():
        assert (module.TARGET / name).read_text() == text, "run python tools/make_studio_golden.py"

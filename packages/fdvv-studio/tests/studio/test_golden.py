"""The numbers that the page is checked against are those of the code."""

from __future__ import annotations

import json
import math
from typing import Any

from tools import make_studio_golden


def alike(a: Any, b: Any) -> bool:
    """Compare two documents: numbers within rounding, all else exactly."""
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(alike(a[key], b[key]) for key in a)
    if isinstance(a, list) and isinstance(b, list):
        return len(a) == len(b) and all(map(alike, a, b))
    if isinstance(a, float) and isinstance(b, float | int):
        return math.isclose(a, b, rel_tol=1e-9, abs_tol=1e-9)
    return bool(a == b)


def test_the_golden_numbers_are_those_of_the_code() -> None:
    for name, text in make_studio_golden.reference():
        kept = json.loads((make_studio_golden.TARGET / name).read_text())
        # the last digits are those of the NumPy and SciPy at hand
        assert alike(kept, json.loads(text)), f"{name}: run python tools/make_studio_golden.py"

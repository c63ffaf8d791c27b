"""A number at the head of a module has its reason beside it."""

from __future__ import annotations

import pytest
from tools.check_reasons import unexplained

EXPLAINED = (
    "STEP_mm = 0.01  # finer than any file's",
    "# finer than any file's\nSTEP_mm = 0.01",
    'STEP_mm = 0.01\n"""Finer than any file\'s."""',
    'LOW, HIGH = 1, 2\nSTEP_mm = 0.01\n"""Of all three."""',
    "STEPS = (\n    0.01,  # finer than any file's\n    0.02,\n)",
    'WORD = "mm"\nFLAG = True\nSTEP_mm = step()',
    "def step():\n    step_mm = 0.01",
)
BARE = (
    "STEP_mm = 0.01",
    "STEP_mm: float = -0.01",
    "STEPS = (0.01, 2 * 0.01)",
    'STEP_mm = 0.01\n\n"""Far away."""',
    'STEP_mm = 0.01\nWORD = step()\n\n\ndef step():\n    """Return."""',
)


@pytest.mark.parametrize("source", EXPLAINED)
def test_a_reason_may_stand_behind_before_or_below(source: str) -> None:
    assert list(unexplained(source)) == []


@pytest.mark.parametrize("source", BARE)
def test_a_number_without_a_reason_is_named_with_its_line(source: str) -> None:
    assert list(unexplained(source)) == [(1, source.partition("\n")[0])]

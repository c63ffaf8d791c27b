"""Spoilt files: never a traceback, never taken for a button that was not measured, never slow."""

from __future__ import annotations

from pathlib import Path

import pytest
from benchmarks.mutilated import Found, run

SPOILT = 80


KNOWN = ("shifted force: Cherry-MX-Hyperglide-Black.csv",)
"""Garbage that is still accepted: the stop that the shift puts in the air is dropped as a spike."""


def check(found: Found, known: tuple[str, ...] = ()) -> None:
    assert found.tracebacks == []
    assert sorted(": ".join(one.split(": ")[:2]) for one in found.garbage) == sorted(known)
    assert found.unclear == []
    assert found.slow == []
    assert sum(found.accepted.values()) > 0.1 * sum(found.kinds.values())


def test_spoilt_copies_of_the_shipped_example_are_refused_or_right() -> None:
    examples = Path(__file__).parents[2] / "src" / "fdvv" / "button" / "examples"
    check(run(SPOILT, examples, cheap=True))


@pytest.mark.slow
@pytest.mark.shared
@pytest.mark.timeout(900)
def test_a_thousand_spoilt_files_of_every_kind(shared_data: Path) -> None:
    found = run(1000, shared_data)
    check(found, KNOWN)

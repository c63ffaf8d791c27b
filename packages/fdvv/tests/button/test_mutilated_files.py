"""Spoilt files: never a traceback, never taken for a button that was not measured, never slow."""

from __future__ import annotations

from pathlib import Path

import pytest
from benchmarks.mutilated import WAYS, Found, run

from tests.support.campaign import campaign, in_turn


def check(found: Found) -> None:
    assert found.tracebacks == []
    assert found.garbage == []
    assert found.unclear == []
    assert found.slow == []
    assert sum(found.accepted.values()) > 0.1 * sum(found.kinds.values())


def test_spoilt_copies_of_the_shipped_example_are_refused_or_right() -> None:
    examples = Path(__file__).parents[4] / "packages/fdvv/src/fdvv/button/examples"
    check(run(range(80), examples, cheap=True))


@pytest.mark.slow
@pytest.mark.shared
@campaign("start", range(0, 1000, 100), part=1)
def test_a_thousand_spoilt_files_of_every_kind(shared_data: Path, start: int) -> None:
    check(run(range(start, start + 100), shared_data))


@pytest.mark.slow
@in_turn(5)
@pytest.mark.shared
def test_ways_that_no_gate_was_made_for_are_refused_but_for_one_in_fifty(shared_data: Path) -> None:
    """What remains are decibels, slow drift and small bursts."""
    found = run(range(410), shared_data, ways=WAYS["second"])
    assert len(found.garbage) <= 0.02 * 410
    found.garbage.clear()
    check(found)

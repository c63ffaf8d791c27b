"""Campaigns: long random tests of which a usual run plays a part and `make campaign` every case."""

from __future__ import annotations

import os
import random
import shutil
import subprocess
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TypeVar

import pytest

Test = TypeVar("Test", bound=Callable[..., object])

IS_WHOLE = bool(os.environ.get("FDVV_CAMPAIGN"))


def find_seed() -> str:
    """Return FDVV_SEED, else the commit, else 0."""
    if seed := os.environ.get("FDVV_SEED"):
        return seed
    command = [shutil.which("git") or "true", "rev-parse", "--short=12", "HEAD"]
    ran = subprocess.run(command, cwd=Path(__file__).parent, capture_output=True, text=True, check=False)
    return ran.stdout.strip() or "0"


SEED = os.environ["FDVV_SEED"] = find_seed()
"""Of this run and of the processes that it starts."""


def campaign(name: str | tuple[str, ...], cases: Iterable[object], part: int) -> Callable[[Test], Test]:
    """Mark a test as a campaign over cases; a usual run plays `part` of them, drawn by its seed."""

    def mark(test: Test) -> Test:
        every = list(cases)
        turn = every if IS_WHOLE else random.Random(f"{SEED} {test.__qualname__}").sample(every, part)
        marked: Test = pytest.mark.campaign(pytest.mark.parametrize(name, turn)(test))
        return marked

    return mark


def in_turn(every: int) -> Callable[[Test], Test]:
    """Mark a test as a campaign that one usual run in `every` plays, for what cannot be divided."""

    def mark(test: Test) -> Test:
        marked: Test = pytest.mark.campaign(wait_for_turn(test.__qualname__, every)(test))
        return marked

    return mark


def wait_for_turn(name: str, every: int) -> pytest.MarkDecorator:
    """Return the mark that skips a case in all usual runs but one in `every`. name : of the case."""
    waits = not IS_WHOLE and random.Random(f"{SEED} {name}").randrange(every)
    return pytest.mark.skipif(bool(waits), reason=f"one run in {every} plays this, make campaign each time")


def pick(usual: int, whole: int) -> int:
    """Return the size of a test that a campaign makes larger."""
    return whole if IS_WHOLE else usual

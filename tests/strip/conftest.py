"""The firmware's core as the LED strip's board."""

from __future__ import annotations

import pytest

from fdvv_strip.board import LedPointingTask
from fdvv_strip.library import LibraryStrip


@pytest.fixture
def line() -> LibraryStrip:
    return LibraryStrip()


@pytest.fixture
def strip(line: LibraryStrip) -> LedPointingTask:
    return LedPointingTask(line)

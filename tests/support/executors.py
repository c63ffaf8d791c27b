"""Executors for tests."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from typing import Any


class Here:
    """Works on chunks one after the other, in this process: most tests need no other."""

    processes = 1

    def run(
        self, work: Callable[[Any], Any], chunks: Sequence[Any]
    ) -> Generator[tuple[int, Any], None, None]:
        for place, chunk in enumerate(chunks):
            yield place, work(chunk)

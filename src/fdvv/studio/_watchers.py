"""Whoever wants to hear of changes, and is told of each, from any thread."""

from __future__ import annotations

from collections.abc import Callable
from threading import Lock
from typing import Generic, TypeVar

News = TypeVar("News")


class Watchers(Generic[News]):
    """Functions that are called with every piece of news, in the order in which they began to watch."""

    def __init__(self) -> None:
        self._watching: dict[Callable[[News], None], None] = {}
        self._lock = Lock()

    def watch(self, tell: Callable[[News], None]) -> None:
        """Call it from now on."""
        with self._lock:
            self._watching[tell] = None

    def forget(self, tell: Callable[[News], None]) -> None:
        """Call it no more; unknown ones are no fault."""
        with self._lock:
            self._watching.pop(tell, None)

    def tell(self, news: News) -> None:
        """Call all, outside the lock: whoever is told may watch or forget."""
        with self._lock:
            watching = tuple(self._watching)
        for tell in watching:
            tell(news)

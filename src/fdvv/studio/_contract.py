"""What a part of the studio offers to the page: calls that answer, channels that go on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

from msgspec import Struct

from fdvv.studio._studio import Studio

Tell = Callable[[Struct], None]
"""Sends a message to the page; may be called from any thread."""


@dataclass(frozen=True)
class Call:
    """A question that is answered once, served as ``POST /api/NAME``.

    Attributes
    ----------
    name : part and verb, such as ``library.search``.
    ask, answer : message types.
    function : runs in a worker thread. What it raises of FdvvError is one line on the page.
    """

    name: str
    ask: type[Struct]
    answer: type[Struct]
    function: Callable[[Studio, Any], Struct]


class Channel(Protocol):
    """One page's end of a channel."""

    def receive(self, ask: Any) -> None:
        """Take a message of the page; called in a worker thread, one after the other."""
        ...

    def close(self) -> None:
        """The page is gone."""
        ...


@dataclass(frozen=True)
class ChannelKind:
    """Messages that come and go as long as the page is open.

    Attributes
    ----------
    name : of the channel.
    asks, tells : message types, tagged: what the page sends and what it gets.
    open : called when a page first sends on it.
    """

    name: str
    asks: tuple[type[Struct], ...]
    tells: tuple[type[Struct], ...]
    open: Callable[[Studio, Tell], Channel]

"""What a part of the studio offers to the page: calls that are answered once, and channels."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from threading import Lock
from typing import Any, Generic, Protocol, TypeVar, dataclass_transform, get_type_hints

from msgspec import Struct, field

from fdvv.errors import FdvvError, InputError
from fdvv_studio.studio.studio import Studio

Tell = Callable[[Struct], None]
"""Sends a message to the page; may be called from any thread."""


# tells mypy what msgspec inherits: a message below this one is frozen too
@dataclass_transform(frozen_default=True, field_specifiers=(field,))
class Message(Struct, frozen=True, forbid_unknown_fields=True):
    """What the page and the studio send each other; a misspelt field is an error, not a default."""


M = TypeVar("M", bound=Message)


def message_of(kind: type[M], record: object, /, **others: Any) -> M:
    """Make a message of the fields that a record has by the same names, and of others."""
    alike = (name for name in kind.__struct_fields__ if name not in others and hasattr(record, name))
    return kind(**{name: getattr(record, name) for name in alike}, **others)


class Empty(Message):
    """A request that needs no fields."""


class Offer(Message):
    """Something to choose: its name for the server, and what it is."""

    name: str
    about: str = field(name="told")


class Over(Message, tag="over"):
    """Nothing is under the finger any more. reason : one line, empty if it was asked for."""

    reason: str


class Here(Message, tag="here"):
    """The page is visible."""


class Watch(Message, tag="watch"):
    """Send every change from now on."""


class Watching(Message, tag="watching"):
    """The watch is in force."""


@dataclass(frozen=True)
class Call:
    """A question that is answered once, served as ``POST /api/NAME``.

    name : part and verb, such as ``library.search``.
    ask, answer : types of the request and of what is returned: structs, or plain dataclasses for answers.
    function : runs in a worker thread. What it raises of FdvvError is one line on the page.
    """

    name: str
    ask: type[Any]
    answer: type[Any]
    function: Callable[[Studio, Any], Any]


def call(name: str) -> Callable[[Callable[[Any, Any], object]], Call]:
    """Make a call of a function; its annotations are the types of the two messages.

    Its first argument is the studio, or a service of which the studio has one instance.
    """

    def make_call(function: Callable[[Any, Any], object]) -> Call:
        (_, service), (_, ask), (_, answer) = get_type_hints(function, include_extras=True).items()
        if service is Studio:
            return Call(name, ask, answer, function)
        return Call(name, ask, answer, lambda studio, request: function(studio.part(service), request))

    return make_call


class Channel(Protocol):
    """One page's end of a channel."""

    def receive(self, ask: Any) -> None:
        """Take a message of the page; called in a worker thread, one after the other."""

    def close(self) -> None: ...


@dataclass(frozen=True)
class ChannelKind:
    """Messages that come and go as long as the page is open.

    name : of the channel.
    asks, tells : message types, tagged: what the page sends and what it gets.
    open : called when a page first sends on it.
    seated : the same for a page that is confined to a seat, by its word; None: it has no such channel.
    """

    name: str
    asks: tuple[type[Struct], ...]
    tells: tuple[type[Struct], ...]
    open: Callable[[Studio, Tell], Channel]
    seated: Callable[[Studio, Tell, str], Channel] | None = None


def error_line(error: FdvvError | OSError) -> str:
    """Return an error as one line, without paths of this machine."""
    if isinstance(error, InputError):
        return f"{error.place}: {error.reason}; {error.remedy}"
    if isinstance(error, OSError) and error.strerror:
        known = isinstance(error.filename, str | bytes)  # else a number, or nothing
        return f"{Path(os.fsdecode(error.filename)).name}: {error.strerror}" if known else error.strerror
    return str(error)


News = TypeVar("News")


class Watchers(Generic[News]):
    """Functions that are called with every piece of news, in the order in which they began to watch."""

    def __init__(self) -> None:
        self._watching: dict[Callable[[News], None], None] = {}
        self._lock = Lock()

    def watch(self, tell: Callable[[News], None]) -> None:
        with self._lock:
            self._watching[tell] = None

    def forget(self, tell: Callable[[News], None]) -> None:
        """Call it no more; unknown ones are no fault."""
        with self._lock:
            self._watching.pop(tell, None)

    def tell(self, news: News) -> None:
        """Call all, outside the lock, so that they may watch or forget."""
        with self._lock:
            watching = tuple(self._watching)
        for tell in watching:
            tell(news)


class Watched(Protocol):
    """A service whose changes pages may watch."""

    watchers: Watchers[Struct]


W = TypeVar("W", bound=Watched)


class WatchChannel(Generic[W]):
    """One page that follows the changes of a service after it sent Watch. first : makes the first message."""

    def __init__(self, service: W, tell: Tell, first: Callable[[W], Struct] | None) -> None:
        self._service, self._tell, self._first = service, tell, first

    def receive(self, _ask: Watch) -> None:
        self._service.watchers.watch(self._tell)
        self._tell(self._first(self._service) if self._first else Watching())

    def close(self) -> None:
        self._service.watchers.forget(self._tell)


def watch_channel(
    name: str, service: type[W], *changes: type[Struct], first: Callable[[W], Struct] | None = None
) -> ChannelKind:
    """Return the channel by which pages watch a service. first : makes the first message, else Watching."""
    tells: tuple[type[Struct], ...] = changes if first else (Watching, *changes)
    return ChannelKind(
        name, (Watch,), tells, lambda studio, tell: WatchChannel(studio.part(service), tell, first)
    )

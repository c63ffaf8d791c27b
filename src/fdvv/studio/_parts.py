"""Every part of the studio, loaded behind the first page so that the page does not wait for it."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from threading import Event
from typing import TypeVar

import msgspec

import fdvv.workflow
from fdvv.studio._contract import Call, ChannelKind

PARTS = ("_about", "_library", "_documents", "_editor", "_press", "_programs", "_jobs_part", "_device_part")


@dataclass(frozen=True)
class Parts:
    """All calls and channels, by name."""

    calls: dict[str, Call]
    channels: dict[str, ChannelKind]


class PartLoader:
    """Imports all parts in one thread; whoever asks waits until all are there.

    Names are unique, else this installation is wrong (ValueError, of all that waits).
    """

    def __init__(self, names: tuple[str, ...] = PARTS) -> None:
        self._names = names
        self._parts = Parts({}, {})
        self._ended = Event()
        self._fault: BaseException | None = None

    def load(self) -> None:
        """Import everything that calls may use: two threads that import at once may meet half a module."""
        try:
            modules = [importlib.import_module(f"fdvv.studio.{name}") for name in self._names]
            for name in fdvv.workflow.__all__:
                getattr(fdvv.workflow, name)
            prepare_records()
            for module in modules:
                self._take(module.CALLS, module.CHANNELS)
                getattr(module, "prepare", lambda: None)()
        except BaseException as error:
            self._fault = error
        finally:
            self._ended.set()

    def all(self) -> Parts:
        """Wait for all parts."""
        self._ended.wait()
        if self._fault:
            raise self._fault
        return self._parts

    def _take(self, calls: tuple[Call, ...], channels: tuple[ChannelKind, ...]) -> None:
        for call in calls:
            _add(self._parts.calls, call)
        for channel in channels:
            _add(self._parts.channels, channel)


N = TypeVar("N", Call, ChannelKind)


def _add(there: dict[str, N], one: N) -> None:
    if there.setdefault(one.name, one) is not one:
        raise ValueError(f"two parts of the studio offer {one.name}")


def load_parts() -> Parts:
    """Import every part, here and now."""
    loader = PartLoader()
    loader.load()
    return loader.all()


def prepare_records() -> None:
    """Let msgspec read the annotations of every record that is loaded, here in one thread.

    It does so when a kind is first decoded, and two threads that are first at once crash the process
    (msgspec 0.22.0, "Segmentation fault"); worker threads answer calls, so that would be a matter of chance.
    """
    for kind in _below(msgspec.Struct):
        # a record that is only ever written may hold what msgspec does not read
        with suppress(TypeError):
            msgspec.json.Decoder(kind)


def _below(kind: type[msgspec.Struct]) -> Iterator[type[msgspec.Struct]]:
    for sub in kind.__subclasses__():
        yield sub
        yield from _below(sub)

"""Every part of the studio, imported while the first page loads."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from itertools import groupby
from threading import Condition
from types import ModuleType
from typing import Any

import msgspec

from fdvv import extras
from fdvv_studio.studio.contract import Call, ChannelKind

PARTS = (
    "fdvv_studio.studio.api.about",
    "fdvv_studio.studio.api.library",
    "fdvv_studio.studio.api.library_buttons",
    "fdvv_studio.studio.api.documents",
    "fdvv_studio.studio.api.files",
    "fdvv_studio.studio.api.editor",
    "fdvv_studio.studio.api.press",
    "fdvv_studio.studio.api.programs",
    "fdvv_studio.studio.api.jobs",
    "fdvv_studio.studio.api.device",
)
"""Modules, in the order in which a person may want them: the first page is the library's."""


def part_modules() -> tuple[str, ...]:
    """Return the studio's own parts, then those that other packages add."""
    return (*PARTS, *(entry.value for entry in extras.installed("pages").values()))


@dataclass(frozen=True)
class Parts:
    """All calls and channels, by name."""

    calls: dict[str, Call]
    channels: dict[str, ChannelKind]


class PartLoader:
    """Imports the parts in turn; what is asked for is there as soon as its own part, or its package, is.

    Names are unique, else this installation is wrong (ValueError, of all that waits).
    """

    def __init__(self, modules: tuple[str, ...] | None = None) -> None:
        self._modules = modules
        self._parts = Parts({}, {})
        self._changed = Condition()
        self._ended = False
        self._fault: BaseException | None = None

    def load(self) -> None:
        """Import all parts, in one thread: see prepare_records."""
        prepared: set[type[msgspec.Struct]] = set()
        try:
            for _, names in groupby(part_modules() if self._modules is None else self._modules, _package):
                modules = [importlib.import_module(name) for name in names]
                prepare_records(prepared)
                for module in modules:
                    getattr(module, "prepare", lambda: None)()
                    self._take(module)
        except BaseException as error:
            self._fault = error
        finally:
            with self._changed:
                self._ended = True
                self._changed.notify_all()

    def call(self, name: str) -> Call | None:
        """Wait for a call; None if no part has it."""
        with self._changed:
            self._changed.wait_for(lambda: self._ended or name in self._parts.calls)
        return self._parts.calls.get(name) or self.all().calls.get(name)

    def all(self) -> Parts:
        with self._changed:
            self._changed.wait_for(lambda: self._ended)
        if self._fault:
            raise self._fault
        return self._parts

    def _take(self, module: ModuleType) -> None:
        """Take what a module offers: its calls and channels, by whatever name it has them."""
        with self._changed:
            for offer in vars(module).values():
                if isinstance(offer, Call | ChannelKind):
                    known: dict[str, Any] = (
                        self._parts.calls if isinstance(offer, Call) else self._parts.channels
                    )
                    if known.setdefault(offer.name, offer) is not offer:
                        raise ValueError(f"two parts of the studio offer {offer.name}")
            self._changed.notify_all()


def _package(name: str) -> str:
    """Return what is served together: an own part alone, and all of another package.

    A call of a part may import what only a later part of its package would: a study of any kind, say. Its
    records would then be prepared in two threads.
    """
    return name if name in PARTS else name.partition(".")[0]


def load_parts() -> Parts:
    loader = PartLoader()
    loader.load()
    return loader.all()


def prepare_records(prepared: set[type[msgspec.Struct]]) -> None:
    """Let msgspec read the annotations of every record that is loaded and not yet prepared, in one thread.

    It does so when a kind is first decoded, and two threads that are first at once crash the process
    (msgspec 0.22.0, "Segmentation fault"); worker threads answer calls, so that would be a matter of chance.
    """
    for kind in _below(msgspec.Struct):
        if kind not in prepared:
            prepared.add(kind)
            # a record that is only ever written may hold what msgspec does not read
            with suppress(TypeError):
                msgspec.json.Decoder(kind)


def _below(kind: type[msgspec.Struct]) -> Iterator[type[msgspec.Struct]]:
    for sub in kind.__subclasses__():
        yield sub
        yield from _below(sub)

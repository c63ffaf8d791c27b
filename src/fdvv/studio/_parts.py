"""Every part of the studio, loaded behind the first page so that the page does not wait for it."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass

import msgspec

from fdvv.studio._contract import Call, ChannelKind

PARTS = ("_about", "_device_part", "_documents", "_editor", "_jobs_part", "_library", "_press", "_programs")


@dataclass(frozen=True)
class Parts:
    """All calls and channels, by name."""

    calls: dict[str, Call]
    channels: dict[str, ChannelKind]


def load_parts() -> Parts:
    """Import every part. Names are unique, else this installation is wrong (ValueError)."""
    modules = [importlib.import_module(f"fdvv.studio.{name}") for name in PARTS]
    calls = [call for module in modules for call in module.CALLS]
    channels = [channel for module in modules for channel in module.CHANNELS]
    parts = Parts({c.name: c for c in calls}, {c.name: c for c in channels})
    if len(parts.calls) != len(calls) or len(parts.channels) != len(channels):
        raise ValueError("two parts of the studio offer the same call or channel")
    prepare_records()
    return parts


def prepare_records() -> None:
    """Let msgspec read the annotations of every record that is loaded, here in one thread.

    It does so when a kind is first decoded, and two threads that are first at once crash the process
    (msgspec 0.22.0, "Segmentation fault"); worker threads answer calls, so that would be a matter of chance.
    """
    for kind in _below(msgspec.Struct):
        with suppress(TypeError):  # a record that is only ever written may hold what msgspec does not read
            msgspec.json.Decoder(kind)


def _below(kind: type[msgspec.Struct]) -> Iterator[type[msgspec.Struct]]:
    for sub in kind.__subclasses__():
        yield sub
        yield from _below(sub)

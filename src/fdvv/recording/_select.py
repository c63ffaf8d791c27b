"""Say which of an export's markers are on the cap, and which one is the light."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fdvv.errors import ModelError
from fdvv.recording._types import Quantity, Recording, Stream, Take


def select(recording: Recording, markers: Sequence[str] = (), light: str = "") -> Recording:
    """Keep the markers of the cap, and make a marker that is seen while a light is on the light.

    markers : names of the one or two on the cap; none named keeps all.
    light : name of a marker that cameras see only while an infrared light is lit; empty if there is none. It
        becomes a LIGHT stream, 1 in frames that show it and 0 in others.

    What is left out is told in a warning. Raises ModelError for a name that no take holds.
    """
    there = list(dict.fromkeys(s.name for take in recording.takes for s in take.of(Quantity.MARKER)))
    for name in [*markers, *([light] if light else [])]:
        if name not in there:
            listed = ", ".join(repr(other) for other in there) or "none"
            raise ModelError(f"no take has a marker {name!r}; there are {listed}")
    kept = [name for name in there if name in markers] if markers else [n for n in there if n != light]
    left = [name for name in there if name not in kept and name != light]
    told = (f"markers left out: {', '.join(left)}",) if left else ()
    takes = tuple(_of_take(take, frozenset(kept), light) for take in recording.takes)
    return replace(recording, takes=takes, warnings=(*recording.warnings, *told))


def _of_take(take: Take, kept: frozenset[str], light: str) -> Take:
    streams: list[Stream] = []
    for stream in take.streams:
        if stream.quantity is not Quantity.MARKER or stream.name in kept:
            streams.append(stream)
        elif stream.name == light:
            seen = np.isfinite(stream.values).reshape(stream.t_s.size, -1).all(axis=1)
            lit_raw = np.asarray(seen, dtype=np.int8)
            lit = Stream(stream.name, Quantity.LIGHT, stream.clock, stream.t_s, lit_raw)
            streams.append(lit)
    return replace(take, streams=tuple(streams))

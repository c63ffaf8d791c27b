"""Put what several instruments recorded of the same presses into one recording."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace
from typing import Any, TypeVar

import numpy as np

from fdvv.errors import ModelError
from fdvv.recording.reading import distinct, unlike
from fdvv.recording.types import Bench, Quantity, Recording, Stream, Take

Known = TypeVar("Known")


def join(recordings: Sequence[Recording], name: str = "") -> Recording:
    """Put the streams and marks of recordings side by side, take by take; their clocks stay apart.

    Clocks that bear one name in several recordings, and streams likewise, get a number behind it. What one
    recording knows of the bench holds for all. name : of the button; that of the first if it is empty.

    Raises ModelError if there is none, if the numbers of takes differ, or if they contradict each other on
    the bench, the licence, the person, or what is simulated.
    """
    if not recordings:
        raise ModelError("there is no recording to join")
    counts = {len(recording.takes) for recording in recordings}
    if len(counts) > 1:
        raise ModelError(f"recordings of {sorted(counts)} takes cannot be joined take by take")
    renamed = _apart(recordings)
    takes = tuple(_side_by_side(same) for same in zip(*(r.takes for r in renamed), strict=True))
    return Recording(
        name or recordings[0].name,
        takes,
        _bench(recordings),
        tuple(source for recording in recordings for source in recording.sources),
        _one("licence", [r.licence for r in recordings], ""),
        _one("person", [r.person for r in recordings], ""),
        _one("simulated", [r.simulated for r in recordings], None),
        tuple(warning for recording in recordings for warning in recording.warnings),
    )


def _one(what: str, values: Sequence[Known], unknown: Known | None) -> Known:
    known = {value for value in values if value != unknown}
    if len(known) > 1:
        raise ModelError(f"the recordings differ in {what}: {sorted(map(str, known))}")
    return known.pop() if known else values[0]


def _bench(recordings: Sequence[Recording]) -> Bench:
    found = {}
    for field in fields(Bench):
        values = [getattr(recording.bench, field.name) for recording in recordings]
        found[field.name] = all(values) if field.name == "clocks_go_on" else _one(field.name, values, 0.0)
    return Bench(**found)


def _apart(recordings: Sequence[Recording]) -> list[Recording]:
    met: set[str] = set()
    found = []
    for recording in recordings:
        clocks = {stream.clock for take in recording.takes for stream in take.streams}
        clocks |= {mark.clock for take in recording.takes for mark in take.marks}
        names = {clock: distinct(clock, met) for clock in sorted(clocks)}
        found.append(replace(recording, takes=tuple(_renamed(take, names) for take in recording.takes)))
    return found


def _renamed(take: Take, names: dict[str, str]) -> Take:
    streams = tuple(replace(stream, clock=names[stream.clock]) for stream in take.streams)
    return replace(take, streams=streams, marks=tuple(replace(m, clock=names[m.clock]) for m in take.marks))


def _side_by_side(takes: Sequence[Take]) -> Take:
    """Join takes of one number; the first take's own facts hold."""

    def said(attribute: str, unknown: Any) -> Any:
        return next((v for take in takes if (v := getattr(take, attribute)) != unknown), unknown)

    return replace(
        takes[0],
        streams=unlike(stream for take in takes for stream in take.streams),
        marks=tuple(mark for take in takes for mark in take.marks),
        made=said("made", ""),
        remark=said("remark", ""),
        velocity_mm_s=said("velocity_mm_s", None),
        stage=said("stage", "unknown"),
    )


def select(recording: Recording, markers: Sequence[str] = (), light: str = "") -> Recording:
    """Keep the markers of the cap, and make a marker that is seen while a light is on the light.

    markers : names of the one or two on the cap; none named keeps all.
    light : name of a marker that cameras see only while an infrared light is lit; empty if there is none. It
        becomes a LIGHT stream, 1 in frames that show it and 0 in others.

    A warning names what is left out. Raises ModelError for a name that no take holds.
    """
    there = list(dict.fromkeys(s.name for take in recording.takes for s in take.of(Quantity.MARKER)))
    for name in [*markers, *([light] if light else [])]:
        if name not in there:
            listed = ", ".join(repr(other) for other in there) or "none"
            raise ModelError(f"no take has a marker {name!r}; there are {listed}")
    kept = [name for name in there if name in markers] if markers else [n for n in there if n != light]
    left = [name for name in there if name not in kept and name != light]
    warning = (f"markers left out: {', '.join(left)}",) if left else ()
    takes = tuple(_of_take(take, frozenset(kept), light) for take in recording.takes)
    return replace(recording, takes=takes, warnings=(*recording.warnings, *warning))


def _of_take(take: Take, kept: frozenset[str], light: str) -> Take:
    streams: list[Stream] = []
    for stream in take.streams:
        if stream.quantity is not Quantity.MARKER or stream.name in kept:
            streams.append(stream)
        elif stream.name == light:
            seen = np.isfinite(stream.values).reshape(stream.t_s.size, -1).all(axis=1)
            lit = np.asarray(seen, dtype=np.int8)
            streams.append(Stream(light, Quantity.LIGHT, stream.clock, stream.t_s, lit))
    return replace(take, streams=tuple(streams))

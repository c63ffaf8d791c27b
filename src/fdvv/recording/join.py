"""Put what several instruments recorded of the same presses into one recording."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace
from typing import Any, TypeVar

from fdvv.errors import ModelError
from fdvv.recording._reading import unlike
from fdvv.recording._types import Bench, Recording, Take

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
    """Give the one value that is known."""
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


def _clocks(recording: Recording) -> set[str]:
    streams = {stream.clock for take in recording.takes for stream in take.streams}
    return streams | {mark.clock for take in recording.takes for mark in take.marks}


def _apart(recordings: Sequence[Recording]) -> list[Recording]:
    """Name clocks so that no two recordings share one."""
    met: set[str] = set()
    found = []
    for recording in recordings:
        names = {}
        for clock in sorted(_clocks(recording)):
            new, count = clock, 1
            while new in met:
                count += 1
                new = f"{clock} {count}"
            names[clock] = new
        met |= set(names.values())
        found.append(replace(recording, takes=tuple(_renamed(take, names) for take in recording.takes)))
    return found


def _renamed(take: Take, names: dict[str, str]) -> Take:
    return replace(
        take,
        streams=tuple(replace(stream, clock=names[stream.clock]) for stream in take.streams),
        marks=tuple(replace(mark, clock=names[mark.clock]) for mark in take.marks),
    )


def _side_by_side(takes: Sequence[Take]) -> Take:
    """Join takes of one number; what the first of them says of itself holds."""

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

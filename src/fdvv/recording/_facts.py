"""What can be said of a recording without judging it: streams, clocks, rates, gaps, marks."""

from __future__ import annotations

from collections import Counter
from dataclasses import asdict
from typing import Any

import numpy as np

from fdvv.recording._types import UNITS, Recording, Stage, Stream


def facts_of(recording: Recording) -> dict[str, Any]:
    """Give name, numbers of takes, and the facts of every stream and clock."""
    stages = Counter(take.stage for take in recording.takes)
    marks = Counter(mark.name for take in recording.takes for mark in take.marks)
    made = [take.made for take in recording.takes if take.made]
    return {
        "name": recording.name,
        "simulated": recording.simulated,
        "licence": recording.licence,
        "takes": len(recording.takes),
        "stages": {str(stage): stages[stage] for stage in Stage if stages[stage]},
        "velocities_mm_s": sorted({t.velocity_mm_s for t in recording.takes if t.velocity_mm_s is not None}),
        "made": [made[0], made[-1]] if made else [],
        "bench": asdict(recording.bench),
        "sources": [asdict(source) for source in recording.sources],
        "clocks": _clocks(recording),
        "marks": dict(marks),
        "streams": [_stream(name, found) for name, found in streams_of(recording).items()],
    }


def streams_of(recording: Recording) -> dict[str, list[Stream]]:
    """Give the streams of each name, take by take."""
    found: dict[str, list[Stream]] = {}
    for take in recording.takes:
        for stream in take.streams:
            found.setdefault(stream.name, []).append(stream)
    return found


def _clocks(recording: Recording) -> dict[str, dict[str, float]]:
    ends: dict[str, list[float]] = {}
    for take in recording.takes:
        for stream in take.streams:
            ends.setdefault(stream.clock, []).extend(stream.t_s[[0, -1]].tolist() if stream.t_s.size else [])
        for mark in take.marks:
            ends.setdefault(mark.clock, []).append(float(mark.t_s))
    return {clock: {"first_s": min(t), "last_s": max(t)} for clock, t in ends.items() if t}


def _stream(name: str, found: list[Stream]) -> dict[str, Any]:
    """Give the facts of the streams of one name; gaps are samples in which nothing, or not all, was seen."""
    first = found[0]
    samples = sum(stream.t_s.size for stream in found)
    gaps = sum(int(missing(stream).sum()) for stream in found)
    steps = [np.diff(stream.t_s) for stream in found if stream.t_s.size > 1]
    joined = np.concatenate(steps) if steps else np.array([])
    return {
        "name": name,
        "quantity": str(first.quantity),
        "unit": UNITS[first.quantity],
        "clock": first.clock,
        "kind": first.raw.dtype.name,
        "axes": 1 if first.raw.ndim == 1 else first.raw.shape[1],
        "takes": len(found),
        "samples": samples,
        "rate_Hz": float(1 / np.median(joined)) if joined.size else None,
        "longest_step_s": float(joined.max()) if joined.size else None,
        "gaps_percent": 100 * gaps / samples if samples else None,
        "scale": first.scale,
        "zero": first.zero,
    }


def missing(stream: Stream) -> np.ndarray[Any, np.dtype[np.bool_]]:
    """Pick the samples of a stream in which not everything was seen."""
    if stream.raw.dtype.kind != "f":
        return np.zeros(stream.t_s.size, dtype=np.bool_)
    lost: np.ndarray[Any, np.dtype[np.bool_]] = np.isnan(stream.raw).reshape(stream.t_s.size, -1).any(axis=1)
    return lost

"""Check a recording on file: whole or not, and what it holds."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from fdvv.errors import InputError
from fdvv.eventlog import read_records
from fdvv.recording.file import CUT, KIND, LINES, REMEDY, read_file
from fdvv.recording.types import UNITS, Recording, Stage, Stream, Take


@dataclass(frozen=True)
class FileProblem:
    place: str
    reason: str
    remedy: str

    def __str__(self) -> str:
        return f"{self.place}: {self.reason}; {self.remedy}"


@dataclass(frozen=True)
class FileCheck:
    """What a file is, and whether it is whole.

    Attributes
    ----------
    kind : what it holds, with its article.
    facts : by name, plain values; the unit is the last part of a name.
    problems : what is wrong, the worst first.
    notes : what the file says of itself, as repairs that a reader made.
    usable : it can be read.
    """

    path: Path
    kind: str
    facts: Mapping[str, Any] = field(default_factory=dict)
    problems: tuple[FileProblem, ...] = ()
    notes: tuple[str, ...] = ()
    usable: bool = True

    @property
    def status(self) -> int:
        """Return 0 for a whole file, 1 for one with problems, 2 for an unusable one."""
        return 2 if not self.usable else int(bool(self.problems))

    def to_dict(self) -> dict[str, Any]:
        verdict = ("whole", "readable with problems", "unusable")[self.status]
        return {
            "file": str(self.path),
            "kind": self.kind,
            "verdict": verdict,
            "facts": dict(self.facts),
            "problems": [vars(problem) for problem in self.problems],
            "notes": list(self.notes),
        }


class CheckedJournal(NamedTuple):
    """A kind of journal (fdvv.eventlog) that another package writes and checks.

    Attributes
    ----------
    first : keys of its first record. kind : what it holds, with its article.
    check : called with path and kind; may raise what stands in a file as InputError.
    """

    first: tuple[str, ...]
    kind: str
    check: Callable[[Path, str], FileCheck]


def unusable(path: Path, kind: str, error: InputError) -> FileCheck:
    place = error.place if Path(error.source) == path else f"{error.source}, {error.place}"
    return FileCheck(path, kind, problems=(FileProblem(place, error.reason, error.remedy),), usable=False)


def facts_of(recording: Recording) -> dict[str, Any]:
    """Return name, numbers of takes, and the facts of every stream and clock."""
    stages = Counter(take.stage for take in recording.takes)
    marks = Counter(mark.name for take in recording.takes for mark in take.marks)
    made = [take.made for take in recording.takes if take.made]
    streams: dict[str, list[Stream]] = {}
    for stream in (stream for take in recording.takes for stream in take.streams):
        streams.setdefault(stream.name, []).append(stream)
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
        "streams": [_stream(name, found) for name, found in streams.items()],
    }


def _clocks(recording: Recording) -> dict[str, dict[str, float]]:
    ends: dict[str, list[float]] = {}
    for take in recording.takes:
        for stream in take.streams:
            ends.setdefault(stream.clock, []).extend(stream.t_s[[0, -1]].tolist() if stream.t_s.size else [])
        for mark in take.marks:
            ends.setdefault(mark.clock, []).append(float(mark.t_s))
    return {clock: {"first_s": min(t), "last_s": max(t)} for clock, t in ends.items() if t}


def _stream(name: str, found: list[Stream]) -> dict[str, Any]:
    """Return the facts of the streams of one name; gaps are samples that lack a value."""
    first = found[0]
    samples = sum(stream.t_s.size for stream in found)
    gaps = sum(int(missing(stream).sum()) for stream in found)
    joined = np.concatenate([np.diff(stream.t_s) for stream in found])
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
    if stream.raw.dtype.kind != "f":
        return np.zeros(stream.t_s.size, dtype=np.bool_)
    return np.asarray(np.isnan(stream.raw).reshape(stream.t_s.size, -1).any(axis=1))


A_RECORDING = "a recording"


def check_recording(path: Path | str) -> FileCheck:
    """Read a recording with every sample of it, and return its facts and problems."""
    path = Path(path)
    try:
        recording, end, size = read_file(path)
    except InputError as error:
        return unusable(path, A_RECORDING, error)
    if recording is None:
        return unusable(path, A_RECORDING, InputError(path, "whole file", "holds no whole record", REMEDY))
    remedy = f"go on with it, which cuts the rest off; takes kept: {len(recording.takes)}"
    problems = [FileProblem("end of file", CUT, remedy)] if end < size else []
    problems += _problems(recording)
    corrections = sum("mend" in record for record, _ in read_records(path, LINES))
    facts = {"version": KIND.version, "size_bytes": size, **facts_of(recording), "corrections": corrections}
    return FileCheck(path, A_RECORDING, facts, tuple(problems), recording.warnings)


def _problems(recording: Recording) -> Iterator[FileProblem]:
    if not recording.takes:
        yield FileProblem("whole file", "holds no take", "go on with the capture")
    usual: dict[Stage, dict[str, None]] = {}
    for take in recording.takes:
        usual.setdefault(take.stage, {}).update(dict.fromkeys(stream.name for stream in take.streams))
    for take in recording.takes:
        there = {stream.name for stream in take.streams}
        lost = [name for name in usual[take.stage] if name not in there]
        if lost:
            problem = f"lacks {', '.join(lost)}, which other takes of its stage hold"
            yield FileProblem(f"take {take.number}", problem, "leave the take out, or say why in a remark")
        yield from _blind(take)
    if recording.bench.clocks_go_on:
        yield from _backwards(recording)


def _blind(take: Take) -> Iterator[FileProblem]:
    for stream in take.streams:
        place = f"take {take.number}, {stream.name}"
        if not stream.t_s.size:
            yield FileProblem(place, "holds no sample", "leave the take out")
        elif missing(stream).all():
            yield FileProblem(place, "nothing was seen in any sample", "leave the take out")


def _backwards(recording: Recording) -> Iterator[FileProblem]:
    ends: dict[str, tuple[float, int]] = {}
    for take in recording.takes:
        streams = [stream for stream in take.streams if stream.t_s.size]
        for stream in streams:
            end_s, before = ends.get(stream.clock, (-float("inf"), take.number))
            if before != take.number and stream.t_s[0] <= end_s:
                place = f"take {take.number}, {stream.name}"
                reason = f"begins before take {before} ended, though its clock goes on through all takes"
                yield FileProblem(place, reason, "correct clocks_go_on of the bench if the clocks begin anew")
                return
        for stream in streams:
            last_s = max(ends.get(stream.clock, (-float("inf"), 0))[0], float(stream.t_s[-1]))
            ends[stream.clock] = (last_s, take.number)

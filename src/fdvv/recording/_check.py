"""Check a recording on file: whole or not, and what it holds."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from fdvv.errors import InputError
from fdvv.journal import read_records
from fdvv.recording._facts import facts_of, missing
from fdvv.recording._file import CUT, KIND, REMEDY, read_file
from fdvv.recording._file_check import FileCheck, Problem, unusable
from fdvv.recording._records import VERSION
from fdvv.recording._types import Recording, Stage, Take

A_RECORDING = "a recording"


def check_recording(path: Path | str) -> FileCheck:
    """Read a recording with every sample of it, and tell what is there and what is wrong."""
    path = Path(path)
    try:
        recording, end, size = read_file(path)
    except InputError as error:
        return unusable(path, A_RECORDING, error)
    if recording is None:
        return unusable(path, A_RECORDING, InputError(path, "whole file", "holds no whole record", REMEDY))
    problems = [_cut(len(recording.takes))] if end < size else []
    problems += _problems(recording)
    corrections = sum("mend" in record for record, _ in read_records(path, KIND))
    facts = {"version": VERSION, "size_bytes": size, **facts_of(recording), "corrections": corrections}
    return FileCheck(path, A_RECORDING, facts, tuple(problems), recording.warnings)


def _cut(takes: int) -> Problem:
    remedy = f"go on with it, which cuts the rest off; takes kept: {takes}"
    return Problem("end of file", CUT, remedy)


def _usual(recording: Recording, stage: Stage) -> list[str]:
    """Name the streams that takes of one stage hold; a probe has other instruments than a press."""
    takes = [take for take in recording.takes if take.stage is stage]
    return list(dict.fromkeys(stream.name for take in takes for stream in take.streams))


def _problems(recording: Recording) -> Iterator[Problem]:
    if not recording.takes:
        yield Problem("whole file", "holds no take", "go on with the capture")
    usual = {take.stage: _usual(recording, take.stage) for take in recording.takes}
    for take in recording.takes:
        there = {stream.name for stream in take.streams}
        lost = [name for name in usual[take.stage] if name not in there]
        if lost:
            told = f"lacks {', '.join(lost)}, which other takes of its stage hold"
            yield Problem(f"take {take.number}", told, "leave the take out, or say why in a remark")
        yield from _blind(take)
    if recording.bench.clocks_go_on:
        yield from _backwards(recording)


def _blind(take: Take) -> Iterator[Problem]:
    """Find streams in which nothing was seen."""
    for stream in take.streams:
        place = f"take {take.number}, {stream.name}"
        if not stream.t_s.size:
            yield Problem(place, "holds no sample", "leave the take out")
        elif missing(stream).all():
            yield Problem(place, "nothing was seen in any sample", "leave the take out")


def _backwards(recording: Recording) -> Iterator[Problem]:
    """Find takes that begin before the one before them ended, on a clock that goes on through all takes."""
    ends: dict[str, tuple[float, int]] = {}
    for take in recording.takes:
        for stream in (stream for stream in take.streams if stream.t_s.size):
            end_s, before = ends.get(stream.clock, (-float("inf"), take.number))
            if before != take.number and stream.t_s[0] <= end_s:
                place = f"take {take.number}, {stream.name}"
                reason = f"begins before take {before} ended, though its clock goes on through all takes"
                yield Problem(place, reason, "correct clocks_go_on of the bench if the clocks begin anew")
                return
        for stream in (stream for stream in take.streams if stream.t_s.size):
            last_s = max(ends.get(stream.clock, (-float("inf"), 0))[0], float(stream.t_s[-1]))
            ends[stream.clock] = (last_s, take.number)

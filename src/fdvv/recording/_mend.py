"""What may be corrected in a recording afterwards: calibration and what was said, never a sample."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

from fdvv.errors import ModelError
from fdvv.recording._types import Bench, Recording, Take

STREAM = ("scale", "zero")
TAKE = ("stage", "velocity_mm_s", "remark")
RECORDING = ("licence", "person")
TEXTS = (*RECORDING, "stage", "remark")
BENCH = tuple(f.name for f in fields(Bench))


@dataclass(frozen=True)
class Mend:
    """A correction.

    Attributes
    ----------
    values : what holds from now on. Of a stream: scale, zero; of a take: stage, velocity_mm_s, remark; of the
        recording: licence, person and every field of Bench.
    take : number of the take that it is for; None for all that were made before it.
    stream : name of the stream that it is for; None corrects the take, or without a take the recording.
    why : what was found out, for whoever reads the file.
    """

    values: Mapping[str, Any]
    take: int | None = None
    stream: str | None = None
    why: str = ""

    def __post_init__(self) -> None:
        whole = self.take is None and self.stream is None
        may = STREAM if self.stream is not None else (*RECORDING, *BENCH) if whole else TAKE
        wrong = sorted(set(self.values) - set(may))
        if wrong or not self.values:
            raise ModelError(f"a correction may set {', '.join(may)} here, got {wrong or 'nothing'}")
        for key, value in self.values.items():
            if not _fits(key, value):
                raise ModelError(f"a correction cannot set {key} to {value!r:.40}")


def _fits(key: str, value: object) -> bool:
    """Tell whether a value is of the kind that the field holds; its range is checked where it goes."""
    if key in TEXTS:
        return isinstance(value, str)
    if key == "clocks_go_on":
        return isinstance(value, bool)
    if value is None:
        return key == "velocity_mm_s"
    return isinstance(value, int | float) and not isinstance(value, bool)


def mended(recording: Recording, mend: Mend) -> Recording:
    """Give a recording as it is after a correction. ModelError if it names what is not there."""
    if mend.take is not None and not 1 <= mend.take <= len(recording.takes):
        raise ModelError(f"there is no take {mend.take} to correct, only {len(recording.takes)}")
    if mend.take is None and mend.stream is None:
        bench = replace(recording.bench, **{k: v for k, v in mend.values.items() if k in BENCH})
        return replace(recording, bench=bench, **{k: v for k, v in mend.values.items() if k in RECORDING})
    takes = tuple(_take(take, mend) if mend.take in (None, take.number) else take for take in recording.takes)
    if mend.stream is not None and all(new is old for new, old in zip(takes, recording.takes, strict=True)):
        raise ModelError(f"there is no stream {mend.stream!r} to correct")
    return replace(recording, takes=takes)


def _take(take: Take, mend: Mend) -> Take:
    if mend.stream is None:
        return replace(take, **mend.values)
    streams = [replace(s, **mend.values) if s.name == mend.stream else s for s in take.streams]
    changed = any(new is not old for new, old in zip(streams, take.streams, strict=True))
    return replace(take, streams=tuple(streams)) if changed else take

"""Recordings as the lines of their file hold them, strictly typed, and back."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta

from fdvv.errors import ModelError
from fdvv.io.columns import pack_column, unpack_column
from fdvv.io.documents import tidy_schema
from fdvv.recording.types import Bench, Mark, Quantity, Recording, Source, Stage, Stream, Take

FORMAT, VERSION = "fdvv-recording", 1
COLUMN = r"^(\?|\|[iu]1|<[iu][248]|<f[48])(\[\d+(,\d+)+\])?:"
Column = Annotated[str, Meta(pattern=COLUMN, description="kind, shape, base64 of zlib of the numbers")]


class BenchRecord(msgspec.Struct, forbid_unknown_fields=True):
    """What is known of the instruments; the names are those of Bench."""

    force_filter_ms: float
    sound_filter_ms: float
    force_play_cN: float
    tip_mass_g: float
    sound_V_s_m: float
    exposure_ms: float
    clocks_go_on: bool


class SourceRecord(msgspec.Struct, forbid_unknown_fields=True):
    """A file that the recording was read from."""

    name: str
    sha256: str
    format: str


class HeadRecord(msgspec.Struct, forbid_unknown_fields=True):
    """The first line: what the recording is of."""

    format: Literal["fdvv-recording"]
    version: Literal[1]
    name: str
    bench: BenchRecord
    licence: str
    person: str
    simulated: bool
    sources: list[SourceRecord]
    warnings: list[str]


class StreamRecord(msgspec.Struct, forbid_unknown_fields=True):
    """A stream; t_s and raw are columns."""

    name: str
    quantity: Quantity
    clock: str
    scale: float
    zero: float
    t_s: Column
    raw: Column


class MarkRecord(msgspec.Struct, forbid_unknown_fields=True):
    """A mark."""

    name: str
    clock: str
    t_s: float


class TakeRecord(msgspec.Struct, forbid_unknown_fields=True):
    """A take with all its samples."""

    number: int
    stage: Stage
    velocity_mm_s: float | None
    made: str
    remark: str
    marks: list[MarkRecord]
    streams: list[StreamRecord]


class MendRecord(msgspec.Struct, forbid_unknown_fields=True):
    """A correction; the names are those of Correction."""

    values: dict[str, Any]
    take: int | None
    stream: str | None
    why: str
    made: str


def schema() -> dict[str, Any]:
    """Return the JSON schema of one line, as published in docs/reference/fdvv-recording.schema.json."""
    kinds = {"head": HeadRecord, "take": TakeRecord, "mend": MendRecord}
    found, parts = msgspec.json.schema_components(kinds.values(), ref_template="#/$defs/{name}")
    records = [
        {"type": "object", "properties": {key: ref}, "required": [key], "additionalProperties": False}
        for key, ref in zip(kinds, found, strict=True)
    ]
    checksum = {"type": "integer", "minimum": 0, "maximum": 2**32 - 1}
    line = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "A line of a recording",
        "type": "object",
        "properties": {"crc32": checksum, "record": {"oneOf": records}},
        "required": ["crc32", "record"],
        "additionalProperties": False,
        "$defs": parts,
    }
    return dict(tidy_schema(line))


def pack_head(recording: Recording) -> dict[str, Any]:
    return {
        "format": FORMAT,
        "version": VERSION,
        "name": recording.name,
        "bench": asdict(recording.bench),
        "licence": recording.licence,
        "person": recording.person,
        "simulated": recording.simulated,
        "sources": [asdict(source) for source in recording.sources],
        "warnings": list(recording.warnings),
    }


def pack_take(take: Take) -> dict[str, Any]:
    """Encode a take. ModelError for a kind of number that no file holds."""
    try:
        streams = [_pack_stream(stream) for stream in take.streams]
    except ValueError as error:
        raise ModelError(f"take {take.number}: {error}") from error
    return {
        "number": take.number,
        "stage": str(take.stage),
        "velocity_mm_s": None if take.velocity_mm_s is None else float(take.velocity_mm_s),
        "made": take.made,
        "remark": take.remark,
        "marks": [{**vars(mark), "t_s": float(mark.t_s)} for mark in take.marks],
        "streams": streams,
    }


def _pack_stream(stream: Stream) -> dict[str, Any]:
    return {
        "name": stream.name,
        "quantity": str(stream.quantity),
        "clock": stream.clock,
        "scale": float(stream.scale),
        "zero": float(stream.zero),
        "t_s": pack_column(stream.t_s),
        "raw": pack_column(stream.raw),
    }


def unpack_head(found: object) -> Recording:
    """Decode a recording without takes. Raises ValueError."""
    head = msgspec.convert(found, HeadRecord)
    sources = tuple(Source(**msgspec.to_builtins(source)) for source in head.sources)
    bench = Bench(**msgspec.to_builtins(head.bench))
    facts = (head.licence, head.person, head.simulated, tuple(head.warnings))
    return Recording(head.name, (), bench, sources, *facts)


def unpack_take(found: object) -> Take:
    """Decode a take. Raises ValueError."""
    take = msgspec.convert(found, TakeRecord)
    streams = tuple(_unpack_stream(stream) for stream in take.streams)
    marks = tuple(Mark(mark.name, mark.clock, mark.t_s) for mark in take.marks)
    return Take(take.number, streams, marks, take.stage, take.velocity_mm_s, take.made, take.remark)


def _unpack_stream(found: StreamRecord) -> Stream:
    t_s, raw = unpack_column(found.t_s), unpack_column(found.raw)
    return Stream(found.name, found.quantity, found.clock, t_s, raw, found.scale, found.zero)

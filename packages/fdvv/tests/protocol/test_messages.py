"""Golden bytes: one example of every message, made once; Python and C must agree with them for ever."""

from __future__ import annotations

import ctypes
import json
from pathlib import Path
from typing import Any

import pytest

from fdvv._native import library
from fdvv.errors import ModelError
from fdvv.protocol.frame import Frame, decode, encode
from fdvv.protocol.messages import REPLIES, REPLY, REQUESTS, read_notice, read_reply, request_frame
from fdvv.protocol.record import Record
from fdvv.protocol.tables import DataRequest, Message, PingRequest, TickRecord

GOLDEN = json.loads((Path(__file__).parents[4] / "protocol" / "golden.json").read_text())
NAMES = [f"{example['message']} {example['part']}" for example in GOLDEN]


def body_of(kind: type[Record] | None, fields: dict[str, Any] | None) -> Record | None:
    if kind is None:
        assert fields is None
        return None
    assert fields is not None
    return kind(**{k: value_of(v) for k, v in fields.items()})


def value_of(value: Any) -> Any:
    """Turn hexadecimal digits into bytes and a list into the tuple that a record has."""
    if isinstance(value, str):
        return bytes.fromhex(value)
    return tuple(value) if isinstance(value, list) else value


def frame_of(example: dict[str, Any]) -> Frame:
    """Make the frame from the fields that the example names."""
    message, sequence = Message[example["message"].upper()], example["sequence"]
    if example["part"] == "reply":
        body = body_of(REPLIES.get(message), example["fields"])
        return Frame(message + REPLY, sequence, body.pack() if body else b"")
    frame = request_frame(message, sequence, body_of(REQUESTS.get(message), example["fields"]))
    records = (body_of(TickRecord, fields) for fields in example.get("records", []))
    return Frame(message, sequence, frame.payload + b"".join(r.pack() for r in records if r))


@pytest.mark.parametrize("example", GOLDEN, ids=NAMES)
def test_the_fields_of_an_example_make_its_bytes(example: dict[str, Any]) -> None:
    assert encode(frame_of(example)).hex() == example["frame"]


@pytest.mark.parametrize("example", GOLDEN, ids=NAMES)
def test_the_bytes_of_an_example_give_its_fields(example: dict[str, Any]) -> None:
    frame = decode(bytes.fromhex(example["frame"])[:-1])
    if example["part"] == "reply":
        message, body = read_reply(frame)
        assert message.name.lower() == example["message"]
    elif example["part"] == "notice":
        body, records = read_notice(frame)
        assert records == frame.payload[body.length_bytes() :]
    else:
        assert frame.message == Message[example["message"].upper()]
        return
    expected = body_of(type(body), example["fields"]) if body else None
    assert (body.pack() if body else None) == (expected.pack() if expected else None)


class Reader(ctypes.Structure):
    """fdvv_frame_reader of firmware/core/frame.h."""

    _fields_ = (
        ("words", ctypes.c_uint32 * 59),
        ("length", ctypes.c_uint16),
        ("left", ctypes.c_uint8),
        ("begun", ctypes.c_uint8),
        ("broken", ctypes.c_uint8),
        ("ended", ctypes.c_uint8),
    )


class Ring(ctypes.Structure):
    """fdvv_ring of firmware/core/frame.h."""

    _fields_ = (("bytes", ctypes.c_uint8 * 512), ("head", ctypes.c_uint16), ("tail", ctypes.c_uint16))


def taken(reader: Reader, data: bytes | bytearray) -> list[int]:
    take, found, results = library().fdvv_frame_take, ctypes.c_uint8(), []
    while data:
        count = take(ctypes.byref(reader), bytes(data), min(len(data), 7), ctypes.byref(found)) & 0xFFFF
        results.append(found.value)
        data = data[count:]
    return results


@pytest.mark.parametrize("example", GOLDEN, ids=NAMES)
def test_the_firmware_reads_and_writes_the_same_bytes(example: dict[str, Any]) -> None:
    c, reader, ring = library(), Reader(), Ring()
    c.fdvv_frame_reader_reset(ctypes.byref(reader))
    data = bytes.fromhex(example["frame"])
    frame = decode(data[:-1])
    assert taken(reader, data)[-1] == 1
    inside = bytes(reader.words)[2 : 2 + reader.length]
    assert inside == bytes([frame.message, frame.sequence]) + frame.payload + inside[-2:]
    ring.head = ring.tail = 65500  # so that the free-running counters wrap
    c.fdvv_frame_put(ctypes.byref(ring), frame.message, frame.sequence, frame.payload, len(frame.payload))
    room = ctypes.create_string_buffer(600)
    count = c.fdvv_ring_take(ctypes.byref(ring), room, 600) & 0xFFFF
    assert room.raw[:count] == data


def test_the_firmware_calls_a_frame_bad_exactly_where_python_does() -> None:
    import random

    rng = random.Random(5)
    c, reader = library(), Reader()
    c.fdvv_frame_reader_reset(ctypes.byref(reader))
    bad = 0
    for _ in range(3000):
        data = bytearray(
            encode(Frame(rng.randrange(256), rng.randrange(256), rng.randbytes(rng.randrange(20))))
        )
        for _ in range(rng.randrange(3)):
            data[rng.randrange(len(data) - 1)] = rng.randrange(1, 256)
        try:
            decode(bytes(data[:-1]))
            expected = 1
        except ModelError:
            expected = 2
        assert taken(reader, data)[-1] == expected
        bad += expected == 2
    assert bad > 1000


def test_a_request_with_another_structure_is_refused() -> None:
    with pytest.raises(ModelError, match="hello takes HelloRequest, got PingRequest"):
        request_frame(Message.HELLO, 1, PingRequest(host_us=1))
    with pytest.raises(ModelError, match="arm takes no body"):
        request_frame(Message.ARM, 1, PingRequest(host_us=1))


def test_only_the_bytes_that_are_there_are_sent() -> None:
    body = DataRequest(offset=0, count=4, bytes=bytes(192))
    assert len(request_frame(Message.DATA, 1, body).payload) == 8

"""The LED strip's board reads and writes the same frames as the host: its C beside the readable Python."""

from __future__ import annotations

import ctypes
import dataclasses
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv._native import library
from fdvv.errors import ModelError
from fdvv.protocol.frame import Frame, FrameDecoder, decode, encode
from fdvv.protocol.messages import REPLY
from fdvv_strip.tables import (
    STRIP_HASH,
    STRIP_REPLY_BYTES,
    STRIP_REQUEST_BYTES,
    StripBeginRequest,
    StripHelloRequest,
    StripMessage,
    StripMode,
    StripReadRoundReply,
    StripRefusal,
    StripRefusedReply,
)

LARGEST_BYTES = 60
NOTHING, WHOLE, BAD = range(3)
HELLO = Frame(StripMessage.HELLO, 1, StripHelloRequest(version=1, hash=STRIP_HASH).pack())
READ = Frame(StripMessage.READ_ROUND, 9)
PAYLOADS = st.binary(max_size=LARGEST_BYTES)


def put(frame: Frame) -> bytes:
    """Have the board's C stuff a frame."""
    plain = bytes([frame.message, frame.sequence]) + frame.payload
    room = ctypes.create_string_buffer(80)
    count = library().fdvv_small_put(plain, ctypes.c_uint8(len(plain)), room)
    return room.raw[: count & 0xFF]


class Reader:
    """The board's C, taking bytes in."""

    def __init__(self) -> None:
        self._memory = ctypes.create_string_buffer(128)
        self._take = library().fdvv_small_take
        self._take.restype = ctypes.c_uint8
        library().fdvv_small_reader_reset(self._memory)

    def feed(self, data: bytes) -> list[tuple[int, bytes]]:
        """Return what each byte completed, and the bytes of what was whole."""
        found = [(self._take(self._memory, ctypes.c_uint8(byte)), self._memory.raw) for byte in data]
        return [(kind, memory[: memory[64]]) for kind, memory in found if kind != NOTHING]


class Board:
    """The strip's board, asked frame by frame; its clock stands still."""

    def __init__(self) -> None:
        library().fdvv_strip_bridge_new.restype = ctypes.c_void_p
        self._handle = ctypes.c_void_p(library().fdvv_strip_bridge_new())

    def ask(self, data: bytes) -> bytes:
        room = ctypes.create_string_buffer(70 * len(data) + 70)
        now, key = ctypes.c_uint32(5), ctypes.c_uint8(0)
        count = library().fdvv_strip_bridge_receive(self._handle, data, len(data), now, key, room)
        return room.raw[:count]

    def close(self) -> None:
        library().fdvv_strip_bridge_free(self._handle)


@given(st.builds(Frame, st.integers(0, 255), st.integers(0, 255), PAYLOADS))
def test_the_boards_frames_are_the_hosts_byte_by_byte(frame: Frame) -> None:
    assert put(frame) == encode(frame)
    assert decode(put(frame)[:-1]) == frame


@given(st.builds(Frame, st.integers(0, 255), st.integers(0, 255), PAYLOADS))
def test_the_board_reads_what_the_host_writes(frame: Frame) -> None:
    found = Reader().feed(encode(frame))
    assert [kind for kind, _ in found] == [WHOLE]
    assert found[0][1][:-2] == bytes([frame.message, frame.sequence]) + frame.payload


@given(st.binary(max_size=300), PAYLOADS)
def test_whatever_comes_before_the_next_frame_is_read(noise: bytes, payload: bytes) -> None:
    frame = Frame(7, 8, payload)
    found = Reader().feed(noise + b"\0" + encode(frame))
    assert found[-1][0] == WHOLE
    assert found[-1][1][:-2] == bytes([7, 8]) + payload


@given(st.lists(st.binary(min_size=1, max_size=40), max_size=6))
def test_board_and_host_agree_on_what_is_a_frame(pieces: list[bytes]) -> None:
    data, host = b"\0".join(pieces) + b"\0", FrameDecoder()
    whole = host.feed(data)
    found = Reader().feed(data)
    assert [kind for kind, _ in found].count(WHOLE) == len(whole)
    assert [kind for kind, _ in found].count(BAD) == host.bad


@given(PAYLOADS, st.integers(0, 8 * 64))
def test_a_flipped_bit_is_never_read_as_a_frame(payload: bytes, place: int) -> None:
    data = bytearray(encode(Frame(3, 4, payload)))
    data[place // 8 % (len(data) - 1)] ^= 1 << place % 8
    assert all(kind == BAD for kind, _ in Reader().feed(bytes(data)))


@given(st.lists(st.binary(max_size=60), max_size=4))
def test_nothing_that_is_sent_makes_the_board_answer_wrongly_or_fall_silent(pieces: list[bytes]) -> None:
    board = Board()
    for piece in pieces:
        for frame in FrameDecoder().feed(board.ask(piece + b"\0")):
            assert frame.message >= REPLY
    replies = FrameDecoder().feed(board.ask(b"\0" + encode(HELLO) + encode(READ)))
    board.close()
    assert [frame.message for frame in replies] == [
        StripMessage.HELLO + REPLY,
        StripMessage.READ_ROUND + REPLY,
    ]


@given(st.integers(0, 127), PAYLOADS)
def test_every_request_is_answered_or_refused_with_its_number(message: int, payload: bytes) -> None:
    board = Board()
    board.ask(encode(HELLO))
    (frame,) = FrameDecoder().feed(board.ask(encode(Frame(message, 77, payload))))
    board.close()
    assert frame.sequence == 77
    known = message in set(StripMessage) - {StripMessage.REFUSED}
    fits = known and len(payload) == STRIP_REQUEST_BYTES[StripMessage(message)]
    if frame.message == StripMessage.REFUSED + REPLY:
        refused = StripRefusedReply.unpack(frame.payload)
        assert refused.request == message
        assert (refused.refusal == StripRefusal.UNKNOWN_MESSAGE) == (not known)
        assert (refused.refusal == StripRefusal.BAD_LENGTH) == (known and not fits)
    else:
        assert fits
        assert frame.message == message + REPLY
        assert len(frame.payload) == STRIP_REPLY_BYTES[StripMessage(message)]


FIELDS = st.fixed_dictionaries(
    {
        "round": st.integers(0, 65535),
        "speed_px_s": st.integers(0, 65535),
        "delay_ms": st.integers(0, 65535),
        "after_ms": st.integers(0, 65535),
        "pixels": st.integers(0, 255),
        "zone_px": st.integers(0, 255),
        "zone_half_px": st.integers(0, 255),
        "brightness": st.integers(0, 255),
        "led": st.integers(0, 3),
        "spare": st.integers(0, 1),
    }
)
RIGHT = {"round": 3, "speed_px_s": 100, "delay_ms": 900, "after_ms": 500, "pixels": 144}
RIGHT |= {"zone_px": 100, "zone_half_px": 5, "brightness": 8, "led": 0, "spare": 0}


@given(FIELDS, st.sets(st.sampled_from(list(RIGHT))))
def test_a_round_is_taken_exactly_if_every_number_is_in_range_and_the_zone_on_the_strip(
    drawn: dict[str, int], wild: set[str]
) -> None:
    fields = RIGHT | {name: drawn[name] for name in wild}
    try:
        StripBeginRequest(**fields)
        in_range = True
    except ModelError:
        in_range = False
    zone, half = fields["zone_px"], fields["zone_half_px"]
    on_strip = zone > half and zone + half < fields["pixels"]
    names = [field.name for field in dataclasses.fields(StripBeginRequest)]
    payload = struct.pack(StripBeginRequest.FORMAT, *(fields[name] for name in names))
    board = Board()
    board.ask(encode(HELLO))
    (frame,) = FrameDecoder().feed(board.ask(encode(Frame(StripMessage.BEGIN, 2, payload))))
    (reply,) = FrameDecoder().feed(board.ask(encode(READ)))
    board.close()
    assert (frame.message == StripMessage.BEGIN + REPLY) == (in_range and on_strip)
    mode = StripReadRoundReply.unpack(reply.payload).mode
    assert mode == (StripMode.WAITING if in_range and on_strip else StripMode.IDLE)


def test_who_has_not_said_hello_in_this_version_is_refused() -> None:
    board = Board()
    other = StripHelloRequest(version=1, hash=STRIP_HASH ^ 1).pack()
    for hello in (b"", encode(Frame(StripMessage.HELLO, 0, other))):
        replies = FrameDecoder().feed(board.ask(hello + encode(Frame(StripMessage.STOP, 1))))
        assert StripRefusedReply.unpack(replies[-1].payload).refusal == StripRefusal.HASH_MISMATCH
    board.close()


def test_a_round_that_is_asked_for_twice_is_begun_once() -> None:
    board = Board()
    asked = encode(Frame(StripMessage.BEGIN, 5, StripBeginRequest(**RIGHT).pack()))
    first, again = (FrameDecoder().feed(board.ask(encode(HELLO) + asked))[-1] for _ in range(2))
    board.close()
    assert first == again


@pytest.mark.parametrize("message", list(StripMessage))
def test_every_message_fits_a_frame(message: StripMessage) -> None:
    assert STRIP_REQUEST_BYTES[message] <= LARGEST_BYTES
    assert STRIP_REPLY_BYTES[message] <= LARGEST_BYTES

"""Frames: stuffing, checksum, and streams that were damaged."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.protocol.frame import Frame, FrameDecoder, crc16, decode, encode, stuff, unstuff
from fdvv.protocol.tables import FRAME_BYTES

PAYLOADS = st.binary(max_size=FRAME_BYTES - 4)
FRAMES = st.builds(Frame, st.integers(0, 255), st.integers(0, 255), PAYLOADS)


def slow_crc16(data: bytes) -> int:
    """Divide bit by bit, as the definition says."""
    crc = 0xFFFF
    for byte in data:
        crc ^= byte << 8
        for _ in range(8):
            crc = (crc << 1) ^ (0x1021 if crc & 0x8000 else 0)
            crc &= 0xFFFF
    return crc


def slow_stuff(data: bytes) -> bytes:
    """Replace every zero by the distance to the next one, byte by byte."""
    padded = bytearray(b"\0" + data)
    ends = [i for i, byte in enumerate(padded) if byte == 0] + [len(padded)]
    for here, following in pairwise(ends):
        padded[here] = following - here
    return bytes(padded)


def test_the_checksum_of_123456789_is_the_published_one() -> None:
    assert crc16(b"123456789") == 0x29B1


@given(st.binary(max_size=300))
def test_the_checksum_is_the_definition_bit_by_bit(data: bytes) -> None:
    assert crc16(data) == slow_crc16(data)


@given(st.binary(max_size=232))
def test_stuffing_is_the_definition_and_leaves_no_zero(data: bytes) -> None:
    assert stuff(data) == slow_stuff(data)
    assert 0 not in stuff(data)
    assert unstuff(stuff(data)) == data


@given(FRAMES)
def test_a_frame_comes_back_from_its_bytes(frame: Frame) -> None:
    data = encode(frame)
    assert data.index(0) == len(data) - 1
    assert decode(data[:-1]) == frame


@given(st.lists(FRAMES, max_size=5), st.integers(1, 40))
def test_a_stream_is_cut_into_its_frames_however_it_is_chopped(frames: list[Frame], step: int) -> None:
    data = b"".join(map(encode, frames))
    decoder = FrameDecoder()
    found = [f for i in range(0, len(data), step) for f in decoder.feed(data[i : i + step])]
    assert found == frames
    assert (decoder.whole, decoder.bad) == (len(frames), 0)


@given(FRAMES, st.data())
def test_one_damaged_byte_is_noticed_and_the_next_frame_is_whole(frame: Frame, data: st.DataObject) -> None:
    good = bytearray(encode(frame))
    place = data.draw(st.integers(0, len(good) - 2))
    good[place] ^= data.draw(st.integers(1, 255))
    decoder = FrameDecoder()
    following = Frame(2, 7, b"after")
    assert decoder.feed(bytes(good) + encode(following))[-1:] == [following]
    assert decoder.whole == 1
    assert decoder.bad >= 1


def test_a_stream_without_end_takes_no_more_memory_than_a_frame() -> None:
    decoder = FrameDecoder()
    for _ in range(100):
        assert decoder.feed(b"\x07" * 1000) == []
    assert len(decoder._open) <= FRAME_BYTES + 2
    assert decoder.feed(b"\0" + encode(Frame(1, 2))) == [Frame(1, 2)]
    assert decoder.bad == 1


def test_a_payload_too_long_for_a_frame_is_refused() -> None:
    with pytest.raises(ModelError, match="at most 228 bytes, got 229"):
        Frame(1, 2, bytes(229))

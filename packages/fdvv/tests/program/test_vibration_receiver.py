"""The vibration board's receiver, byte by byte, and its messages as the reference lays them out."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.program import synth as _synth
from fdvv.program.synth import Slot, Waveform
from tests.support.program.slot_strategies import SLOTS
from tests.support.program.synth_in_c import NOTHING, RIGHT, SLOT, STRENGTH, Board
from tests.support.program.vibration_wire import (
    bank_messages,
    checksum,
    load_messages,
    play_message,
    read_status,
    set_message,
)

SNAP = Slot(Waveform.SINE, 3824, 256, 1840, 50_461)
BLIP = Slot(Waveform.SAMPLED, 65_535, 300, 2047, wave=tuple(range(-20, 20)))


def counts(board: Board) -> tuple[int, int]:
    status = read_status(board.status())
    return status.accepted, status.errors


def loaded() -> Board:
    board = Board()
    board.store(SNAP, BLIP)
    return board


ACCEPTED = len(bank_messages([SNAP, BLIP]))


@given(st.lists(SLOTS, max_size=16).filter(lambda slots: sum(len(s.wave) for s in slots) <= 1024))
def test_every_message_that_python_makes_is_accepted(slots: list[Slot]) -> None:
    board = Board()
    board.store(*slots)
    assert counts(board) == (len(bank_messages(slots)) % 256, 0)
    for c_slot, slot in zip(board.bank.slots, slots, strict=False):
        assert (c_slot.frequency_Hz16, c_slot.duration_samples) == (
            slot.frequency_Hz16,
            slot.duration_samples,
        )
        assert (c_slot.amplitude_counts, c_slot.decay_q16) == (slot.amplitude_counts, slot.decay_q16)
        assert tuple(board.bank.pool[c_slot.wave_at : c_slot.wave_at + len(slot.wave)]) == slot.wave


def test_a_play_tells_slot_and_strength_as_they_come_and_then_that_they_were_right() -> None:
    assert loaded().send(play_message(1, 77)) == [NOTHING, SLOT, STRENGTH, RIGHT]


@given(st.sampled_from([play_message(0), *bank_messages([SNAP, BLIP])]), st.data())
def test_a_message_with_a_flipped_bit_is_ignored_and_counted(message: bytes, data: st.DataObject) -> None:
    board = loaded()
    before = board.contents()
    bit = data.draw(st.integers(0, 8 * len(message) - 1))
    damaged = bytearray(message)
    damaged[bit // 8] ^= 1 << bit % 8
    brought = board.send(bytes(damaged))
    assert RIGHT not in brought
    assert board.contents() == before
    assert counts(board) == (ACCEPTED, 1)


@given(st.sampled_from([play_message(0), *bank_messages([SNAP, BLIP])]), st.data())
def test_a_message_cut_off_is_ignored_and_counted(message: bytes, data: st.DataObject) -> None:
    board = loaded()
    before = board.contents()
    keep = data.draw(st.integers(1, len(message) - 1))
    # the next START ends it as well as a STOP
    assert RIGHT not in board.send(message[:keep], stop=data.draw(st.booleans()))
    assert board.send(play_message(0))[-1] == RIGHT
    assert board.contents() == before
    assert counts(board) == (ACCEPTED + 1, 1)


@given(st.binary(min_size=1, max_size=40))
def test_arbitrary_bytes_never_break_the_next_message(noise: bytes) -> None:
    board = loaded()
    board.send(noise)
    assert board.send(set_message(0, SNAP))[-1] == NOTHING
    assert board.send(play_message(0))[-1] == RIGHT


def test_bytes_after_the_checksum_are_counted_once_and_the_message_stands() -> None:
    board = loaded()
    assert board.send(play_message(0) + b"\x00\x01\x02") == [NOTHING, SLOT, STRENGTH, RIGHT] + [NOTHING] * 3
    assert counts(board) == (ACCEPTED + 1, 1)


def test_an_address_without_a_byte_is_no_error() -> None:
    board = loaded()
    board.send(b"")
    assert counts(board) == (ACCEPTED, 0)


def sealed(*data: int) -> bytes:
    return bytes([*data, checksum(bytes(data))])


MEANINGLESS = {
    "command 0": sealed(0),
    "command 4": sealed(0x80),
    "short play": sealed(1 << 5 | 1, 0),
    "long play": sealed(1 << 5 | 3, 0, 255, 0),
    "short set": sealed(2 << 5 | 13, *([0] * 13)),
    "empty load": sealed(3 << 5 | 2, 0, 0),
    "long load": sealed(3 << 5 | 31, 0, 0, *([1] * 29)),
    "load past the pool": sealed(3 << 5 | 3, 0, 4, 1),
    "play of an empty slot": sealed(1 << 5 | 2, 2, 255),
    "play of slot 16": sealed(1 << 5 | 2, 16, 255),
    "set of slot 16": sealed(2 << 5 | 14, 16, *([0] * 13)),
    "amplitude of 2048": sealed(2 << 5 | 14, 0, 0, 0, 0, 1, 0, 0, 8, 0, 0, 0, 0, 0, 0),
}


@pytest.mark.parametrize("what", MEANINGLESS)
def test_an_intact_message_that_means_nothing_is_ignored_and_counted(what: str) -> None:
    board = loaded()
    before = board.contents()
    assert RIGHT not in board.send(MEANINGLESS[what])
    assert board.contents() == before
    assert counts(board) == (ACCEPTED, 1)


def test_the_status_carries_its_flags_and_a_right_checksum() -> None:
    status = read_status(loaded().status(flags=3))
    assert (status.playing, status.watchdog) == (True, True)


SYNTH = Path(__file__).resolve().parents[4] / "firmware" / "core" / "synth.h"


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("FDVV_SYNTH_RATE_HZ", _synth.RATE_HZ),
        ("FDVV_SYNTH_SILENCE", _synth.SILENCE_counts),
        ("FDVV_SYNTH_AMPLITUDE_MAX", _synth.AMPLITUDE_MAX_counts),
        ("FDVV_SYNTH_SLOTS", _synth.SLOTS),
        ("FDVV_SYNTH_POOL_BYTES", _synth.POOL_BYTES),
        ("FDVV_SYNTH_WAVE_SAMPLES", _synth.WAVE_SAMPLES),
        ("FDVV_SYNTH_SINE", Waveform.SINE),
        ("FDVV_SYNTH_SAMPLED", Waveform.SAMPLED),
    ],
)
def test_a_number_of_the_synthesiser_is_the_same_in_c_and_in_python(name: str, value: int) -> None:
    found = re.search(rf"\b{name} (?:= )?(0x[0-9A-F]+|\d+)", SYNTH.read_text())
    assert found, name
    assert int(found[1], 0) == value


def test_the_checksum_is_the_published_crc_8() -> None:
    # the check value of CRC-8/SMBUS in every catalogue of checksums
    assert checksum(b"123456789") == 0xF4


def test_messages_are_laid_out_as_the_reference_says() -> None:
    assert play_message(3, 128).hex(" ") == "22 03 80 23"
    assert set_message(2, SNAP)[:-1].hex(" ") == "4e 02 00 f0 0e 00 01 30 07 1d c5 00 00 00 00"
    (load,) = load_messages((1, -1), 0x0102)
    assert load[:-1].hex(" ") == "64 02 01 01 ff"

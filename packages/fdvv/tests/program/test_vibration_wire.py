from __future__ import annotations

import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.errors import DeviceError, ModelError
from fdvv.program import synth as _synth
from fdvv.program.synth import Slot, Waveform
from tests.support.program import vibration_wire as _vibration_wire
from tests.support.program.vibration_wire import (
    BoardStatus,
    bank_messages,
    checksum,
    load_messages,
    play_message,
    read_status,
    set_message,
)

CORE = Path(__file__).resolve().parents[4] / "firmware" / "core"
SNAP = Slot(Waveform.SINE, 3824, 256, 1840, 50_461)
BLIP = Slot(Waveform.SAMPLED, 65_535, 300, 2047, wave=tuple(range(-20, 20)))


def number_in(header: str, name: str) -> int:
    found = re.search(rf"\b{name} (?:= )?(0x[0-9A-F]+|\d+)", (CORE / header).read_text())
    assert found, f"{header} has no {name}"
    return int(found[1], 0)


@pytest.mark.parametrize(
    ("header", "name", "value"),
    [
        ("vibration_wire.h", "FDVV_VIBRATION_VERSION", _vibration_wire.VERSION),
        ("vibration_wire.h", "FDVV_VIBRATION_ADDRESS", _vibration_wire.ADDRESS),
        ("vibration_wire.h", "FDVV_VIBRATION_PLAY", _vibration_wire.PLAY),
        ("vibration_wire.h", "FDVV_VIBRATION_SET", _vibration_wire.SET),
        ("vibration_wire.h", "FDVV_VIBRATION_LOAD", _vibration_wire.LOAD),
        ("vibration_wire.h", "FDVV_VIBRATION_LOAD_SAMPLES", _vibration_wire.LOAD_SAMPLES),
        ("vibration_wire.h", "FDVV_VIBRATION_STATUS_BYTES", _vibration_wire.STATUS_BYTES),
        ("vibration_wire.h", "FDVV_VIBRATION_PLAYING", _vibration_wire.PLAYING),
        ("vibration_wire.h", "FDVV_VIBRATION_WATCHDOG", _vibration_wire.WATCHDOG),
        ("synth.h", "FDVV_SYNTH_RATE_HZ", _synth.RATE_HZ),
        ("synth.h", "FDVV_SYNTH_SILENCE", _synth.SILENCE_counts),
        ("synth.h", "FDVV_SYNTH_AMPLITUDE_MAX", _synth.AMPLITUDE_MAX_counts),
        ("synth.h", "FDVV_SYNTH_SLOTS", _synth.SLOTS),
        ("synth.h", "FDVV_SYNTH_POOL_BYTES", _synth.POOL_BYTES),
        ("synth.h", "FDVV_SYNTH_WAVE_SAMPLES", _synth.WAVE_SAMPLES),
        ("synth.h", "FDVV_SYNTH_SINE", Waveform.SINE),
        ("synth.h", "FDVV_SYNTH_SAMPLED", Waveform.SAMPLED),
    ],
)
def test_a_number_of_the_wire_is_the_same_in_c_and_in_python(header: str, name: str, value: int) -> None:
    assert number_in(header, name) == value


def test_the_checksum_is_the_published_crc_8() -> None:
    # the check value of CRC-8/SMBUS in every catalogue of checksums
    assert checksum(b"123456789") == 0xF4


def test_messages_are_laid_out_as_the_reference_says() -> None:
    assert play_message(3, 128).hex(" ") == "22 03 80 23"
    assert set_message(2, SNAP)[:-1].hex(" ") == "4e 02 00 f0 0e 00 01 30 07 1d c5 00 00 00 00"
    (load,) = load_messages((1, -1), 0x0102)
    assert load[:-1].hex(" ") == "64 02 01 01 ff"


@given(st.binary(min_size=1, max_size=32), st.integers(0, 8 * 33 - 1))
def test_one_flipped_bit_never_passes_the_checksum(data: bytes, bit: int) -> None:
    message = bytearray([*data, checksum(data)])
    assert checksum(bytes(message)) == 0
    message[bit // 8 % len(message)] ^= 1 << bit % 8
    assert checksum(bytes(message)) != 0


def test_a_bank_puts_its_waves_one_after_the_other() -> None:
    messages = bank_messages([BLIP, SNAP, BLIP])
    loads = [m for m in messages if m[0] >> 5 == _vibration_wire.LOAD]
    assert [int.from_bytes(m[1:3], "little") for m in loads] == [0, 28, 40, 68]
    sets = [m for m in messages if m[0] >> 5 == _vibration_wire.SET]
    assert [int.from_bytes(m[11:13], "little") for m in sets] == [0, 40, 40]


def test_a_bank_beyond_the_board_is_refused() -> None:
    with pytest.raises(ModelError, match="holds 16 slots and 1024 samples of waves, got 17 and 0"):
        bank_messages([SNAP] * 17)
    with pytest.raises(ModelError, match="got 3 and 1536"):
        bank_messages([Slot(Waveform.SAMPLED, 1, 1, 1, wave=(0,) * 512)] * 3)


def test_numbers_beyond_a_message_are_refused() -> None:
    with pytest.raises(ModelError, match="slot must be a whole number from 0 to 15, got 16"):
        play_message(16)
    with pytest.raises(ModelError, match="strength must be a whole number from 0 to 255, got 256"):
        play_message(0, 256)
    with pytest.raises(ModelError, match="wave_at must be a whole number from 0 to 984, got 985"):
        set_message(0, BLIP, 985)


def test_a_status_is_read() -> None:
    data = bytes([1, 3, 7, 9])
    assert read_status(data + bytes([checksum(data)])) == BoardStatus(True, True, 7, 9)


def test_a_damaged_or_foreign_status_is_refused() -> None:
    with pytest.raises(DeviceError, match="status is damaged: ff ff ff ff ff"):
        read_status(b"\xff" * 5)
    data = bytes([2, 0, 0, 0])
    with pytest.raises(DeviceError, match="speaks version 2, this program 1"):
        read_status(data + bytes([checksum(data)]))

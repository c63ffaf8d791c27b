from __future__ import annotations

import re
from pathlib import Path

import pytest

from fdvv.program import synth as _synth
from fdvv.program.synth import Slot, Waveform
from tests.support.program.vibration_wire import (
    ADDRESS,
    VERSION,
    checksum,
    load_messages,
    play_message,
    set_message,
)

CORE = Path(__file__).resolve().parents[4] / "firmware" / "core"
SNAP = Slot(Waveform.SINE, 3824, 256, 1840, 50_461)


@pytest.mark.parametrize(
    ("header", "name", "value"),
    [
        ("vibration_wire.h", "FDVV_VIBRATION_VERSION", VERSION),
        ("vibration_wire.h", "FDVV_VIBRATION_ADDRESS", ADDRESS),
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
    found = re.search(rf"\b{name} (?:= )?(0x[0-9A-F]+|\d+)", (CORE / header).read_text())
    assert found, f"{header} has no {name}"
    assert int(found[1], 0) == value


def test_the_checksum_is_the_published_crc_8() -> None:
    # the check value of CRC-8/SMBUS in every catalogue of checksums
    assert checksum(b"123456789") == 0xF4


def test_messages_are_laid_out_as_the_reference_says() -> None:
    assert play_message(3, 128).hex(" ") == "22 03 80 23"
    assert set_message(2, SNAP)[:-1].hex(" ") == "4e 02 00 f0 0e 00 01 30 07 1d c5 00 00 00 00"
    (load,) = load_messages((1, -1), 0x0102)
    assert load[:-1].hex(" ") == "64 02 01 01 ff"

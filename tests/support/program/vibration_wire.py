"""The messages of the vibration board as the firmware's receiver understands them."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass

from fdvv.program.synth import Slot

VERSION = 1
PLAY, SET, LOAD = 1, 2, 3
LOAD_SAMPLES = 28
PLAYING, WATCHDOG = 1, 2


def checksum(data: bytes) -> int:
    """Return the CRC-8 of data: polynomial x⁸ + x² + x + 1, from 0 (SMBus packet error code)."""
    crc = 0
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = (crc << 1) ^ (0x107 if crc & 0x80 else 0)
    return crc


def _message(command: int, payload: bytes) -> bytes:
    data = bytes([command << 5 | len(payload)]) + payload
    return data + bytes([checksum(data)])


def play_message(slot: int, strength: int = 255) -> bytes:
    """Return the message that plays a slot; strength 255 is the slot's amplitude, 0 silences the board."""
    return _message(PLAY, bytes([slot, strength]))


def set_message(index: int, slot: Slot, wave_at: int = 0) -> bytes:
    """Return the message that stores a slot; wave_at is the place of its wave in the board's pool."""
    numbers = (slot.frequency_Hz16, slot.duration_samples, slot.amplitude_counts, slot.decay_q16)
    return _message(SET, struct.pack("<2B6H", index, slot.waveform, *numbers, wave_at, len(slot.wave)))


def load_messages(wave: Sequence[int], wave_at: int) -> list[bytes]:
    """Return the messages that put the samples of a wave, -128 to 127, into the board's pool."""
    parts = [(at, wave[at : at + LOAD_SAMPLES]) for at in range(0, len(wave), LOAD_SAMPLES)]
    return [_message(LOAD, struct.pack(f"<H{len(part)}b", wave_at + at, *part)) for at, part in parts]


def bank_messages(slots: Sequence[Slot]) -> list[bytes]:
    """Return the messages that store slots 0, 1, … with their waves one after the other in the pool."""
    messages, wave_at = [], 0
    for index, slot in enumerate(slots):
        messages += [*load_messages(slot.wave, wave_at), set_message(index, slot, wave_at)]
        wave_at += len(slot.wave)
    return messages


@dataclass(frozen=True)
class BoardStatus:
    """What the board says of itself.

    Attributes
    ----------
    playing : a slot is sounding.
    watchdog : the last reset was the watchdog's, so the slots are empty again.
    accepted, errors : messages carried out and ignored since the reset, modulo 256.
    """

    playing: bool
    watchdog: bool
    accepted: int
    errors: int


def read_status(data: bytes) -> BoardStatus:
    """Read the five bytes of a status, which must be whole and of this version."""
    assert checksum(data) == 0, data.hex(" ")
    version, flags, accepted, errors, _ = data
    assert version == VERSION
    return BoardStatus(bool(flags & PLAYING), bool(flags & WATCHDOG), accepted, errors)

"""The vibration board's synthesiser in integers: the same bits as firmware/core/synth.c.

A slot is a decaying sine or a short sampled wave. The board gives 12-bit samples at 16 kHz, silence being the
middle; a sample is held for one period and taken at its middle. The envelope falls by decay_q16 over each
block of 32 samples, linearly inside a block.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError

RATE_HZ = 16_000
"""Samples per second of the vibration board."""
BLOCK_SAMPLES = 32
SILENCE_counts = 2048
"""Middle of its converter's range."""
AMPLITUDE_MAX_counts = 2047
STEADY_Q16 = 65_535
SLOTS = 16
POOL_BYTES = 1024
WAVE_SAMPLES = 512

IntArray = npt.NDArray[np.int64]

SINE_Q12: IntArray = np.rint(4096 * np.sin(2 * np.pi * np.arange(256) / 256)).astype(np.int64)
"""One turn of a sine in 256 steps, times 4096."""


class Waveform(IntEnum):
    """What a slot plays, as the wire numbers it."""

    SINE = 0
    SAMPLED = 1


@dataclass(frozen=True)
class Slot:
    """One waveform of the vibration board.

    Attributes
    ----------
    waveform : decaying sine or sampled wave.
    frequency_Hz16 : sixteenths of a hertz, 0 to 65535; of the sine, or playback rate of the wave.
    duration_samples : 1/16000 s, 1 to 65535; silence after it. A wave also ends with its last sample.
    amplitude_counts : at the start, 0 to 2047; for a wave that of a sample of 128.
    decay_q16 : amplitude after 32 samples over that before, times 65536; 65535 keeps it exactly.
    wave : 1 to 512 samples of -128 to 127 for a sampled wave, none for a sine.
    """

    waveform: Waveform
    frequency_Hz16: int
    duration_samples: int
    amplitude_counts: int
    decay_q16: int = STEADY_Q16
    wave: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "waveform", Waveform(self.waveform))
        object.__setattr__(self, "wave", tuple(self.wave))
        check_range("frequency_Hz16", self.frequency_Hz16, 0, 65_535)
        check_range("duration_samples", self.duration_samples, 1, 65_535)
        check_range("amplitude_counts", self.amplitude_counts, 0, AMPLITUDE_MAX_counts)
        check_range("decay_q16", self.decay_q16, 0, 65_535)
        if self.waveform is Waveform.SINE:
            check_range("length of the wave of a sine", len(self.wave), 0, 0)
        else:
            check_range("length of the wave", len(self.wave), 1, WAVE_SAMPLES)
        for sample in self.wave:
            check_range("sample of the wave", sample, -128, 127)


def check_range(name: str, value: int, low: int, high: int) -> None:
    """Raise ModelError unless value is a whole number from low to high."""
    if not low <= value <= high or value != int(value):
        raise ModelError(f"{name} must be a whole number from {low} to {high}, got {value}")


def render(slot: Slot, samples: int, strength: int = 255) -> npt.NDArray[np.uint16]:
    """Give the converter's counts from the start of a slot, shape (samples,), 0 to 4095.

    strength scales the amplitude by 1/256 of strength, or of strength + 1 from 128 on: 255 plays the slot
    is, 0 is silence."""
    check_range("strength", strength, 0, 255)
    counts = np.full(samples, SILENCE_counts, dtype=np.uint16)
    length = min(samples, slot.duration_samples if strength else 0)
    shape_q12 = (_sine_q12 if slot.waveform is Waveform.SINE else _wave_q12)(slot, length)
    product_q17 = shape_q12 * _envelope_q5(slot, strength, len(shape_q12))
    counts[: len(shape_q12)] = (product_q17 + (SILENCE_counts << 17) + (1 << 16)) >> 17
    return counts


def _envelope_q5(slot: Slot, strength: int, length: int) -> IntArray:
    start = slot.amplitude_counts * (strength + (strength >> 7)) >> 3
    within = np.arange(BLOCK_SAMPLES)
    blocks = [within[:0]]
    for _ in range(0, length, BLOCK_SAMPLES):
        end = start if slot.decay_q16 == STEADY_Q16 else (start * slot.decay_q16 + 32_768) >> 16
        blocks.append(start - within * ((start - end) >> 5))
        start = end
    return np.concatenate(blocks)[:length].astype(np.int64)


def _phase(increment: int, length: int) -> IntArray:
    return (increment // 2 + increment * np.arange(length, dtype=np.int64)) & 0xFFFF_FFFF


def _sine_q12(slot: Slot, length: int) -> IntArray:
    # 2**32 / 256000 = 16777.216, and 0.216 is 14156 / 65536
    increment = slot.frequency_Hz16 * 16_777 + (slot.frequency_Hz16 * 14_156 >> 16)
    phase = _phase(increment, length)
    index, fraction_q8 = phase >> 24, phase >> 16 & 255
    here, after = SINE_Q12[index], SINE_Q12[(index + 1) & 255]
    risen: IntArray = here + ((after - here) * fraction_q8 >> 8)
    return risen


def _wave_q12(slot: Slot, length: int) -> IntArray:
    phase = _phase(slot.frequency_Hz16 * 16_777 >> 16, length)
    phase = phase[phase >> 16 < len(slot.wave)]
    wave = np.array([*slot.wave, 0], dtype=np.int64)
    index, fraction_q7 = phase >> 16, phase >> 9 & 127
    here, after = wave[index], wave[index + 1]
    risen: IntArray = (here * 128 + (after - here) * fraction_q7) >> 2
    return risen

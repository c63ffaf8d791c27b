"""The vibration board's synthesiser in integers: the same bits as firmware/core/synth.c.

A slot is a decaying sine or a short sampled wave. The board gives 12-bit samples at 16 kHz, silence being the
middle; a sample is held for one period and taken at its middle. The envelope falls by decay_q16 over each
block of 32 samples, linearly inside a block.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.model.vibration import Vibration

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
WAVE_PEAK = 127  # samples are signed bytes; -128 would have no counterpart
FASTEST_WAVE_Hz = 65_535 / 16  # a playback rate is 16 bits of 1/16 Hz


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
    """Return the converter's counts from the start of a slot, shape (samples,), 0 to 4095.

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
    # the last sample falls to silence
    wave = np.array([*slot.wave, 0], dtype=np.int64)
    index, fraction_q7 = phase >> 16, phase >> 9 & 127
    here, after = wave[index], wave[index + 1]
    risen: IntArray = (here * 128 + (after - here) * fraction_q7) >> 2
    return risen


@dataclass(frozen=True)
class ConvertedVibration:
    """A slot and its distance from the vibration that it approximates.

    Attributes
    ----------
    slot : what the board plays.
    error_counts : largest distance between the board's samples and the vibration at their middles.
    error_ratio : rms of that distance over rms of the vibration; 0 for a vibration of amplitude 0.
    """

    slot: Slot
    error_counts: float
    error_ratio: float


def slot_of_vibration(vibration: Vibration, counts_per_m_s2: float) -> ConvertedVibration:
    """Convert a vibration to a slot and measure the rounding.

    One mode that starts at phase 0 with a positive amplitude becomes a decaying sine: frequency within
    1/32 Hz, duration within 1/32 ms, amplitude within half a count, decay per 2 ms within 2**-17; the linear
    pieces of the envelope lie above the exponential by at most (decay_1_s * 2 ms)**2 / 8 of it. Anything else
    becomes a sampled wave of 8 bits, at 4096 samples a second or as many as 512 samples allow.

    counts_per_m_s2 is the exciter's gain: converter counts for an acceleration of the cap of 1 m/s². Raises
    ModelError if the vibration is too strong, too long or too fast for the board.
    """
    if not (np.isfinite(counts_per_m_s2) and counts_per_m_s2 > 0):
        raise ModelError(f"counts_per_m_s2 must be positive, got {counts_per_m_s2}")
    mode = vibration.modes[0]
    simple = len(vibration.modes) == 1 and mode.phase_rad == 0 and mode.amplitude_m_s2 >= 0
    duration_samples = max(1, round(vibration.duration_s * RATE_HZ))
    slot = (_sine if simple else _sample)(vibration, counts_per_m_s2, duration_samples)
    return _measure(slot, vibration, counts_per_m_s2)


def _sine(vibration: Vibration, counts_per_m_s2: float, duration_samples: int) -> Slot:
    mode = vibration.modes[0]
    ratio = np.exp(-mode.decay_1_s * BLOCK_SAMPLES / RATE_HZ)
    return Slot(
        Waveform.SINE,
        frequency_Hz16=round(16 * mode.frequency_Hz),
        duration_samples=duration_samples,
        amplitude_counts=round(mode.amplitude_m_s2 * counts_per_m_s2),
        decay_q16=min(STEADY_Q16, round(65_536 * ratio)),
    )


def _sample(vibration: Vibration, counts_per_m_s2: float, duration_samples: int) -> Slot:
    rate_Hz16 = int(16 * min(FASTEST_WAVE_Hz, (WAVE_SAMPLES - 2) / vibration.duration_s))
    fastest_Hz = max(mode.frequency_Hz for mode in vibration.modes)
    if fastest_Hz >= rate_Hz16 / 32:
        held = (
            f"a sampled vibration of {vibration.duration_s} s holds frequencies below {rate_Hz16 / 32:g} Hz"
        )
        raise ModelError(f"{held}, got {fastest_Hz:g} Hz; shorten it or leave out that mode")
    t_s = np.arange(int(vibration.duration_s * rate_Hz16 / 16) + 2) * 16 / rate_Hz16
    # the sample after the end is interpolated towards, so it must go on as the modes do
    endless = replace(vibration, duration_s=2 * float(t_s[-1]))
    counts = endless.acceleration_m_s2(t_s) * counts_per_m_s2
    peak = float(np.max(np.abs(counts)))
    wave = np.rint(counts * (WAVE_PEAK / peak if peak else 0.0)).astype(int)
    return Slot(
        Waveform.SAMPLED,
        frequency_Hz16=rate_Hz16,
        duration_samples=duration_samples,
        amplitude_counts=round(peak * 128 / WAVE_PEAK),
        wave=tuple(wave.tolist()),
    )


def _measure(slot: Slot, vibration: Vibration, counts_per_m_s2: float) -> ConvertedVibration:
    length = slot.duration_samples + 1
    middles_s = (np.arange(length) + 0.5) / RATE_HZ
    exact = vibration.acceleration_m_s2(middles_s) * counts_per_m_s2
    error = render(slot, length).astype(float) - SILENCE_counts - exact
    power = float(np.mean(exact**2))
    ratio = float(np.sqrt(np.mean(error**2) / power)) if power else 0.0
    return ConvertedVibration(slot, float(np.max(np.abs(error))), ratio)

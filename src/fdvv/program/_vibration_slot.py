"""From a model's vibration to a slot of the vibration board, and what that cost."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fdvv.errors import ModelError
from fdvv.model import Vibration
from fdvv.program._synth import (
    BLOCK_SAMPLES,
    RATE_HZ,
    STEADY_Q16,
    WAVE_SAMPLES,
    SILENCE_counts,
    Slot,
    Waveform,
    render,
)
from fdvv.units import FloatArray

WAVE_PEAK = 127
FASTEST_WAVE_Hz = 65_535 / 16


@dataclass(frozen=True)
class ConvertedVibration:
    """A slot and how far it is from the vibration it stands for.

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
    slot = (_sine if simple else _sampled)(vibration, counts_per_m_s2)
    return _measure(slot, vibration, counts_per_m_s2)


def _duration_samples(vibration: Vibration) -> int:
    return max(1, round(vibration.duration_s * RATE_HZ))


def _sine(vibration: Vibration, counts_per_m_s2: float) -> Slot:
    mode = vibration.modes[0]
    ratio = np.exp(-mode.decay_1_s * BLOCK_SAMPLES / RATE_HZ)
    return Slot(
        Waveform.SINE,
        frequency_Hz16=round(16 * mode.frequency_Hz),
        duration_samples=_duration_samples(vibration),
        amplitude_counts=round(mode.amplitude_m_s2 * counts_per_m_s2),
        decay_q16=min(STEADY_Q16, round(65_536 * ratio)),
    )


def _sampled(vibration: Vibration, counts_per_m_s2: float) -> Slot:
    rate_Hz16 = int(16 * min(FASTEST_WAVE_Hz, (WAVE_SAMPLES - 2) / vibration.duration_s))
    fastest_Hz = max(mode.frequency_Hz for mode in vibration.modes)
    if fastest_Hz >= rate_Hz16 / 32:
        raise ModelError(
            f"a sampled vibration of {vibration.duration_s} s holds frequencies below {rate_Hz16 / 32:g} Hz, "
            f"got {fastest_Hz:g} Hz; shorten it or leave out that mode"
        )
    t_s = np.arange(int(vibration.duration_s * rate_Hz16 / 16) + 2) * 16 / rate_Hz16
    # the sample after the end is interpolated towards, so it must go on as the modes do
    endless = replace(vibration, duration_s=2 * float(t_s[-1]))
    counts = endless.acceleration_m_s2(t_s) * counts_per_m_s2
    peak = float(np.max(np.abs(counts)))
    wave = np.rint(counts * (WAVE_PEAK / peak if peak else 0.0)).astype(int)
    return Slot(
        Waveform.SAMPLED,
        frequency_Hz16=rate_Hz16,
        duration_samples=_duration_samples(vibration),
        amplitude_counts=round(peak * 128 / WAVE_PEAK),
        wave=tuple(wave.tolist()),
    )


def _exact_counts(vibration: Vibration, counts_per_m_s2: float, length: int) -> FloatArray:
    middles_s = (np.arange(length) + 0.5) / RATE_HZ
    return vibration.acceleration_m_s2(middles_s) * counts_per_m_s2


def _measure(slot: Slot, vibration: Vibration, counts_per_m_s2: float) -> ConvertedVibration:
    length = slot.duration_samples + 1
    exact = _exact_counts(vibration, counts_per_m_s2, length)
    error = render(slot, length).astype(float) - SILENCE_counts - exact
    power = float(np.mean(exact**2))
    ratio = float(np.sqrt(np.mean(error**2) / power)) if power else 0.0
    return ConvertedVibration(slot, float(np.max(np.abs(error))), ratio)

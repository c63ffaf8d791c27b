"""How alike two vibrations are: in shape, in spectrum, and by two published vibrotactile metrics.

ST-SIM and SPQI are those of VibroMAF (Hofbauer, Noll et al. 2022), after Hassen and Steinbach (2020) and Noll
et al. (2021): blocks of 64 ms at 8 kHz, spectra above a threshold of perception. They were made for coded
recordings and take the level of full scale for known; here the target's peak is full scale.
"""

from __future__ import annotations

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray

METRIC_Hz = 8000.0
BLOCK = 512
BAND_Hz = (40.0, 1000.0)
"""What the fingertip's fast receptors feel."""
TINY = float(np.finfo(float).eps)


def correlation(felt: FloatArray, target: FloatArray) -> float:
    """Give the largest |correlation| of two signals at any delay: 1 is the same shape, at any strength.

    felt, target : of one rate and any lengths. Everything in them counts, ringing after the end too. 0 if one
    of them is silent.
    """
    scale = float(np.linalg.norm(felt) * np.linalg.norm(target))
    if not scale:
        return 0.0
    return float(np.abs(_correlated(felt, target)).max()) / scale


def delay_samples(felt: FloatArray, target: FloatArray) -> int:
    """Give the delay of felt at which it is most like target, in samples; negative if it is early."""
    found = _correlated(felt, target)
    at = int(np.argmax(np.abs(found)))
    return at if at < felt.size else at - found.size


def spectral_similarity(felt: FloatArray, target: FloatArray, rate_Hz: float) -> float:
    """Give the cosine of the two magnitude spectra from 40 to 1000 Hz: 1 is the same, whatever the phases."""
    size = 1 << int(np.ceil(np.log2(max(felt.size, target.size, rate_Hz / 5))))
    frequency_Hz = np.fft.rfftfreq(size, 1 / rate_Hz)
    band = (frequency_Hz >= BAND_Hz[0]) & (frequency_Hz <= BAND_Hz[1])
    a, b = (np.abs(np.fft.rfft(signal, size))[band] for signal in (felt, target))
    scale = float(np.linalg.norm(a) * np.linalg.norm(b))
    return float(a @ b) / scale if scale else 0.0


def st_sim(felt: FloatArray, target: FloatArray, rate_Hz: float, weight: float = 2 / 3) -> float:
    """Give the spectral temporal similarity: 1 is the same.

    felt is moved to where it is most like target first, turned over if need be. weight : of time against
    spectrum, 0 to 1. Temporal and spectral similarity are means over blocks of Σ r d / Σ r²: of the blocks
    less their mean over their deviation, and of Φ(level above threshold / 12 dB). Below 0 counts as 0.
    """
    if not 0 < weight < 1:
        raise ModelError(f"weight must lie between 0 and 1, got {weight}")
    from scipy.special import ndtr

    d, r = _blocks(felt, target, rate_Hz)
    if np.array_equal(d, r):
        return 1.0
    spectral = _similar(ndtr(_audible_dB(r) / 12), ndtr(_audible_dB(d) / 12))
    temporal = _similar(_standard(r), _standard(d))
    return float(max(temporal, 0.0) ** weight * max(spectral, 0.0) ** (1 - weight))


def spqi(
    felt: FloatArray, target: FloatArray, rate_Hz: float, slope: float = 0.3, offset: float = -2.0
) -> float:
    """Give the spectral perceptual quality index: 1 is as good as the target.

    Mean over blocks of (1 - tanh(slope ε - offset)) / 2, where ε is the summed difference of perceptual
    spectra over the target's sum, in dB. Alignment as for st_sim.
    """
    d, r = _blocks(felt, target, rate_Hz)
    if np.array_equal(d, r):
        return 1.0
    reference, other = (10 ** (_audible_dB(signal) / 10) for signal in (r, d))
    ratio = np.abs(reference - other).sum(axis=1) / (reference.sum(axis=1) + TINY)
    error_dB = 10 * np.log10(np.maximum(ratio, TINY))
    return float(np.mean((1 - np.tanh(slope * error_dB - offset)) / 2))


def _correlated(felt: FloatArray, target: FloatArray) -> FloatArray:
    """Give the correlation at every delay of felt, circular over a length that keeps them apart."""
    size = felt.size + target.size
    found: FloatArray = np.fft.irfft(np.fft.rfft(felt, size) * np.conj(np.fft.rfft(target, size)), size)
    return found


def _blocks(felt: FloatArray, target: FloatArray, rate_Hz: float) -> tuple[FloatArray, FloatArray]:
    """Align, bring to the metrics' rate and level, and cut into blocks of (count, 512)."""
    peak = float(np.abs(target).max(initial=0.0))
    if not peak:
        raise ModelError("a vibration can only be compared with one that is not silent")
    delay = delay_samples(felt, target)
    at = np.arange(target.size) + delay
    moved = np.where((at >= 0) & (at < felt.size), felt[np.clip(at, 0, felt.size - 1)], 0.0)
    turned = -moved if moved @ target < 0 else moved
    count = int(np.ceil(max(target.size / rate_Hz * METRIC_Hz, 1.0) / BLOCK)) * BLOCK
    times = np.arange(count) / METRIC_Hz * rate_Hz
    both = (np.interp(times, np.arange(target.size), signal / peak, right=0.0) for signal in (turned, target))
    d, r = (signal.reshape(-1, BLOCK) for signal in both)
    return d, r


def _audible_dB(blocks: FloatArray) -> FloatArray:
    """Give the spectrum of each block above the threshold of perception, dB."""
    from scipy.fft import dct

    spectrum = np.abs(dct(blocks, norm="ortho", axis=1))
    found: FloatArray = 20 * np.log10(np.maximum(spectrum, TINY)) - threshold_dB()
    return found


def threshold_dB() -> FloatArray:
    """Give VibroMAF's threshold at the metrics' frequencies, dB of full scale: lowest, -77, at 250 Hz."""
    frequency_Hz = np.linspace(0, METRIC_Hz, 2 * BLOCK)[:BLOCK]
    bend = 1 - 250 / 550
    found = 62 / np.log10(bend) ** 2 * np.log10(frequency_Hz / 550 + bend) ** 2 - 77
    beyond = int(np.argmax(found > 0))
    found[beyond:] = found[beyond]
    return np.asarray(found, dtype=np.float64)


def _standard(blocks: FloatArray) -> FloatArray:
    centred = blocks - blocks.mean(axis=1, keepdims=True)
    found: FloatArray = centred / (blocks.std(axis=1, keepdims=True) + TINY)
    return found


def _similar(reference: FloatArray, other: FloatArray) -> float:
    top, bottom = (reference * other).sum(axis=1), (reference**2).sum(axis=1)
    return float(np.mean(top / (bottom + TINY)))

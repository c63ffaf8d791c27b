"""The drive that makes the cap's acceleration be a vibration: a regularised inverse with bounded gain.

How alike two vibrations are: in shape, in spectrum, and by two published vibrotactile metrics.

ST-SIM and SPQI are those of VibroMAF (Hofbauer, Noll et al. 2022), after Hassen and Steinbach (2020) and Noll
et al. (2021): blocks of 64 ms at 8 kHz, spectra above a threshold of perception. They were made for coded
recordings and take the level of full scale for known; here the target's peak is full scale.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.model.vibration import Vibration
from fdvv.units import FloatArray
from fdvv.vibration.exciter import FULL_SCALE_V, LIMIT_V, KnownExciter

METRIC_Hz = 8000.0
BLOCK = 512
BAND_Hz = (40.0, 1000.0)
"""What the fingertip's fast receptors feel."""
TINY = float(np.finfo(float).eps)
RATE_Hz = 16_000.0
"""At which the vibration board gives samples."""
WAVE_Hz = 65_535 / 16
WAVE_SAMPLES = 512
"""The fastest and the longest wave that it interpolates."""
RING_s = 0.03
"""Looked at beyond the drive's end: whatever rings on counts as error."""
STEPS = tuple(2.0**n for n in range(12))
"""Where the drive would exceed its limit, the inverse is bounded more tightly by these factors."""


def correlation(rendered: FloatArray, target: FloatArray) -> float:
    """Return the largest |correlation| of two signals at any delay: 1 is the same shape, at any strength.

    rendered, target : of one rate and any lengths. Everything in them counts, ringing after the end too. 0 if
    one of them is silent.
    """
    scale = float(np.linalg.norm(rendered) * np.linalg.norm(target))
    return float(np.abs(_cross_correlate(rendered, target)).max()) / scale if scale else 0.0


def delay_samples(rendered: FloatArray, target: FloatArray) -> int:
    """Return the delay of rendered at which it is most like target, in samples; negative if it is early."""
    correlation = _cross_correlate(rendered, target)
    at = int(np.argmax(np.abs(correlation)))
    return at if at < rendered.size else at - correlation.size


def spectral_similarity(rendered: FloatArray, target: FloatArray, rate_Hz: float) -> float:
    """Return the cosine of the two magnitude spectra from 40 to 1000 Hz: 1 is equal, whatever the phases."""
    size = 1 << int(np.ceil(np.log2(max(rendered.size, target.size, rate_Hz / 5))))
    frequency_Hz = np.fft.rfftfreq(size, 1 / rate_Hz)
    band = (frequency_Hz >= BAND_Hz[0]) & (frequency_Hz <= BAND_Hz[1])
    a, b = (np.abs(np.fft.rfft(signal, size))[band] for signal in (rendered, target))
    scale = float(np.linalg.norm(a) * np.linalg.norm(b))
    return float(a @ b) / scale if scale else 0.0


def st_sim(rendered: FloatArray, target: FloatArray, rate_Hz: float, weight: float = 2 / 3) -> float:
    """Return the spectral temporal similarity: 1 is the same.

    rendered is moved to where it is most like target first, turned over if need be. weight : of time against
    spectrum, 0 to 1. Temporal and spectral similarity are means over blocks of Σ r d / Σ r²: of the blocks
    less their mean over their deviation, and of Φ(level above threshold / 12 dB). Below 0 counts as 0.
    """
    if not 0 < weight < 1:
        raise ModelError(f"weight must lie between 0 and 1, got {weight}")
    from scipy.special import ndtr

    d, r = _blocks(rendered, target, rate_Hz)
    if np.array_equal(d, r):
        return 1.0
    spectral = _similar(ndtr(_audible_dB(r) / 12), ndtr(_audible_dB(d) / 12))
    temporal = _similar(_standard(r), _standard(d))
    return float(max(temporal, 0.0) ** weight * max(spectral, 0.0) ** (1 - weight))


def spqi(
    rendered: FloatArray, target: FloatArray, rate_Hz: float, slope: float = 0.3, offset: float = -2.0
) -> float:
    """Return the spectral perceptual quality index: 1 is as good as the target.

    Mean over blocks of (1 - tanh(slope ε - offset)) / 2, where ε is the summed difference of perceptual
    spectra over the target's sum, in dB. Alignment as for st_sim.
    """
    d, r = _blocks(rendered, target, rate_Hz)
    if np.array_equal(d, r):
        return 1.0
    reference, other = (10 ** (_audible_dB(signal) / 10) for signal in (r, d))
    ratio = np.abs(reference - other).sum(axis=1) / (reference.sum(axis=1) + TINY)
    error_dB = 10 * np.log10(np.maximum(ratio, TINY))
    return float(np.mean((1 - np.tanh(slope * error_dB - offset)) / 2))


def _cross_correlate(rendered: FloatArray, target: FloatArray) -> FloatArray:
    """Return the correlation at every delay of rendered, circular over a length that keeps them apart."""
    size = rendered.size + target.size
    return np.asarray(np.fft.irfft(np.fft.rfft(rendered, size) * np.conj(np.fft.rfft(target, size)), size))


def _blocks(rendered: FloatArray, target: FloatArray, rate_Hz: float) -> tuple[FloatArray, FloatArray]:
    """Align, bring to the metrics' rate and level, and cut into blocks of (count, 512)."""
    peak = float(np.abs(target).max(initial=0.0))
    if not peak:
        raise ModelError("a vibration can only be compared with one that is not silent")
    delay = delay_samples(rendered, target)
    at = np.arange(target.size) + delay
    moved = np.where((at >= 0) & (at < rendered.size), rendered[np.clip(at, 0, rendered.size - 1)], 0.0)
    turned = -moved if moved @ target < 0 else moved
    count = int(np.ceil(max(target.size / rate_Hz * METRIC_Hz, 1.0) / BLOCK)) * BLOCK
    times = np.arange(count) / METRIC_Hz * rate_Hz
    both = (np.interp(times, np.arange(target.size), signal / peak, right=0.0) for signal in (turned, target))
    d, r = (signal.reshape(-1, BLOCK) for signal in both)
    return d, r


def _audible_dB(blocks: FloatArray) -> FloatArray:
    """Return the spectrum of each block above the threshold of perception, dB."""
    from scipy.fft import dct

    spectrum = np.abs(dct(blocks, norm="ortho", axis=1))
    return np.asarray(20 * np.log10(np.maximum(spectrum, TINY)) - threshold_dB())


def threshold_dB() -> FloatArray:
    """Return VibroMAF's threshold at the metrics' frequencies, dB of full scale: lowest, -77, at 250 Hz."""
    frequency_Hz = np.linspace(0, METRIC_Hz, 2 * BLOCK)[:BLOCK]
    bend = 1 - 250 / 550
    threshold = 62 / np.log10(bend) ** 2 * np.log10(frequency_Hz / 550 + bend) ** 2 - 77
    beyond = int(np.argmax(threshold > 0))
    threshold[beyond:] = threshold[beyond]
    return np.asarray(threshold, dtype=np.float64)


def _standard(blocks: FloatArray) -> FloatArray:
    centred = blocks - blocks.mean(axis=1, keepdims=True)
    return np.asarray(centred / (blocks.std(axis=1, keepdims=True) + TINY))


def _similar(reference: FloatArray, other: FloatArray) -> float:
    top, bottom = (reference * other).sum(axis=1), (reference**2).sum(axis=1)
    return float(np.mean(top / (bottom + TINY)))


@dataclass(frozen=True)
class InverseSettings:
    """How the drive is found.

    Attributes
    ----------
    gain_dB : how much more the inverse may boost anything than the vibration's own strongest frequency.
    limit_V : largest drive.
    lead_s : how long before the vibration the drive may begin; the cap cannot get rid of the momentum that it
        is left with at the end unless it swings back a little first.
    tail_s : how long after its end the drive may go on, to brake the magnet.
    """

    gain_dB: float = 15.0
    limit_V: float = LIMIT_V
    lead_s: float = 0.001
    tail_s: float = 0.004

    def __post_init__(self) -> None:
        if not (np.isfinite(self.gain_dB) and 0 < self.limit_V <= FULL_SCALE_V):
            raise ModelError(
                f"gain_dB must be finite and limit_V above 0 to {FULL_SCALE_V}, "
                f"got {self.gain_dB} and {self.limit_V}"
            )
        if not (0 <= self.lead_s <= 0.01 and 0 <= self.tail_s <= 0.05):
            raise ModelError(
                f"lead_s must be 0 to 0.01 and tail_s 0 to 0.05, got {self.lead_s} and {self.tail_s}"
            )


@dataclass(frozen=True, eq=False)
class Drive:
    """Volts for a vibration, and what they can achieve by the known exciter.

    Attributes
    ----------
    volts : (n,) at rate_Hz, straight lines between, 0 before and after; positive moves the cap inward if the
        exciter's leads are so.
    lead_s : how much of it comes before the vibration.
    likeness : of the acceleration expected to the vibration: correlation at any delay.
    strength_ratio : of the expected acceleration along the vibration's shape to what was asked; below 1 where
        the limit of the volts or of the gain was met.
    """

    volts: FloatArray
    rate_Hz: float
    lead_s: float
    likeness: float
    strength_ratio: float


def drive_for(exciter: KnownExciter, vibration: Vibration, settings: InverseSettings | None = None) -> Drive:
    """Find the drive whose acceleration of the cap is nearest to a vibration.

    Least squares in time over what the board can play: min ‖H w - a‖² + λ ‖w‖², the Wiener inverse for a
    drive of finite length. No direction is boosted by more than 1 / 2√λ, which is set gain_dB above 1 / |H|
    at the vibration's strongest frequency. A drive beyond the limit is weakened, and bounded more tightly
    where that is nearer to the vibration. Raises ModelError if the board cannot play such a wave.
    """
    chosen = settings or InverseSettings()
    length_s = chosen.lead_s + vibration.duration_s + chosen.tail_s
    rate_Hz = min(WAVE_Hz, (WAVE_SAMPLES - 1) / length_s)
    fastest_Hz = max(mode.frequency_Hz for mode in vibration.modes)
    if fastest_Hz >= rate_Hz / 2:
        raise ModelError(
            f"a drive of {length_s:g} s holds frequencies below {rate_Hz / 2:g} Hz, got {fastest_Hz:g} Hz; "
            "shorten it or leave out that mode"
        )
    times_s = (np.arange(round((length_s + RING_s) * RATE_Hz)) + 0.5) / RATE_Hz
    wanted = vibration.acceleration_m_s2(times_s - chosen.lead_s)
    drives = _hats(int(length_s * rate_Hz) + 1, rate_Hz, wanted.size)
    moves = acceleration_m_s2(exciter, drives)
    volts = _nearest(drives, moves, wanted, exciter, chosen)
    rendered = moves @ volts
    power = float(wanted @ wanted)
    strength = float(rendered @ wanted) / power if power else 0.0
    return Drive(volts, rate_Hz, chosen.lead_s, correlation(rendered, wanted), strength)


def acceleration_m_s2(exciter: KnownExciter, volts: FloatArray) -> FloatArray:
    """Return the cap's acceleration for volts at 16 kHz, each column by itself; same shape, from rest."""
    count = volts.shape[0]
    size = 1 << int(np.ceil(np.log2(2 * count + RING_s * RATE_Hz)))
    response = exciter.response(np.fft.rfftfreq(size, 1 / RATE_Hz))
    # rows are faster to transform than columns
    acceleration: FloatArray = np.fft.irfft(np.fft.rfft(np.ascontiguousarray(volts.T), size) * response, size)
    return acceleration[..., :count].T


def _hats(count: int, rate_Hz: float, rows: int) -> FloatArray:
    """Return what each sample of a wave does to the board's output, as its columns."""
    places = (np.arange(rows) + 0.5) / RATE_Hz * rate_Hz
    return np.asarray(np.maximum(0.0, 1.0 - np.abs(places[:, None] - np.arange(count))))


def _nearest(
    drives: FloatArray, moves: FloatArray, wanted: FloatArray, exciter: KnownExciter, chosen: InverseSettings
) -> FloatArray:
    """Solve for the wave's samples: the tightest bound that is within 0.1 % of the nearest drive."""
    spectrum = np.abs(np.fft.rfft(wanted, 1 << 14))
    strongest_Hz = float(np.fft.rfftfreq(1 << 14, 1 / RATE_Hz)[np.argmax(spectrum)])
    bound = (abs(complex(exciter.response(strongest_Hz))) / (2 * 10 ** (chosen.gain_dB / 20))) ** 2
    power, size = moves.T @ moves, drives.T @ drives
    best: FloatArray = np.zeros(drives.shape[1])
    least = float(np.linalg.norm(wanted))
    margin = 1e-3 * least
    for step in STEPS:
        volts = np.asarray(np.linalg.solve(power + step * bound * size, moves.T @ wanted), dtype=np.float64)
        volts = volts * min(1.0, chosen.limit_V / max(float(np.abs(volts).max()), 1e-12))
        error = float(np.linalg.norm(moves @ volts - wanted))
        if error < least - margin:
            best, least = volts, error
    return best

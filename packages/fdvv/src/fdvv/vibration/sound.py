"""The ring of a key in a sound: where it begins, its damped modes, and how much of its energy these carry."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fdvv.errors import FitError
from fdvv.units import FloatArray
from fdvv.vibration.damped import DampedMode
from fdvv.vibration.events import bursts
from fdvv.vibration.modes import LEAST_FALL, drives, fit_modes
from fdvv.vibration.ring import LONGEST_s

LEAST_CARRIED = 0.5
"""Part of a ring's energy below which its modes are not what is heard, and no model of it."""

FELT_Hz = 1000.0
"""Above it fingers feel nothing."""

BEFORE_s, SEARCHED_s, PAST_s, FEWEST_SAMPLES = 0.004, 0.010, 0.0005, 4
"""About a burst's first sight its true onset is searched; that many samples at least make a variance."""

BEGINS_s = 0.010
"""A file without a burst whose loudest sample comes no later begins inside the sound: it was cut there."""


@dataclass(frozen=True)
class SoundRing:
    """What a ring is made of.

    Attributes
    ----------
    onset_s, end_s : from the start of the sound; it ends at the next burst, or after 25 ms.
    cut : the sound begins inside the ring, so that the onset is that of the file.
    modes : damped sinusoids from the onset on, in the sound's unit, by falling amplitude; terms that fade
        as a drive does, or not at all, are none.
    carried_ratio : part of the ring's energy that the modes explain, over the whole band of the sound.
    felt_ratio : part of its energy below 1 kHz.
    """

    onset_s: float
    end_s: float
    cut: bool
    modes: tuple[DampedMode, ...]
    carried_ratio: float
    felt_ratio: float


def sound_ring(sound: npt.ArrayLike, rate_Hz: float) -> SoundRing:
    """Split the loudest ring in the sound of one key press into damped modes.

    sound : (n,) in any unit. The onset is that of the loudest burst of `bursts`; where there is none, the
    file begins inside the sound. Raises FitError on silence and on a ring too short for one mode.
    """
    signal = np.asarray(sound, dtype=np.float64)
    signal = signal - np.mean(signal) if signal.size else signal
    if signal.size < 64 or not np.any(signal):
        raise FitError("it is silent, or shorter than 64 samples")
    rises = bursts(signal, rate_Hz)
    loudest = max(rises, key=lambda burst: burst.peak_power, default=None)
    onset_s = _onset_s(signal, rate_Hz, loudest.onset_s) if loudest else 0.0
    early = float(np.argmax(np.abs(signal))) / rate_Hz <= BEGINS_s
    if loudest is None and not early:
        raise FitError("no sudden sound in it: nothing rises 9 dB above what is before it")
    later = [b.onset_s for b in rises if loudest and b.onset_s > max(onset_s, loudest.onset_s)]
    end_s = min([*later, onset_s + LONGEST_s, signal.size / rate_Hz])
    ring = signal[round(onset_s * rate_Hz) : round(end_s * rate_Hz)]
    modes = tuple(m for m in fit_modes(ring, rate_Hz).modes if _rings(m, ring.size / rate_Hz))
    ratios = energy_ratio(ring, rate_Hz, modes), _below(ring, rate_Hz, FELT_Hz)
    return SoundRing(onset_s, end_s, loudest is None, modes, *ratios)


def _rings(mode: DampedMode, longest_s: float) -> bool:
    """Return whether a term is a mode: no fading drive, and no tone that does not decay within the ring."""
    return not drives(mode) and mode.decay_1_s * longest_s >= LEAST_FALL


def _onset_s(signal: FloatArray, rate_Hz: float, near_s: float) -> float:
    """Return where a burst begins, by the change of variance that Akaike's criterion likes best (Maeda 1985).

    The search ends just past the largest sample of the 10 ms from 4 ms before near_s on.
    """
    start = max(0, round((near_s - BEFORE_s) * rate_Hz))
    part = signal[start : start + round(SEARCHED_s * rate_Hz)]
    part = part[: int(np.argmax(np.abs(part))) + round(PAST_s * rate_Hz)]
    if part.size < 4 * FEWEST_SAMPLES:
        return near_s
    k = np.arange(FEWEST_SAMPLES, part.size - FEWEST_SAMPLES)
    sums = np.append(0.0, np.cumsum(part**2))
    before, after = sums[k] / k, (sums[-1] - sums[k]) / (part.size - k)
    least = 1e-12 * sums[-1] / part.size
    criterion = k * np.log(before + least) + (part.size - k) * np.log(after + least)
    return float(start + k[int(np.argmin(criterion))]) / rate_Hz


def energy_ratio(ring: FloatArray, rate_Hz: float, modes: Sequence[DampedMode]) -> float:
    """Return which part of a ring's energy its modes explain: 1 less the part that is left without them."""
    t = np.arange(ring.size) / rate_Hz
    made = np.zeros(ring.size)
    for m in modes:
        envelope = m.amplitude * np.exp(-m.decay_1_s * t)
        made += envelope * np.sin(2 * np.pi * m.frequency_Hz * t + m.phase_rad)
    return max(0.0, 1.0 - float(np.sum((ring - made) ** 2) / np.sum(ring**2)))


def _below(ring: FloatArray, rate_Hz: float, frequency_Hz: float) -> float:
    power = np.abs(np.fft.rfft(ring)) ** 2
    return float(power[np.fft.rfftfreq(ring.size, 1 / rate_Hz) < frequency_Hz].sum() / power.sum())

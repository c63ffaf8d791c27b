"""Read the vibration that a sound is: its damped modes."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fdvv.errors import FitError, InputError
from fdvv.formats.exchange.exchange_format import VibrationRead
from fdvv.io.files import read_limited
from fdvv.model.vibration import Mode
from fdvv.units import FloatArray
from fdvv.vibration.modes import fit_modes
from fdvv.vibration.sound import LEAST_CARRIED, energy_ratio
from fdvv.vibration.wave import read_wav

LARGEST_bytes = 20_000_000
ONSET_ratio = 0.02
"""A sound begins where it first passes this part of its peak: below lies what a converter adds."""
END_ratio = 0.002
"""It ends where it falls for good below this part."""
LONGEST_s = 1.0
MODES_Hz = 8000.0
"""Sounds are brought to this rate before modes are found: above 1 kHz fingers feel nothing."""


def wav_vibration(source: Path | bytes, full_scale_m_s2: float | None) -> VibrationRead:
    """Return the damped modes of a WAV file or its bytes.

    full_scale_m_s2 : what a full sample stands for. Raises InputError.
    """
    name = "sound" if isinstance(source, bytes) else source
    if full_scale_m_s2 is None:
        raise InputError(name, "samples", "a sound does not say what full scale is", "pass --full-scale-m-s2")
    data = source if isinstance(source, bytes) else _content(source)
    sound = read_wav(data)
    samples = sound.samples.astype(np.float64) / 32767 * full_scale_m_s2
    if not samples.size or not np.abs(samples).max():
        raise InputError(name, "samples", "it is silent", "give one that is not")
    first = int(np.argmax(np.abs(samples) > ONSET_ratio * np.abs(samples).max()))
    last = samples.size - int(np.argmax(np.abs(samples[::-1]) > END_ratio * np.abs(samples).max()))
    # the last sample before is the onset: what begins there has just left zero
    ring = samples[max(0, first - 1) : last]
    if ring.size > LONGEST_s * sound.rate_Hz:
        raise InputError(name, "samples", f"it rings for more than {LONGEST_s:g} s", "cut one snap out of it")
    return _modes(name, ring, sound.rate_Hz)


def _content(path: Path) -> bytes:
    return read_limited(path, LARGEST_bytes, "give a sound of a second or less")


def _modes(name: Path | str, ring: FloatArray, rate_Hz: int) -> VibrationRead:
    thin, thin_Hz = _thinned(ring, rate_Hz)
    try:
        fit = fit_modes(thin, thin_Hz)
    except FitError as error:
        raise InputError(name, "samples", str(error), "give a longer sound") from error
    if not fit.modes:
        raise InputError(name, "samples", "no damped mode in it", "give a snap's sound")
    part = energy_ratio(ring, rate_Hz, fit.modes)
    if part < LEAST_CARRIED:
        least = f"less than {100 * LEAST_CARRIED:.0f} %"
        reason = f"its damped modes carry {100 * part:.0f} % of its energy, {least}"
        raise InputError(name, "samples", reason, "give a cleaner sound of one snap; see fdvv vibration FILE")
    modes = tuple(Mode(m.frequency_Hz, m.amplitude, m.decay_1_s, m.phase_rad) for m in fit.modes)
    noise = f"{fit.noise:.3g} m/s2 of noise left per sample"
    note = f"{len(modes)} damped modes carry {100 * part:.0f} % of the energy, {noise}"
    return VibrationRead(modes, ring.size / rate_Hz, notes=(note,))


def _thinned(samples: FloatArray, rate_Hz: int) -> tuple[FloatArray, float]:
    from scipy.signal import resample_poly

    down = max(1, int(rate_Hz // MODES_Hz))
    # ends held would ring; the sound is silent before and after
    return (samples if down == 1 else np.asarray(resample_poly(samples, 1, down))), rate_Hz / down

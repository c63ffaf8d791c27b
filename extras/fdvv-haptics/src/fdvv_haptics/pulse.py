"""What haptic files hold of a vibration: how strong and how high it is over time, but not its phase.

AHAP and Meta's .haptic know two curves of 0 to 1, joined by straight lines: intensity (amplitude) and
sharpness (frequency). Neither maker says which frequency a sharpness is. The reference software of MPEG's
haptics coding reads Apple's 0 to 1 as 65 to 300 Hz, which is what is used here, both ways, and stated with
every file.
"""

from __future__ import annotations

import re
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from fdvv.errors import InputError, ModelError
from fdvv.model.vibration import Mode, Vibration
from fdvv.units import FloatArray
from fdvv_haptics.mjcf import polyline

SHARPNESS_Hz = (65.0, 300.0)
"""Frequencies of sharpness 0 and 1 (MPEGGroup/HapticReferenceSoftware, AhapEncoder.cpp)."""
TOLERANCE_ratio = 0.01
EXACT, AUDIBLE_ratio = 1e-3, 1e-4
PIECE = 16
"""Samples of a straight piece."""
FAINT_ratio = 1e-6
RATE_Hz = 8000.0
LONGEST_s = 30.0
"""An event of Core Haptics may last this long; the other formats are held to the same."""
LOST = ("phase, so the wave's own shape", "the place of the onset and the stroke")
"""What two curves of amplitude and frequency cannot hold."""
_SCALE = re.compile(r"\b1 is (\d[\d.e+-]*) m/s2")


@dataclass(frozen=True, eq=False)
class Pulse:
    """Amplitude and frequency of a vibration over time, joined by straight lines.

    Attributes
    ----------
    t_s : (n,) strictly rising from 0.
    amplitude_m_s2 : (n,) at least 0.
    frequency_Hz : (n,) positive.
    """

    t_s: FloatArray
    amplitude_m_s2: FloatArray
    frequency_Hz: FloatArray

    def __post_init__(self) -> None:
        if self.t_s.size < 2 or np.any(np.diff(self.t_s) <= 0):
            raise ModelError("a pulse needs at least 2 strictly rising times")
        if not np.isfinite(self.amplitude_m_s2).all() or np.any(self.amplitude_m_s2 < 0):
            raise ModelError("the amplitude of a pulse must be finite and at least 0")
        if not np.isfinite(self.frequency_Hz).all() or np.any(self.frequency_Hz <= 0):
            raise ModelError("the frequency of a pulse must be finite and positive")


def pulse_of(vibration: Vibration) -> Pulse:
    """Follow the envelope of all modes together: the size of their analytic sum, and its mean frequency.

    Beats between modes stay in the amplitude; the frequency at each time is the mean of the modes',
    weighted by their power.
    """
    t = np.arange(max(2, round(vibration.duration_s * RATE_Hz) + 1)) / RATE_Hz
    t = t * (vibration.duration_s / t[-1])
    total = np.zeros(t.size, dtype=np.complex128)
    power, weighted = np.zeros(t.size), np.zeros(t.size)
    for mode in vibration.modes:
        each = mode.amplitude_m_s2 * np.exp(-mode.decay_1_s * t)
        total += each * np.exp(1j * (2 * np.pi * mode.frequency_Hz * t + mode.phase_rad))
        power += each**2
        weighted += each**2 * mode.frequency_Hz
    amplitude = np.abs(total)
    mean_Hz = float(np.mean([mode.frequency_Hz for mode in vibration.modes]))
    # what has died away has no pitch; that of the last audible one holds
    audible = max(1, int(np.count_nonzero(power > FAINT_ratio**2 * power[0])))
    frequency = np.divide(weighted, power, out=np.full(t.size, mean_Hz), where=power > 0)
    frequency[audible:] = frequency[audible - 1]
    at = polyline(t, amplitude, TOLERANCE_ratio * (float(amplitude.max()) or 1.0))
    return Pulse(t[at], amplitude[at], frequency[at])


def mode_of(pulse: Pulse, phase_rad: float = 0.0) -> Mode:
    """Find the one damped mode nearest to a pulse: least squares of the amplitude, mean frequency by power.

    Where the corners lie on an exponential they are samples of one, and it is taken; between them a file can
    only draw straight lines. Raises ModelError if the pulse is silent.
    """
    between = np.linspace(pulse.t_s[:-1], pulse.t_s[1:], PIECE, endpoint=False).T.ravel()
    even = np.linspace(0.0, pulse.t_s[-1], 50)
    t = np.unique(np.concatenate([between, pulse.t_s, even]))
    amplitude = np.interp(t, pulse.t_s, pulse.amplitude_m_s2)
    power = float(np.trapezoid(amplitude**2, t))
    if not power:
        raise ModelError("the pulse is silent")
    pitch = np.interp(t, pulse.t_s, pulse.frequency_Hz)
    frequency = float(np.trapezoid(amplitude**2 * pitch, t)) / power
    strength, decay = _through_corners(pulse) or _nearest(t, amplitude)
    return Mode(frequency, strength, decay, phase_rad)


def _through_corners(pulse: Pulse) -> tuple[float, float] | None:
    """Return amplitude and decay of the exponential through all corners; None if there is none."""
    amplitude = pulse.amplitude_m_s2
    audible = amplitude > AUDIBLE_ratio * amplitude.max()
    if audible.sum() < 3:
        return None
    slope, start = np.polyfit(pulse.t_s[audible], np.log(amplitude[audible]), 1, w=amplitude[audible])
    off = np.abs(np.exp(start + slope * pulse.t_s) - amplitude)
    exact = slope <= 0 and off.max() < EXACT * amplitude.max()
    return (float(np.exp(start)), -float(slope)) if exact else None


def _nearest(t: FloatArray, amplitude: FloatArray) -> tuple[float, float]:
    from scipy.optimize import minimize_scalar

    weight = np.gradient(t)

    def strength(decay: float) -> float:
        shape = np.exp(-decay * t)
        return float(np.sum(weight * amplitude * shape) / np.sum(weight * shape**2))

    def off(log_decay: float) -> float:
        decay = float(np.exp(log_decay))
        return float(np.sum(weight * (amplitude - strength(decay) * np.exp(-decay * t)) ** 2))

    # from a fall that nobody notices to one within the shortest piece
    bounds = (np.log(1e-3 / t[-1]), np.log(10.0 / np.diff(t).min()))
    places = np.linspace(*bounds, 40)
    best = int(np.argmin([off(place) for place in places]))
    near = (places[max(best - 1, 0)], places[min(best + 1, places.size - 1)])
    decay = float(np.exp(minimize_scalar(off, bounds=near, method="bounded", options={"xatol": 1e-7}).x))
    return strength(decay), decay


def sharpness(frequency_Hz: FloatArray) -> FloatArray:
    """Turn frequencies into sharpness, 0 to 1; outside the range the ends hold."""
    low, high = SHARPNESS_Hz
    return np.clip((np.asarray(frequency_Hz) - low) / (high - low), 0.0, 1.0)


def frequency_Hz(of_sharpness: FloatArray) -> FloatArray:
    """Turn sharpness into frequencies; outside 0 to 1 the ends hold, as players do."""
    low, high = SHARPNESS_Hz
    return np.asarray(low + (high - low) * np.clip(of_sharpness, 0.0, 1.0))


@dataclass(frozen=True, eq=False)
class Curves:
    """A vibration as haptic files hold it.

    Attributes
    ----------
    t_s, intensity, sharpness : (n,) the two curves, 0 to 1.
    scale_m_s2 : the amplitude that intensity 1 means, the vibration's largest.
    lost : what the curves do not hold.
    """

    t_s: FloatArray
    intensity: FloatArray
    sharpness: FloatArray
    scale_m_s2: float
    lost: tuple[str, ...]

    @classmethod
    def of(cls, vibration: Vibration) -> Curves:
        """Draw the two curves of a vibration. Raises ModelError if it is silent."""
        pulse = pulse_of(vibration)
        largest = float(pulse.amplitude_m_s2.max())
        if not largest > 0:
            raise ModelError("the vibration is silent, there is nothing to write")
        low, high = SHARPNESS_Hz
        outside = [m.frequency_Hz for m in vibration.modes if not low <= m.frequency_Hz <= high]
        clipped = [f"{f:.0f} Hz lies outside {low:g} to {high:g} Hz and is held at its end" for f in outside]
        pitch = sharpness(pulse.frequency_Hz)
        return cls(pulse.t_s, pulse.amplitude_m_s2 / largest, pitch, largest, (*LOST, *clipped))

    @property
    def description(self) -> str:
        """State the scales, so that the file can be read back."""
        low, high = SHARPNESS_Hz
        return f"1 is {self.scale_m_s2!r} m/s2 of the cap; 0 to 1 of sharpness is {low:g} to {high:g} Hz"


def read_scale(description: object, name: str, place: str) -> float:
    """Read the amplitude scale from a file's description. InputError if it states none."""
    found = _SCALE.search(description) if isinstance(description, str) else None
    with suppress(ValueError):
        value = float(found[1]) if found else 0.0
        if np.isfinite(value) and value > 0:
            return value
    raise InputError(name, place, "the file does not say what 1 stands for", "give the full scale in m/s2")

"""The exciter identified from tones: volts to acceleration of the cap, a resonance of second order."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import numpy.typing as npt

from fdvv.errors import FitError, ModelError
from fdvv.io.documents import Kind, document, pretty, read_record
from fdvv.io.files import write_atomic
from fdvv.units import FloatArray

DRIFT = 3
"""The rest is a parabola: the cap creeps a little while it hums."""
LEAST = 20
"""Samples beyond what the fit takes, without which nothing can be said of its error."""
FULL_SCALE_V = 2.5
"""Volts of the amplifier at full scale of the vibration board's converter; all volts here count by it."""
LIMIT_V = 2.43
"""The largest amplitude that the paper plays."""
FITTED = ("gain_m_s2_V", "resonance_Hz", "quality", "lag_s", "grip_Hz")
USUAL = {"gain_m_s2_V": 20.0, "resonance_Hz": 600.0, "quality": 2.0, "lag_s": 6e-4, "grip_Hz": 80.0}
SPREAD = {"gain_m_s2_V": 3.0, "resonance_Hz": 0.3, "quality": 0.5, "lag_s": 0.5, "grip_Hz": 0.5}
"""What is known before: middles, and standard deviations of the logarithms; the gain is as good as free."""
MODEL_ratio = 0.03
"""By how much the second order itself is taken to be wrong."""
FEWEST = 6
EXCITER_SUFFIX = ".exciter.json"
"""How the name of a known exciter's file ends."""
LIMIT_bytes = 100_000  # assumed; such a file has 400 bytes (tests/files/old)
_REMEDY = "identify the exciter again"
_KIND = Kind("fdvv-exciter", 1, "a known exciter", _REMEDY)


@dataclass(frozen=True)
class Tone:
    """How strongly a sensor answered to one frequency.

    Attributes
    ----------
    frequency_Hz : that was played; it may lie above half the sensor's rate.
    amplitude : of the sine that fits best, in the sensor's unit.
    error : standard error of each of its two parts.
    """

    frequency_Hz: float
    amplitude: float
    error: float


def measure_tone(t_s: FloatArray, samples: FloatArray, frequency_Hz: float) -> Tone:
    """Fit a sine of known frequency and a slow drift by least squares.

    t_s, samples : (n,) in any steps. The frequency need not lie below half the rate: it is known, so its
    alias gives its size, if nothing else sounds there. Raises FitError on too few samples, or at a frequency
    that the sampling cannot separate from drift (multiples of the rate) or one phase (half of the rate).
    """
    free = t_s.size - 2 - DRIFT
    if free < LEAST:
        raise FitError(f"a tone needs {LEAST + 2 + DRIFT} samples, got {t_s.size}")
    turns = 2 * np.pi * frequency_Hz * t_s
    middle = (t_s - t_s.mean()) / np.ptp(t_s)
    columns = np.column_stack([np.cos(turns), np.sin(turns), *(middle**n for n in range(DRIFT))])
    solved, _, _, sizes = np.linalg.lstsq(columns, samples)
    if sizes[-1] < 0.02 * sizes[0]:
        raise FitError(f"{frequency_Hz:g} Hz cannot be measured at this rate; play another frequency")
    rest = samples - columns @ solved
    error = float(np.sqrt(np.sum(rest**2) / free * 2 / t_s.size))
    return Tone(frequency_Hz, float(np.hypot(solved[0], solved[1])), error)


def clock_ratio(
    records: Sequence[tuple[FloatArray, FloatArray]], frequency_Hz: Sequence[float], most: float = 0.01
) -> float:
    """Return how much faster than nominal the tones sound: the player's clock over the sensor's.

    records : times (s) and samples of each tone. A ceramic resonator is off by half a percent, enough to lose
    a tone of seconds. The ratio within 1 ± most at which all tones together are strongest, to an eighth of a
    turn over the longest.
    """
    pairs = list(zip(records, frequency_Hz, strict=True))
    turns = max(float(np.ptp(t)) * f for (t, _), f in pairs)
    count = int(np.ceil(8 * turns * most))
    ratios = 1 + most * np.arange(-count, count + 1) / max(count, 1)
    power = np.zeros(ratios.size)
    for (t_s, samples), f in pairs:
        middle = (t_s - t_s.mean()) / np.ptp(t_s)
        drift = np.polynomial.polynomial.polyfit(middle, samples, DRIFT - 1)
        rest = samples - np.polynomial.polynomial.polyval(middle, drift)
        power += [abs(np.sum(rest * np.exp(-2j * np.pi * f * ratio * t_s))) ** 2 for ratio in ratios]
    return float(ratios[np.argmax(power)])


def clear_frequencies_Hz(wanted_Hz: FloatArray, rate_Hz: float, apart_Hz: float) -> FloatArray:
    """Return those of wanted_Hz whose alias at rate_Hz lies apart_Hz or more from 0 and from half the rate.

    Near 0 the rig's own loop follows the alias and adds to it; near half the rate one phase alone is seen.
    """
    alias_Hz = np.abs(wanted_Hz - rate_Hz * np.round(wanted_Hz / rate_Hz))
    return wanted_Hz[(alias_Hz >= apart_Hz) & (np.abs(alias_Hz - rate_Hz / 2) >= apart_Hz / 5)]


@dataclass(frozen=True)
class KnownExciter:
    """An exciter on its cap.

    Volts to the cap's acceleration is g s² / (s² + s ω/Q + ω²): the free cap and the magnet, a spring between
    them (docs/explanation/vibration-rendering.md). Magnitudes do not give the sign.

    Attributes
    ----------
    gain_m_s2_V : g, far above the resonance; motor constant over resistance and mass of the cap's side.
    resonance_Hz, quality : ω / 2π and Q of cap against magnet; above that of the held exciter.
    latency_s : from a command to the first sample, as the rig's settings had it; None if unknown.
    error : standard errors of the logarithms, by the names of the numbers.
    residual_ratio : rms of measured over fitted tones less 1.
    tones : number of tones fitted; 0 if the numbers were written by hand.
    simulated : they came from the twin.
    """

    gain_m_s2_V: float
    resonance_Hz: float
    quality: float
    latency_s: float | None = None
    error: Mapping[str, float] = field(default_factory=dict)
    residual_ratio: float = 0.0
    tones: int = 0
    simulated: bool = False

    def __post_init__(self) -> None:
        for name in ("gain_m_s2_V", "resonance_Hz", "quality"):
            if not (np.isfinite(getattr(self, name)) and getattr(self, name) > 0):
                raise ModelError(f"{name} must be positive, got {getattr(self, name)}")
        if self.latency_s is not None and not 0 <= self.latency_s < 1:
            raise ModelError(f"latency_s must be 0 to 1, got {self.latency_s}")
        object.__setattr__(self, "error", dict(self.error))

    def response(self, frequency_Hz: npt.ArrayLike) -> npt.NDArray[np.complex128]:
        """Return acceleration per volt (m/s²/V) at frequencies of any shape."""
        s = 2j * np.pi * np.asarray(frequency_Hz, dtype=np.float64)
        omega = 2 * np.pi * self.resonance_Hz
        below = s**2 + s * omega / self.quality + omega**2
        return np.asarray(self.gain_m_s2_V * s**2 / below, dtype=np.complex128)

    @property
    def counts_per_m_s2(self) -> float:
        """Return converter counts per m/s² far above the resonance."""
        return 2048 / FULL_SCALE_V / self.gain_m_s2_V


@dataclass(frozen=True)
class ToneBench:
    """How tones were made and seen.

    Attributes
    ----------
    drive_V : amplitude of each.
    lag_s, lag_ratio : time constant of the position sensor, and the standard deviation of its logarithm;
        the default is a guess over 100 to 500 Hz that leaves the gain as unsure. A known rig is better.
    burst_s : over which reads are averaged.
    """

    drive_V: float
    lag_s: float = USUAL["lag_s"]
    lag_ratio: float = SPREAD["lag_s"]
    burst_s: float = 0.0


def fit_exciter(
    tones: Sequence[Tone], bench: ToneBench, latency_s: float | None = None, simulated: bool = False
) -> KnownExciter:
    """Fit the resonance to how far (m) the cap moved at each tone, with standard errors.

    The cap is held by a soft spring without a finger. At rest its bushing grips: below about 300 Hz it moves
    more than a free one, by 1 / (1 - (f_grip / f)²), which is fitted along. Least squares on the amplitudes,
    weighed by their errors; priors (USUAL, SPREAD) keep what tones cannot determine. Raises FitError on fewer
    than six tones, or on tones that rise from no noise.
    """
    from scipy.optimize import least_squares

    if len(tones) < FEWEST:
        raise FitError(f"an exciter needs {FEWEST} tones, got {len(tones)}")
    heard = sum(tone.amplitude > 4 * tone.error for tone in tones)
    if heard < FEWEST:
        raise FitError(
            f"{heard} of {len(tones)} tones rise above the noise, {FEWEST} are needed; play longer"
        )
    before = np.log([{**USUAL, "lag_s": bench.lag_s}[name] for name in FITTED])
    spread = np.array([{**SPREAD, "lag_s": bench.lag_ratio}[name] for name in FITTED])
    # without what noise adds to an amplitude (Rice)
    clean_m = [float(np.sqrt(max(t.amplitude**2 - 2 * t.error**2, t.error**2))) for t in tones]
    frequency_Hz, moved_m = np.array([t.frequency_Hz for t in tones]), np.array(clean_m)
    error_m = np.hypot([t.error for t in tones], MODEL_ratio * moved_m)

    def rest(logs: FloatArray) -> FloatArray:
        off = (_tone_amplitude_m(np.exp(logs), frequency_Hz, bench) - moved_m) / error_m
        return np.concatenate([off, (logs - before) / spread])

    # a grip near the lowest tone would make it a pole
    most = np.log([1e4, 2000.0, 50.0, 0.02, 0.8 * frequency_Hz.min()])
    least = np.log([1e-2, 100.0, 0.3, 1e-6, 1.0])
    fit = least_squares(rest, np.minimum(before, most - 0.1), bounds=(least, most))
    slope = np.asarray(fit.jac, dtype=np.float64)
    errors = np.sqrt(np.diag(np.linalg.inv(slope.T @ slope)))
    numbers = np.exp(fit.x)
    ratio = moved_m / _tone_amplitude_m(numbers, frequency_Hz, bench) - 1
    named = {name: float(e) for name, e in zip(FITTED[:3], errors, strict=False)}
    residual_ratio = float(np.sqrt(np.mean(ratio**2)))
    gain, resonance, quality = numbers[:3].tolist()
    return KnownExciter(gain, resonance, quality, latency_s, named, residual_ratio, len(tones), simulated)


def _tone_amplitude_m(numbers: FloatArray, frequency_Hz: FloatArray, bench: ToneBench) -> FloatArray:
    gain, resonance, quality, lag_s, grip_Hz = numbers
    response = np.abs(KnownExciter(gain, resonance, quality).response(frequency_Hz))
    gripped = response / (1 - (grip_Hz / frequency_Hz) ** 2)
    turn = 2 * np.pi * frequency_Hz
    seen = np.sinc(frequency_Hz * bench.burst_s) / np.hypot(1.0, turn * lag_s)
    return np.asarray(bench.drive_V * gripped / turn**2 * seen)


def save_exciter(exciter: KnownExciter, path: Path | str) -> None:
    """Write a known exciter to an ``*.exciter.json`` file, whole or not at all. Raises OSError."""
    write_atomic(Path(path), pretty(document(exciter, _KIND)) + "\n")


def load_exciter(path: Path | str) -> KnownExciter:
    """Read an ``*.exciter.json`` file. InputError names the place in it and the remedy."""
    return read_record(Path(path), _KIND, KnownExciter, LIMIT_bytes)

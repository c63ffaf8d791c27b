"""The exciter as its tones tell it: volts to acceleration of the cap, a resonance of second order."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from fdvv.errors import FitError, ModelError
from fdvv.units import FloatArray
from fdvv.vibration._tone import Tone

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


@dataclass(frozen=True)
class KnownExciter:
    """An exciter on its cap.

    Volts to the cap's acceleration is g s² / (s² + s ω/Q + ω²): the free cap and the magnet, a spring between
    them (docs/explanation/vibration-rendering.md). Magnitudes do not tell the sign.

    Attributes
    ----------
    gain_m_s2_V : g, far above the resonance; motor constant over resistance and mass of the cap's side.
    resonance_Hz, quality : ω / 2π and Q of cap against magnet; above that of the held exciter.
    latency_s : from a command to the first sample, as the rig's settings had it; None if unknown.
    error : standard errors of the logarithms, by the names of the numbers.
    residual_ratio : rms of measured over fitted tones less 1.
    tones : how many told it; 0 of one that was written down.
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
        """Give acceleration per volt (m/s²/V) at frequencies of any shape."""
        s = 2j * np.pi * np.asarray(frequency_Hz, dtype=np.float64)
        omega = 2 * np.pi * self.resonance_Hz
        below = s**2 + s * omega / self.quality + omega**2
        return np.asarray(self.gain_m_s2_V * s**2 / below, dtype=np.complex128)

    @property
    def counts_per_m_s2(self) -> float:
        """Give converter counts per m/s² far above the resonance."""
        return 2048 / FULL_SCALE_V / self.gain_m_s2_V


@dataclass(frozen=True)
class ToneBench:
    """How tones were made and seen.

    Attributes
    ----------
    drive_V : amplitude of each.
    lag_s, lag_ratio : time constant of the position sensor, and the standard deviation of its logarithm;
        the default is a guess over 100 to 500 Hz that leaves the gain as unsure. A known rig tells better.
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
    weighed by their errors; priors (USUAL, SPREAD) keep what tones cannot tell. Raises FitError on fewer than
    six tones, or on tones that rise from no noise.
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
    frequency_Hz, moved_m, error_m = (np.array(column) for column in zip(*_unbiased(tones), strict=True))

    def rest(logs: FloatArray) -> FloatArray:
        off = (_moved_m(np.exp(logs), frequency_Hz, bench) - moved_m) / error_m
        return np.concatenate([off, (logs - before) / spread])

    # a grip near the lowest tone would make it a pole
    most = np.log([1e4, 2000.0, 50.0, 0.02, 0.8 * frequency_Hz.min()])
    least = np.log([1e-2, 100.0, 0.3, 1e-6, 1.0])
    found = least_squares(rest, np.minimum(before, most - 0.1), bounds=(least, most))
    slope = np.asarray(found.jac, dtype=np.float64)
    errors = np.sqrt(np.diag(np.linalg.inv(slope.T @ slope)))
    numbers = np.exp(found.x)
    ratio = moved_m / _moved_m(numbers, frequency_Hz, bench) - 1
    return KnownExciter(
        float(numbers[0]),
        float(numbers[1]),
        float(numbers[2]),
        latency_s=latency_s,
        error={name: float(e) for name, e in zip(FITTED[:3], errors, strict=False)},
        residual_ratio=float(np.sqrt(np.mean(ratio**2))),
        tones=len(tones),
        simulated=simulated,
    )


def _unbiased(tones: Sequence[Tone]) -> list[tuple[float, float, float]]:
    """Give frequency, amplitude without what noise adds to it (Rice), and its error with the model's."""
    clean = [np.sqrt(max(t.amplitude**2 - 2 * t.error**2, t.error**2)) for t in tones]
    return [
        (t.frequency_Hz, float(a), float(np.hypot(t.error, MODEL_ratio * a)))
        for t, a in zip(tones, clean, strict=True)
    ]


def _moved_m(numbers: FloatArray, frequency_Hz: FloatArray, bench: ToneBench) -> FloatArray:
    """Give how far the position sensor says that the cap moves."""
    gain, resonance, quality, lag_s, grip_Hz = numbers
    response = np.abs(KnownExciter(gain, resonance, quality).response(frequency_Hz))
    gripped = response / (1 - (grip_Hz / frequency_Hz) ** 2)
    turn = 2 * np.pi * frequency_Hz
    seen = np.sinc(frequency_Hz * bench.burst_s) / np.hypot(1.0, turn * lag_s)
    moved: FloatArray = bench.drive_V * gripped / turn**2 * seen
    return moved

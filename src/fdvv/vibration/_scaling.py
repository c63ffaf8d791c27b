"""How the amplitude of a snap grows with velocity and with the energy that drives it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.errors import FitError
from fdvv.units import FloatArray

REFERENCE_mm_s = 100.0
USUAL_EXPONENT = 1.0
"""Amplitude in proportion to the velocity of the impact (Fiene and Kuchenbecker 2007)."""


@dataclass(frozen=True)
class Scaling:
    """Amplitude = amplitude_at_100 (v / 100 mm/s)^exponent (E / energy_mJ)^(1/2).

    Attributes
    ----------
    amplitude_at_100 : at 100 mm/s and energy_mJ, in the unit of what was fitted.
    exponent, exponent_sd : and its standard error; infinite where the exponent was assumed, not measured.
    log_sd : spread of the measured amplitudes about the law, as a natural logarithm; 0 for one amplitude.
    energy_mJ : geometric mean of the energies; None if none were given and the last factor is 1.
    velocities_mm_s : at which amplitudes were measured.
    """

    amplitude_at_100: float
    exponent: float
    exponent_sd: float
    log_sd: float
    energy_mJ: float | None
    velocities_mm_s: tuple[float, ...]

    def amplitude(self, velocity_mm_s: float, energy_mJ: float | None = None) -> float:
        """Predict the amplitude at a velocity, and at an energy if the law has one."""
        drive = 1.0 if self.energy_mJ is None or energy_mJ is None else math.sqrt(energy_mJ / self.energy_mJ)
        return float(self.amplitude_at_100 * (velocity_mm_s / REFERENCE_mm_s) ** self.exponent * drive)

    def remark(self, velocity_mm_s: float) -> str:
        """Say where an amplitude at a velocity comes from: measured there, between, or beyond what was."""
        if any(math.isclose(velocity_mm_s, v, rel_tol=1e-6) for v in self.velocities_mm_s):
            return f"measured at {velocity_mm_s:g} mm/s"
        low, high = min(self.velocities_mm_s), max(self.velocities_mm_s)
        where = "interpolated" if low < velocity_mm_s < high else "extrapolated"
        known = "an assumed" if math.isinf(self.exponent_sd) else "the measured"
        return (
            f"{where} to {velocity_mm_s:g} mm/s by {known} exponent of {self.exponent:.2f}: "
            "no snap was found there"
        )


def fit_scaling(
    velocity_mm_s: Sequence[float], amplitude: Sequence[float], energy_mJ: Sequence[float] | None = None
) -> Scaling:
    """Fit the power law of amplitude over velocity, by least squares of logarithms.

    velocity_mm_s, amplitude : one each per velocity at which the snap was found.
    energy_mJ : of the fall of force at each; a vibration's energy goes with the square of its amplitude, so
        its exponent is a half and is not fitted.

    With fewer than two velocities the exponent is 1, assumed, and its standard error infinite. Raises
    FitError if there is nothing to fit.
    """
    v, a = np.asarray(velocity_mm_s, dtype=np.float64), np.asarray(amplitude, dtype=np.float64)
    if v.size == 0 or v.shape != a.shape or np.any(v <= 0) or np.any(a <= 0):
        raise FitError(
            f"a scaling needs amplitudes above 0, one per velocity, got {a.tolist()} at {v.tolist()}"
        )
    energy = None if energy_mJ is None else np.asarray(energy_mJ, dtype=np.float64)
    if energy is not None and (energy.shape != v.shape or np.any(energy <= 0)):
        raise FitError(f"a scaling needs energies above 0, one per velocity, got {energy.tolist()}")
    mean = None if energy is None else float(np.exp(np.mean(np.log(energy))))
    x, y = np.log(v / REFERENCE_mm_s), np.log(a)
    if energy is not None and mean is not None:
        y = y - 0.5 * np.log(energy / mean)
    exponent, sd, log_sd = _slope(x, y)
    level = math.exp(float(np.mean(y - exponent * x)))
    return Scaling(level, exponent, sd, log_sd, mean, tuple(float(u) for u in v))


def _slope(x: FloatArray, y: FloatArray) -> tuple[float, float, float]:
    """Give the exponent, its standard error and the spread about the law."""
    across = float(np.sum((x - x.mean()) ** 2))
    if across < 1e-12:
        return USUAL_EXPONENT, math.inf, float(np.std(y))
    slope = float(np.sum((x - x.mean()) * (y - y.mean())) / across)
    left = y - y.mean() - slope * (x - x.mean())
    if x.size < 3:
        return slope, math.inf, 0.0
    spread = math.sqrt(float(left @ left) / (x.size - 2))
    return slope, spread / math.sqrt(across), spread

"""The vibration of a snap: damped modes that start at one displacement of one stroke."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
import numpy.typing as npt
from msgspec import Meta

from fdvv.errors import ModelError
from fdvv.model.bspline import check_velocity
from fdvv.model.curve import Stroke
from fdvv.model.spread import VibrationSpread
from fdvv.units import FloatArray


@dataclass(frozen=True)
class Mode:
    """One decaying sinusoid, A exp(-d t) sin(2 pi f t + phase) (Okamura; Park et al., as the paper uses).

    Attributes
    ----------
    frequency_Hz : positive.
    amplitude_m_s2 : acceleration of the cap at the onset.
    decay_1_s : d, zero or positive.
    phase_rad : phase at the onset.
    """

    frequency_Hz: Annotated[float, Meta(gt=0)]
    amplitude_m_s2: float
    decay_1_s: Annotated[float, Meta(ge=0)]
    phase_rad: float = 0.0

    def __post_init__(self) -> None:
        numbers = (self.frequency_Hz, self.amplitude_m_s2, self.decay_1_s, self.phase_rad)
        if not all(np.isfinite(numbers)) or self.frequency_Hz <= 0 or self.decay_1_s < 0:
            raise ModelError(f"a mode needs a positive frequency and a decay of at least 0, got {self}")


@dataclass(frozen=True)
class Vibration:
    """The vibration of one stroke at one velocity.

    Attributes
    ----------
    stroke : press or release.
    velocity_mm_s : the speed it was found at; None if it serves every speed.
    onset_mm : displacement at which it starts.
    duration_s : length; the signal is zero after it.
    modes : the damped modes that add up to it.
    spread : how it differs between presses; None if that was not measured.
    """

    stroke: Stroke
    velocity_mm_s: Annotated[float, Meta(gt=0)] | None
    onset_mm: float
    duration_s: Annotated[float, Meta(gt=0)]
    modes: Annotated[tuple[Mode, ...], Meta(min_length=1)]
    spread: VibrationSpread | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "stroke", Stroke(self.stroke))
        object.__setattr__(self, "modes", tuple(self.modes))
        check_velocity(self.velocity_mm_s)
        if not np.isfinite(self.onset_mm):
            raise ModelError(f"onset_mm must be finite, got {self.onset_mm}")
        if not (np.isfinite(self.duration_s) and self.duration_s > 0):
            raise ModelError(f"duration_s must be positive, got {self.duration_s}")
        if not self.modes:
            raise ModelError("a vibration needs at least one mode")
        spreads = len(self.spread.modes) if self.spread else 0
        if spreads and spreads != len(self.modes):
            raise ModelError(f"the spread tells of {spreads} modes, the vibration has {len(self.modes)}")

    def acceleration_m_s2(self, t_s: npt.ArrayLike) -> FloatArray:
        """Evaluate the cap's acceleration at times after the onset, in the shape of t_s."""
        t = np.asarray(t_s, dtype=np.float64)
        total = np.zeros_like(t)
        for mode in self.modes:
            envelope = mode.amplitude_m_s2 * np.exp(-mode.decay_1_s * np.maximum(t, 0.0))
            total += envelope * np.sin(2 * np.pi * mode.frequency_Hz * t + mode.phase_rad)
        return np.where((t >= 0) & (t <= self.duration_s), total, 0.0)

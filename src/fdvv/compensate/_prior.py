"""What is known of a rig before it is pressed: data sheets, and where rigs of this class usually lie."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from fdvv.compensate._balance import NUMBERS, Sensor
from fdvv.errors import ModelError
from fdvv.units import FloatArray


@dataclass(frozen=True)
class Plausible:
    """What is believed of a number before any press: mean and spread; and between which ends it is held."""

    mean: float
    spread: float
    low: float = -np.inf
    high: float = np.inf

    def __post_init__(self) -> None:
        if not (self.spread > 0 and self.low <= self.mean <= self.high):
            raise ModelError(f"a plausible number needs a spread and a mean between its ends, got {self}")


RANGES: Mapping[str, Plausible] = {
    "gain_0": Plausible(0.9, 0.15, 0.2, 3.0),
    "gain_1": Plausible(0.07, 0.06),
    "gain_2": Plausible(-0.011, 0.012),
    "viscous_N_s_m": Plausible(0.5, 0.3, 0.0),
    "back_emf_N_s_m": Plausible(3.0, 4.0),
    "friction_cN": Plausible(4.0, 3.0, 0.0),
    "weight_cN": Plausible(20.0, 20.0),
    "mass_g": Plausible(22.0, 8.0, 1.0),
    "half_play_cN": Plausible(1.5, 1.0, 0.0, 5.0),
    "position_lag_s": Plausible(9e-4, 4e-4, 5e-5, 4e-3),
    "electric_lag_s": Plausible(5e-4, 4e-4, 2e-5, 4e-3),
}
"""Voice coils of a few newtons with their transformers and bushings; spreads cover the class."""


@dataclass(frozen=True)
class Prior:
    """What is known of a rig before it is pressed.

    Attributes
    ----------
    tick_s : period of its loop; as the record's ticks tell it if None.
    sensor : the finger's force sensor.
    compute_ratio, compute_spread_ratio : from sample to drive, in ticks; half a tick of holding comes on top.
    ranges : of the other numbers, by their names in RANGES; those that are missing are as there.
    """

    tick_s: float | None = None
    sensor: Sensor = field(default_factory=Sensor)
    compute_ratio: float = 0.4
    compute_spread_ratio: float = 0.2
    ranges: Mapping[str, Plausible] = field(default_factory=dict)

    def __post_init__(self) -> None:
        unknown = set(self.ranges) - set(RANGES)
        if unknown:
            raise ModelError(
                f"no number of a rig is called {', '.join(sorted(unknown))}; known are {', '.join(RANGES)}"
            )
        if not (0 <= self.compute_ratio <= 1 and self.compute_spread_ratio > 0):
            raise ModelError(f"computing lasts 0 to 1 tick with a spread, got {self.compute_ratio}")

    def vectors(self, tick_s: float) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Give means, spreads, lowest and highest of all numbers, in the order of NUMBERS."""
        delay = Plausible(
            (0.5 + self.compute_ratio) * tick_s,
            self.compute_spread_ratio * tick_s,
            0.5 * tick_s,
            1.5 * tick_s,
        )
        told = {**RANGES, **self.ranges, "command_delay_s": delay}
        rows = np.array([(p.mean, p.spread, p.low, p.high) for p in (told[name] for name in NUMBERS)])
        return rows[:, 0], rows[:, 1], rows[:, 2], rows[:, 3]

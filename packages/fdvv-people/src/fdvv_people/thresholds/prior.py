"""The belief about an observer before the first trial."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.model.noticeable import DIMENSIONS
from fdvv.units import FloatArray
from fdvv_people.thresholds.observer import EXPONENT, JND, LAPSE, PARAMETERS, SUMMATION


@dataclass(frozen=True)
class ThresholdPrior:
    """Independent normal beliefs about the parameters of `observer`, but for the exponents.

    Attributes
    ----------
    jnd_ratio : middle of the JND of force, snap and vibration. Of force 7 to 15 % are reported at 0.3 to
        10 N, of vibration 20 to 58 %, more near the faintest; a sudden change of 10 cN is noticed on
        push-buttons, half of a fall of 20 cN (fdvv.model.noticeable). Assumed, within that.
    jnd_spread : of their natural logarithm. 0.7: within a factor of 4 either way, 95 %.
    exponent, exponent_spread : middle and spread, of the logarithm, of the exponents. Assumed, about d' in
        proportion. exponent_correlation : between them.
    summation, summation_spread : middle of the exponent m by which differences add up, and the spread of
        ln (m - 1). 2: squares add up, as fdvv_people.study.simulation takes it. Assumed.
    lapse_ratio, lapse_spread : middle part of lapses, and the spread of its logit: 0.4 to 18 %, 95 %
        (Wichmann and Hill 2001 find 0 to 5 %).

    ModelError on what is no distribution.
    """

    jnd_ratio: tuple[float, float, float] = (0.12, 0.5, 0.4)
    jnd_spread: float = 0.7
    exponent: float = 1.0
    exponent_spread: float = 0.2
    exponent_correlation: float = 0.75
    summation: float = 2.0
    summation_spread: float = 0.7
    lapse_ratio: float = 0.03
    lapse_spread: float = 1.0

    def __post_init__(self) -> None:
        spreads = (self.jnd_spread, self.exponent_spread, self.summation_spread, self.lapse_spread)
        sizes = (*self.jnd_ratio, *spreads, self.exponent, self.summation - 1.0, self.lapse_ratio)
        if not all(0 < one < math.inf for one in sizes) or len(self.jnd_ratio) != len(DIMENSIONS):
            raise ModelError(f"no observer can be expected like that: {self}")
        if self.lapse_ratio >= 1 or not 0 <= self.exponent_correlation < 1:
            raise ModelError(f"no observer can be expected like that: {self}")

    @property
    def mean(self) -> FloatArray:
        """Of the parameters, (PARAMETERS,)."""
        found = np.empty(PARAMETERS)
        found[JND] = np.log(self.jnd_ratio)
        found[EXPONENT] = math.log(self.exponent)
        found[SUMMATION] = math.log(self.summation - 1.0)
        found[LAPSE] = math.log(self.lapse_ratio / (1.0 - self.lapse_ratio))
        return found

    @property
    def covariance(self) -> FloatArray:
        """Of the parameters, (PARAMETERS, PARAMETERS)."""
        found = np.zeros((PARAMETERS, PARAMETERS))
        own = np.eye(len(DIMENSIONS))
        shared = self.exponent_correlation
        found[JND, JND] = self.jnd_spread**2 * own
        found[EXPONENT, EXPONENT] = self.exponent_spread**2 * (shared + (1.0 - shared) * own)
        found[SUMMATION, SUMMATION] = self.summation_spread**2
        found[LAPSE, LAPSE] = self.lapse_spread**2
        return found

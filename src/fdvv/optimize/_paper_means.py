"""What the paper found of temporal pointing, and the mean of an absolute value."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from fdvv.units import FloatArray

PAPER_BUTTONS = ("optimal", "clear", "brown", "black", "red", "random")
"""Buttons of the paper's validation, in the order of its table."""
PAPER_MEANS_ms: Mapping[str, tuple[float, ...]] = MappingProxyType(
    {
        "easy": (65.8, 83.6, 88.04, 81.65, 84.28, 100.78),
        "hard": (77.3, 93.43, 97.48, 96.9, 96.65, 108.22),
    }
)
"""Mean asynchrony of PAPER_BUTTONS: 10 people, 2 rounds of 20 presses (CHI 2020)."""
PAPER_SPREADS_ms: Mapping[str, tuple[float, ...]] = MappingProxyType(
    {
        "easy": (6.15, 7.65, 7.82, 6.19, 6.75, 6.89),
        "hard": (6.89, 7.56, 7.69, 7.61, 6.36, 8.77),
    }
)
"""The paper's STD of each; of what, it does not say."""


def folded_normal_mean(mean: npt.ArrayLike, spread: npt.ArrayLike) -> FloatArray:
    """Give the mean of |x| for normal x; both broadcast, spread above 0 (Leone et al. 1961)."""
    from scipy.special import erf

    mu, sigma = np.asarray(mean, float), np.asarray(spread, float)
    around = sigma * math.sqrt(2 / math.pi) * np.exp(-0.5 * (mu / sigma) ** 2)
    return np.asarray(around + mu * erf(mu / (sigma * math.sqrt(2))))

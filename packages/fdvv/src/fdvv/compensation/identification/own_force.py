"""The rig's own force over displacement: values at even steps, linear between them, and its prior."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from fdvv.units import FloatArray

NODES = 17
"""Values over the travel, from 0 to the stop."""
LONG_mm, SHORT_mm = 1.6, 0.35
"""Correlation lengths of the prior: springs and cables; detents and bearings."""
LONG_cN, SHORT_cN = (0.05, 1.0, 4.0, 15.0, 50.0), (0.05, 0.5, 1.5, 5.0)
"""Spreads of both parts that are tried; the first ones stand for no such force."""


def hats(displacement_mm: FloatArray, step_mm: float) -> FloatArray:
    """Return the weights of the values at even steps, (n, NODES); held beyond both ends."""
    at = np.clip(displacement_mm / step_mm, 0.0, NODES - 1.0)
    return np.maximum(0.0, 1.0 - np.abs(at[:, np.newaxis] - np.arange(NODES)))


@lru_cache(maxsize=64)
def prior_root(step_mm: float, long_cN: float, short_cN: float, spring_cN_mm: float = 0.0) -> FloatArray:
    """Return a root of the prior covariance of the values, (NODES, NODES): two Gaussian processes.

    spring_cN_mm : spread of a spring's stiffness beside them.
    """
    apart = step_mm * np.subtract.outer(np.arange(NODES), np.arange(NODES))
    covariance = sum(
        spread**2 * np.exp(-0.5 * (apart / length) ** 2)
        for spread, length in ((long_cN, LONG_mm), (short_cN, SHORT_mm))
    )
    places = step_mm * np.arange(NODES)
    covariance = covariance + spring_cN_mm**2 * np.outer(places, places)
    size, axes = np.linalg.eigh(covariance)
    return np.asarray(axes * np.sqrt(np.maximum(size, 1e-6)))

"""The observer whose thresholds are measured: how often it picks the changed one of two buttons.

A change is by how much force, snap and vibration grow, each as a ratio of the standard: 0.1 is a tenth more.
Parameters are arrays (..., PARAMETERS) without bounds, so that a belief about them can be normal:

======== ==================================================================================================
0, 1, 2  natural logarithm of the JND of force, snap and vibration, each such a ratio
3, 4, 5  natural logarithm of the exponent with which d' grows with the change in each; 0: in proportion
6        natural logarithm of m - 1, where m is the exponent by which differences add up; 0: their squares do
7        logit of the part of the answers that are lapses
======== ==================================================================================================
"""

from __future__ import annotations

import numpy as np

from fdvv.model.noticeable import AT_JND, DIMENSIONS
from fdvv.units import FloatArray

PARAMETERS = 8  # the rows of the table above: three JNDs, three exponents, summation, lapses
JND, EXPONENT, SUMMATION, LAPSE = slice(0, 3), slice(3, 6), 6, 7

STEPS = 8
"""Of Newton's method to where a direction crosses the surface; it converges quadratically from outside."""


def share_correct(parameters: FloatArray, changes: FloatArray) -> FloatArray:
    """Return how likely the changed one of two is picked, (..., changes).

    changes : (changes, 3), none below 0 and in each at least one above. The d' of one dimension is
    sqrt(2) AT_JND (change / JND) ** exponent; several add up as (sum d' ** m) ** (1 / m), Minkowski's rule.
    A lapse is right by chance.
    """
    from scipy.special import expit, ndtr

    lapse = expit(parameters[..., LAPSE, None])
    return np.asarray(0.5 * lapse + (1.0 - lapse) * ndtr(AT_JND * np.exp(log_strength(parameters, changes))))


def log_strength(parameters: FloatArray, changes: FloatArray) -> FloatArray:
    """Return the logarithm of how strongly changes are felt, in JND, (..., changes)."""
    found = np.empty((*parameters.shape[:-1], len(changes)))
    count = np.count_nonzero(changes, axis=1)
    # most trials change one dimension, where there is nothing to add up
    for one in range(len(DIMENSIONS)):
        alone = (count == 1) & (changes[:, one] > 0)
        if alone.any():
            found[..., alone] = _log_parts(parameters, changes[alone])[one]
    several = count > 1
    if several.any():
        found[..., several] = summed(parameters, changes[several])[0]
    return found


def summed(parameters: FloatArray, changes: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the logarithm of how strongly changes are felt, (..., changes), of each dimension, its share.

    The last two are (3, ..., changes); shares add up to 1.
    """
    m = 1.0 + np.exp(parameters[..., SUMMATION, None])
    logs = _log_parts(parameters, changes)
    largest = logs.max(axis=0)
    powers = np.exp(m * (logs - largest))
    total = powers.sum(axis=0)
    return largest + np.log(total) / m, logs, powers / total


def _log_parts(parameters: FloatArray, changes: FloatArray) -> FloatArray:
    with np.errstate(divide="ignore"):
        ratios = np.log(changes)
    return np.stack(
        [
            np.exp(parameters[..., 3 + one, None]) * (ratios[:, one] - parameters[..., one, None])
            for one in range(len(DIMENSIONS))
        ]
    )


def log_jnd_along(parameters: FloatArray, directions: FloatArray) -> FloatArray:
    """Return the logarithm of how often a direction goes into its JND, (..., directions).

    The surface of just noticeable changes is crossed at exp() of it times the direction, (directions, 3).
    """
    found = np.empty((*parameters.shape[:-1], len(directions)))
    for place, direction in enumerate(directions):
        there = np.flatnonzero(direction)
        own = parameters[..., there] - np.log(direction[there])
        # the nearest crossing by one dimension alone lies on the surface or outside
        size = own.min(axis=-1)
        if there.size > 1:
            size = _crossing(size, own, parameters[..., 3 + there], parameters[..., SUMMATION])
        found[..., place] = size
    return found


def _crossing(size: FloatArray, own: FloatArray, exponent: FloatArray, summation: FloatArray) -> FloatArray:
    """Solve sum ((exp(size) / exp(own)) ** (exponent m)) = 1 for size; its logarithm is convex in it."""
    power = np.exp(exponent) * (1.0 + np.exp(summation))[..., None]
    for _ in range(STEPS):
        parts = np.exp(power * (size[..., None] - own))
        total = parts.sum(axis=-1)
        size = size - np.log(total) * total / (power * parts).sum(axis=-1)
    return size

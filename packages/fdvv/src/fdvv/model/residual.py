"""Noise or shape: what a fit leaves of the samples, judged by how successive samples differ."""

from __future__ import annotations

import numpy as np

from fdvv.units import FloatArray

ALIKE_ratio, LOUD_ratio = 0.4, 2.0
"""Correlation of successive residuals, and RMS over the noise of successive samples, above both of which a
residual still holds shape. Set on half of 222 real strokes."""


def noise_cN(force_cN: FloatArray) -> float:
    """Estimate the noise of successive samples: from what each differs from the mean of its neighbours.

    After Gasser, Sroka and Jennen-Steinmetz 1986, with the median in place of the mean, so that steps and
    clicks do not count. 0 for fewer than three samples.
    """
    if force_cN.size < 3:
        return 0.0
    apart = force_cN[1:-1] - 0.5 * (force_cN[:-2] + force_cN[2:])
    return float(1.4826 * np.sqrt(2 / 3) * np.median(np.abs(apart)))


def holds_shape(force_cN: FloatArray, fitted_cN: FloatArray) -> bool:
    """Whether a fit leaves more than noise of the samples: louder, and alike from one to the next."""
    left = force_cN - fitted_cN
    squares = float(left @ left)
    loud = squares / left.size > (LOUD_ratio * noise_cN(force_cN)) ** 2
    return loud and float(left[:-1] @ left[1:]) > ALIKE_ratio * squares

"""How much of a curve's bump a fit keeps: as a finger feels it, and sample by sample."""

from __future__ import annotations

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from fdvv.model.bump import LEAST_DROP_cN, find_bump
from fdvv.units import FloatArray

BUMP_KEPT_ratio = 0.95
"""A fit that keeps less of its bump is searched again."""

SAMPLES = 5
"""Of the median that stands for a bench's own sharpness: 25 um on the finest."""


def drop_ratio(x_mm: FloatArray, force_cN: FloatArray, fitted_cN: FloatArray) -> float | None:
    """Return the drop of the fitted bump over the measured one, as means over 50 um; None without a bump.

    Nothing faster than 1 kHz is felt (noticeable.HIGHEST_Hz). At 50 mm/s, slower than any keystroke that was
    measured, that is 50 um; at 270 mm/s, the median, 270 um. So 50 um is no coarser than a finger.
    """
    bump, fitted = find_bump(x_mm, force_cN), find_bump(x_mm, fitted_cN, least_drop_cN=0.0)
    return fitted.drop_cN / bump.drop_cN if bump and fitted else None


def median_drop_ratio(force_cN: FloatArray, fitted_cN: FloatArray) -> float | None:
    """Return the same with medians of 5 samples in place of means over 50 um."""
    drop = _largest_fall_cN(force_cN)
    return _largest_fall_cN(fitted_cN) / drop if drop >= LEAST_DROP_cN else None


def is_felt(x_mm: FloatArray, force_cN: FloatArray, fitted_cN: FloatArray) -> bool:
    """Return whether a fit keeps 95 % of the bump that a finger feels, or there is none."""
    ratio = drop_ratio(x_mm, force_cN, fitted_cN)
    return ratio is None or ratio >= BUMP_KEPT_ratio


def is_kept(x_mm: FloatArray, force_cN: FloatArray, fitted_cN: FloatArray) -> bool:
    """Return whether a fit keeps 95 % of the bump by both measures, or there is none."""
    ratio = median_drop_ratio(force_cN, fitted_cN)
    return is_felt(x_mm, force_cN, fitted_cN) and (ratio is None or ratio >= BUMP_KEPT_ratio)


def _largest_fall_cN(force_cN: FloatArray) -> float:
    if force_cN.size >= SAMPLES:
        padded = np.pad(force_cN, SAMPLES // 2, mode="edge")
        force_cN = np.median(sliding_window_view(padded, SAMPLES), axis=1)
    return float(np.max(np.maximum.accumulate(force_cN) - force_cN))

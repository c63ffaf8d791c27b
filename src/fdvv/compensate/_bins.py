"""Force on a grid of displacement: bins, smoothing, and what smoothing takes from a bump."""

from __future__ import annotations

import numpy as np

from fdvv.errors import ModelError
from fdvv.model import find_bump
from fdvv.units import FloatArray


def grid_mm(travel_mm: float, bin_mm: float) -> FloatArray:
    """Make the centres of the bins over the travel, from 0 on: (n,) with n = round(travel / bin) + 1."""
    return np.arange(round(travel_mm / bin_mm) + 1, dtype=np.float64) * bin_mm


def bin_force(displacement_mm: FloatArray, force_cN: FloatArray, grid_mm: FloatArray) -> FloatArray:
    """Average the samples of one stroke around each grid point: (n,) force, NaN where unknown.

    A bin reaches half a step to both sides of its centre. At 200 mm/s and 1 kHz only one bin of four
    holds a sample, so an empty bin between visited ones takes the straight line between its visited
    neighbours. Outside the first and the last visited bin nothing is known: NaN. Samples beyond the
    grid and samples that are NaN do not count. Raises ModelError on columns that do not pair up.
    """
    if displacement_mm.shape != force_cN.shape:
        raise ModelError(f"columns must pair up, got {displacement_mm.shape = } and {force_cN.shape = }")
    index = np.floor((displacement_mm - grid_mm[0]) / (grid_mm[1] - grid_mm[0]) + 0.5)
    keep = (index >= 0) & (index < grid_mm.size) & np.isfinite(force_cN)
    at = index[keep].astype(np.intp)
    count = np.bincount(at, minlength=grid_mm.size)
    total = np.bincount(at, force_cN[keep], minlength=grid_mm.size)
    visited = count > 0
    if not visited.any():
        return np.full(grid_mm.size, np.nan)
    mean = total[visited] / count[visited]
    return np.interp(grid_mm, grid_mm[visited], mean, left=np.nan, right=np.nan)


def smooth(values: FloatArray, sigma_mm: float, step_mm: float) -> FloatArray:
    """Run a zero-phase Gaussian filter over a table, (n,); a sigma below a tenth of a
    step reaches no neighbour and changes nothing.

    The table goes on beyond its ends as its own point reflection, so that a straight line stays itself.
    """
    if sigma_mm < 0.1 * step_mm:
        return values.copy()
    reach = int(np.ceil(4 * sigma_mm / step_mm))
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) * step_mm / sigma_mm) ** 2)
    padded = np.pad(values, reach, mode="reflect", reflect_type="odd")
    return np.convolve(padded, kernel / kernel.sum(), mode="valid")


def bump_kept_ratio(grid_mm: FloatArray, force_cN: FloatArray, sigma_mm: float) -> float | None:
    """Tell how much of a curve's bump outlives smoothing: 1 all, 0 none; None if it has no bump."""
    bump = find_bump(grid_mm, force_cN)
    if bump is None:
        return None
    smoothed = smooth(force_cN, sigma_mm, float(grid_mm[1] - grid_mm[0]))
    left = find_bump(grid_mm, smoothed, least_drop_cN=0.0)
    return left.drop_cN / bump.drop_cN if left else 0.0

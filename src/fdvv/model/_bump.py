"""The bump of a tactile curve: its peak, its valley and the drop between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.units import FloatArray

LEAST_DROP_cN = 4.0
"""A smaller drop is friction, not a bump: stick and slip of measured linear switches drops up to 3 cN."""

RESOLUTION_mm = 0.05
"""Forces of peak and valley are means over this length, the paper's displacement bin: a single sample of
a stick-slip ripple is neither."""


@dataclass(frozen=True)
class Bump:
    """The largest fall of force with displacement.

    Attributes
    ----------
    peak_mm, peak_cN : where the fall begins.
    valley_mm, valley_cN : where it ends.
    """

    peak_mm: float
    peak_cN: float
    valley_mm: float
    valley_cN: float

    @property
    def drop_cN(self) -> float:
        """Get the fall from peak to valley."""
        return self.peak_cN - self.valley_cN

    @property
    def snap_ratio(self) -> float:
        """Get (peak - valley) / peak, the click ratio of switch data sheets."""
        return self.drop_cN / self.peak_cN


def find_bump(x_mm: FloatArray, force_cN: FloatArray, least_drop_cN: float = LEAST_DROP_cN) -> Bump | None:
    """Find the largest fall of force along rising displacement; None if it is less than least_drop_cN.

    x_mm, force_cN : (n,), x strictly rising. Forces are taken as means over 50 um. The largest fall is the
    greatest difference between a running maximum and a later value, so that texture on the flanks does
    not cut a bump in two.
    """
    force_cN = running_mean(x_mm, force_cN, RESOLUTION_mm)
    highest = np.maximum.accumulate(force_cN)
    valley = int(np.argmax(highest - force_cN))
    peak = int(np.argmax(force_cN[: valley + 1]))
    bump = Bump(float(x_mm[peak]), float(force_cN[peak]), float(x_mm[valley]), float(force_cN[valley]))
    return bump if bump.drop_cN >= least_drop_cN else None


def running_mean(x_mm: FloatArray, force_cN: FloatArray, width_mm: float) -> FloatArray:
    """Average the polyline through (x_mm, force_cN) over width_mm around each point, less at the ends."""
    area = np.concatenate([[0.0], np.cumsum(0.5 * (force_cN[1:] + force_cN[:-1]) * np.diff(x_mm))])
    reach = np.minimum(0.5 * width_mm, np.minimum(x_mm - x_mm[0], x_mm[-1] - x_mm))
    inside = reach > 0
    low, high = x_mm[inside] - reach[inside], x_mm[inside] + reach[inside]
    mean = force_cN.astype(np.float64, copy=True)
    mean[inside] = (_area_at(high, x_mm, force_cN, area) - _area_at(low, x_mm, force_cN, area)) / (high - low)
    return mean


def _area_at(at: FloatArray, x: FloatArray, y: FloatArray, area: FloatArray) -> FloatArray:
    """Integrate the polyline from x[0] to each abscissa, exactly."""
    k = np.clip(np.searchsorted(x, at, side="right") - 1, 0, x.size - 2)
    part = at - x[k]
    slope = (y[k + 1] - y[k]) / (x[k + 1] - x[k])
    return np.asarray(area[k] + part * (y[k] + 0.5 * slope * part))

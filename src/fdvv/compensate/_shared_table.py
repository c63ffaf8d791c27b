"""A table that is learned at several speeds at once: a Kalman filter over speeds, the same in every bin."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fdvv.compensate._bins import smooth
from fdvv.errors import ModelError
from fdvv.units import FloatArray

BEYOND_ratio = 0.3
"""So far beyond the outer speeds a press is still told apart from one at them."""

GATE = 2.0
"""What is more surprising than so many standard deviations is a bounce or a slip, and counts as this many."""


@dataclass(frozen=True, eq=False)
class SharedTable:
    """What is believed of a table, one row per speed.

    Rows are believed alike: an error of calibration is in all of them, one of inertia grows with the square
    of speed, and little is left that one row has alone. So a press at one speed corrects the others, by as
    much as that belief allows, and a row that many presses have told moves little more.

    Attributes
    ----------
    grid_mm : (n,). speeds_mm_s : (s,) rising.
    rows_cN : (s, n) the estimate.
    covariance_cN2 : (s, s) of the rows' errors, the same in every bin.
    """

    grid_mm: FloatArray
    speeds_mm_s: FloatArray
    rows_cN: FloatArray
    covariance_cN2: FloatArray

    @classmethod
    def believed(
        cls,
        grid_mm: FloatArray,
        speeds_mm_s: FloatArray,
        common_cN: float,
        inertia_cN: FloatArray,
        alone_cN: FloatArray,
    ) -> SharedTable:
        """Begin at 0; spreads: common to all rows, of inertia at each speed, and of each row alone, (s,)."""
        covariance = common_cN**2 + np.outer(inertia_cN, inertia_cN) + np.diag(alone_cN**2)
        return cls(grid_mm, speeds_mm_s, np.zeros((speeds_mm_s.size, grid_mm.size)), covariance)

    def shares(self, speed_mm_s: float) -> FloatArray:
        """Give the share of every row in a table at a speed, (s,): straight in the square of speed."""
        squares = self.speeds_mm_s**2
        if squares.size == 1:
            return np.ones(1)
        low = int(np.clip(np.searchsorted(squares, speed_mm_s**2) - 1, 0, squares.size - 2))
        part = (speed_mm_s**2 - squares[low]) / (squares[low + 1] - squares[low])
        part = float(np.clip(part, -BEYOND_ratio, 1 + BEYOND_ratio))
        shares = np.zeros(squares.size)
        shares[[low, low + 1]] = 1 - part, part
        return shares

    def at(self, speed_mm_s: float) -> FloatArray:
        """Give the table at a speed, (n,)."""
        return np.asarray(self.shares(speed_mm_s) @ self.rows_cN)

    def learned(
        self, seen_cN: FloatArray, speed_mm_s: float, noise_cN: float, sigma_mm: float, fading: float
    ) -> SharedTable:
        """Take in what one stroke tells: seen_cN (n,), NaN where it tells nothing; ModelError if nowhere.

        noise_cN : by how much two such strokes differ, rms. sigma_mm : of the smoothing of the correction.
        fading : what is left of the weight of older strokes, 0 to 1, since they were made on other tables.
        """
        told = np.flatnonzero(np.isfinite(seen_cN))
        if not told.size:
            raise ModelError("no sample of the stroke fell within the guards")
        shares = self.shares(speed_mm_s)
        covariance = self.covariance_cN2 / fading
        spread = covariance @ shares
        expected = float(shares @ spread + noise_cN**2)
        weights = spread / expected
        gate = GATE * np.sqrt(expected)
        surprise = np.clip((seen_cN - self.at(speed_mm_s))[told], -gate, gate)
        surprise = np.interp(np.arange(seen_cN.size), told, surprise)
        surprise = smooth(surprise, sigma_mm, float(self.grid_mm[1] - self.grid_mm[0]))
        return replace(
            self,
            rows_cN=self.rows_cN + np.outer(weights, surprise),
            covariance_cN2=covariance - np.outer(spread, spread) / expected,
        )

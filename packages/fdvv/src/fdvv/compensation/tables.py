"""Command tables: bins, smoothing, the state of one learned curve, and a prior shared between speeds."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fdvv.errors import ModelError
from fdvv.model.bump import find_bump
from fdvv.units import FloatArray


def grid_mm(travel_mm: float, bin_mm: float) -> FloatArray:
    """Return the bin centres over the travel, from 0: (n,) with n = round(travel / bin) + 1."""
    return np.arange(round(travel_mm / bin_mm) + 1, dtype=np.float64) * bin_mm


def bin_force(displacement_mm: FloatArray, force_cN: FloatArray, grid_mm: FloatArray) -> FloatArray:
    """Return the mean force of one stroke in each bin, (n,), NaN outside the visited range.

    A bin extends half a step to both sides of its centre. At 200 mm/s and 1 kHz only one bin in four
    holds a sample, so an empty bin between visited ones is interpolated linearly between its visited
    neighbours. Outside the first and the last visited bin the result is NaN. Samples beyond the
    grid and NaN samples do not count. Raises ModelError on columns of different shape.
    """
    if displacement_mm.shape != force_cN.shape:
        raise ModelError(
            f"columns must have one shape, got {displacement_mm.shape = } and {force_cN.shape = }"
        )
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
    """Return a table, (n,), after a zero-phase Gaussian filter; unchanged for sigma below 0.1 steps.

    The table is extended by its own point reflection at both ends, which preserves a straight line.
    """
    if sigma_mm < 0.1 * step_mm:
        return values.copy()
    reach = int(np.ceil(4 * sigma_mm / step_mm))
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) * step_mm / sigma_mm) ** 2)
    padded = np.pad(values, reach, mode="reflect", reflect_type="odd")
    return np.convolve(padded, kernel / kernel.sum(), mode="valid")


def bump_kept_ratio(grid_mm: FloatArray, force_cN: FloatArray, sigma_mm: float) -> float | None:
    """Return the part of a curve's bump that smoothing preserves, 0 to 1; None without a bump."""
    bump = find_bump(grid_mm, force_cN)
    if bump is None:
        return None
    smoothed = smooth(force_cN, sigma_mm, float(grid_mm[1] - grid_mm[0]))
    left = find_bump(grid_mm, smoothed, least_drop_cN=0.0)
    return left.drop_cN / bump.drop_cN if left else 0.0


@dataclass(frozen=True, eq=False)
class BestPress:
    """The press of a round with the smallest error_k, as the rig measured it."""

    error_cN: float
    mean_error_cN: float
    max_error_cN: float
    command_cN: FloatArray


@dataclass(frozen=True, eq=False)
class CurveState:
    """State of the law for one curve.

    Attributes
    ----------
    grid_mm, target_cN, command_cN : (n,) bins, intended force, the table for the next press.
    limit_cN : largest command of either sign.
    errors_cN : error_k of every press so far, all rounds.
    best : of the current round; None before its first press.
    rounds : the best of every finished round.
    """

    grid_mm: FloatArray
    target_cN: FloatArray
    command_cN: FloatArray
    limit_cN: float
    errors_cN: tuple[float, ...] = ()
    best: BestPress | None = None
    rounds: tuple[BestPress, ...] = ()


@dataclass(frozen=True, eq=False)
class LearnedCurve:
    """Result of one curve.

    Attributes
    ----------
    command_cN : (n,) the table to render with.
    errors_cN : error_k of every press, as the rig measured it while it learned.
    mean_error_cN, max_error_cN : of the best press of each round, averaged over the rounds. Selected for
        being small and measured by the rig's own lagging sensors; a probe measures without that bias.
    sentence : summary for people.
    """

    command_cN: FloatArray
    errors_cN: tuple[float, ...]
    mean_error_cN: float
    max_error_cN: float
    sentence: str


def read_only(values: FloatArray) -> FloatArray:
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array


EXTRAPOLATION_ratio = 0.3
"""Speeds up to this part of the interval beyond the outer ones are extrapolated."""
GATE_sigma = 2.0
"""An innovation beyond this many standard deviations is a bounce or a slip, and is clipped to it."""


@dataclass(frozen=True, eq=False)
class SharedTable:
    """Kalman estimate of a table, one row per speed.

    The errors of the rows are correlated: one of calibration is common to all, one of inertia grows with the
    square of speed, and little is independent. So a press at one speed also corrects the others, and a row
    that many presses have informed moves little more.

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
    def prior(
        cls,
        grid_mm: FloatArray,
        speeds_mm_s: FloatArray,
        common_cN: float,
        inertia_cN: FloatArray,
        alone_cN: FloatArray,
    ) -> SharedTable:
        """Return the prior: mean 0, spreads common to all rows, of inertia and of each row alone, (s,)."""
        covariance = common_cN**2 + np.outer(inertia_cN, inertia_cN) + np.diag(alone_cN**2)
        return cls(grid_mm, speeds_mm_s, np.zeros((speeds_mm_s.size, grid_mm.size)), covariance)

    def shares(self, speed_mm_s: float) -> FloatArray:
        """Return the weight of every row in the table at a speed, (s,): linear in the square of speed."""
        squares = self.speeds_mm_s**2
        if squares.size == 1:
            return np.ones(1)
        low = int(np.clip(np.searchsorted(squares, speed_mm_s**2) - 1, 0, squares.size - 2))
        part = (speed_mm_s**2 - squares[low]) / (squares[low + 1] - squares[low])
        part = float(np.clip(part, -EXTRAPOLATION_ratio, 1 + EXTRAPOLATION_ratio))
        shares = np.zeros(squares.size)
        shares[[low, low + 1]] = 1 - part, part  # beyond the outer speeds one of them is negative
        return shares

    def at(self, speed_mm_s: float) -> FloatArray:
        return np.asarray(self.shares(speed_mm_s) @ self.rows_cN)

    def update(
        self, seen_cN: FloatArray, speed_mm_s: float, noise_cN: float, sigma_mm: float, fading: float
    ) -> SharedTable:
        """Return the estimate after one stroke: seen_cN (n,), NaN where it was not measured.

        noise_cN : rms difference between two such strokes. sigma_mm : of the smoothing of the correction.
        fading : weight left to older strokes, 0 to 1, since they were made on other tables.
        Raises ModelError if no bin was measured.
        """
        measured = np.flatnonzero(np.isfinite(seen_cN))
        if not measured.size:
            raise ModelError("no sample of the stroke fell within the guards")
        shares = self.shares(speed_mm_s)
        covariance = self.covariance_cN2 / fading
        spread = covariance @ shares
        expected = float(shares @ spread + noise_cN**2)
        weights = spread / expected
        gate = GATE_sigma * np.sqrt(expected)
        innovation = np.clip((seen_cN - self.at(speed_mm_s))[measured], -gate, gate)
        innovation = np.interp(np.arange(seen_cN.size), measured, innovation)
        innovation = smooth(innovation, sigma_mm, float(self.grid_mm[1] - self.grid_mm[0]))
        return replace(
            self,
            rows_cN=self.rows_cN + np.outer(weights, innovation),
            covariance_cN2=covariance - np.outer(spread, spread) / expected,
        )


@dataclass(frozen=True)
class GainSchedule:
    """Gain of the law as a function of the error.

    The paper names it (Gamma of error_k) and does not print it. Here
    gain = most * (1 - (floor / error)^2), clipped to [least, most]: far above the floor a press is
    trusted, near the floor its error is mostly noise and is averaged over many presses.

    Attributes
    ----------
    most, least : bounds of the gain, 0 <= least <= most < 2; equal for a constant gain. With a plant of
        gain g the error shrinks by |1 - g * gain| per press, so beyond 2 / g the law diverges.
    floor_cN : error_k of a perfect table, from noise and from presses that differ.
    """

    most: float = 0.5
    least: float = 0.1
    floor_cN: float = 3.0

    def __post_init__(self) -> None:
        if not 0 <= self.least <= self.most < 2:
            raise ModelError(f"gains must satisfy 0 <= least <= most < 2, got {self.least}, {self.most}")
        if not self.floor_cN >= 0:
            raise ModelError(f"floor_cN must be at least 0, got {self.floor_cN}")

    @classmethod
    def constant(cls, gain: float) -> GainSchedule:
        """Return the schedule that ignores the error."""
        return cls(gain, gain, 0.0)

    def gain(self, error_cN: float) -> float:
        trust = 1 - (self.floor_cN / error_cN) ** 2 if error_cN > 0 else 0.0
        return min(max(self.most * trust, self.least), self.most)

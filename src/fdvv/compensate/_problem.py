"""The presses against a set of numbers: generalised least squares on the balance of forces.

The noise of window and position is known, so every run of windows is whitened. The noise of the position in
the columns of drag and mass would pull these towards zero (errors in variables): what it adds on average is
taken out of the normal equations. Priors hold what the presses do not show where rigs usually are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fdvv.compensate._balance import (
    LAG,
    MOVING,
    NUMBERS,
    felt_cN,
    noise_windows,
    play_stretch,
    predicted,
    slopes,
    spans,
    usable,
)
from fdvv.compensate._prior import Prior
from fdvv.compensate._ticks import Ticks, noise, windows
from fdvv.errors import FitError
from fdvv.units import FloatArray

STEPS, DAMPINGS = 4, 6
SETTLED = 1e-3
"""A step that lowers the cost, in squared standard deviations, by less is the last."""
FEWEST_windows = 12
SPACING_s = 7.5e-4
"""Between the windows that are looked at; closer ones tell the same."""
LEAST_NOISE_cN = 0.2
FASTEST_Hz = 25.0
"""Above it windows count less and less: there the noise of the sensed position, which the controller passes
on into its command, would be taken for an answer of the rig."""
UNMODELLED_cN, UNMODELLED_s = 0.3, 0.006
"""Rms and memory of what no term of the balance covers."""


@dataclass(frozen=True, eq=False)
class Run:
    """An unbroken run of windows: its rows in the press, and what whitens it."""

    press: int
    rows: npt.NDArray[np.intp]
    white: FloatArray
    diagonals: FloatArray


class Problem:
    """The presses, and what is known beforehand."""

    def __init__(self, ticks: list[Ticks], travel_mm: float, prior: Prior) -> None:
        self.ticks, self.travel_mm, self.sensor = ticks, travel_mm, prior.sensor
        self.tick_s = ticks[0].tick_s
        self.mean, self.spread, self.low, self.high = prior.vectors(self.tick_s)
        self.felt = [felt_cN(t, self.sensor) for t in ticks]
        self.stretches = [play_stretch(t) for t in ticks]
        self.position_noise_mm = noise([t.sensed_mm for t in ticks])
        self.force_noise_cN = noise([t.force_cN for t in ticks])
        self.quiet_cN = max(self.force_noise_cN, LEAST_NOISE_cN)
        self.stride = max(1, round(SPACING_s / self.tick_s))

    def runs(self, numbers: FloatArray) -> list[Run]:
        """Find the runs of windows, and whiten each by the noise these numbers make of it."""
        force, position, _ = noise_windows(self.tick_s, numbers, self.sensor)
        found = []
        for i, t in enumerate(self.ticks):
            for a, b in spans(usable(t, numbers[LAG], self.travel_mm)):
                rows = np.arange(a, b, self.stride)
                if rows.size > 2:
                    found.append(self._run(i, rows, force, position))
        if sum(run.rows.size for run in found) < FEWEST_windows:
            raise FitError(
                "the presses hold too few rows between the stops to know a rig by; "
                "press all the way down and back, with the cap held up at rest"
            )
        return found

    def _run(self, press: int, rows: npt.NDArray[np.intp], force: FloatArray, position: FloatArray) -> Run:
        from scipy.linalg import cholesky, solve_triangular, toeplitz

        n = rows.size
        row = self.quiet_cN**2 * self.covariance(force, force, n)
        row += self.position_noise_mm**2 * self.covariance(position, position, n)
        fast = windows(self.tick_s)[3]
        row += (self.quiet_cN / (2 * np.pi * FASTEST_Hz) ** 3) ** 2 * self.covariance(fast, fast, n)
        row += UNMODELLED_cN**2 * np.exp(-np.arange(n) * self.stride * self.tick_s / UNMODELLED_s)
        root = cholesky(toeplitz(row), lower=True)
        white = solve_triangular(root, np.eye(n), lower=True)
        inverse = white.T @ white
        diagonals = np.array([np.trace(inverse, k) * (1.0 if k == 0 else 2.0) for k in range(n)])
        return Run(press, rows, white, diagonals)

    def covariance(self, one: FloatArray, other: FloatArray, n: int) -> FloatArray:
        """Correlate what two windows make of unit noise, for rows 0 to n - 1 apart, (n,)."""
        full = np.correlate(one, other, "full")
        even = 0.5 * (full + full[::-1])[one.size - 1 :: self.stride]
        return np.pad(even, (0, max(0, n - even.size)))[:n]

    def taken_out(self, numbers: FloatArray, runs: list[Run]) -> tuple[FloatArray, FloatArray]:
        """Give what noise of the position adds to gradient, (12,), and normal matrix, (12, 12)."""
        _, position, into = noise_windows(self.tick_s, numbers, self.sensor)
        gradient, matrix = np.zeros(len(NUMBERS)), np.zeros((len(NUMBERS), len(NUMBERS)))
        longest = max(run.rows.size for run in runs)
        diagonals = sum(np.pad(run.diagonals, (0, longest - run.rows.size)) for run in runs)
        variance = self.position_noise_mm**2
        for i, place in enumerate(MOVING):
            gradient[place] = -variance * diagonals @ self.covariance(into[i], position, longest)
            for j, other in enumerate(MOVING):
                matrix[place, other] = variance * diagonals @ self.covariance(into[i], into[j], longest)
        return gradient, matrix

    def cost(self, numbers: FloatArray, runs: list[Run]) -> float:
        """Give the squares of all whitened misses and of the prior, less what noise of the position adds."""
        misses = self.misses(numbers)
        total = float(np.sum(((numbers - self.mean) / self.spread) ** 2))
        _, position, _ = noise_windows(self.tick_s, numbers, self.sensor)
        for run in runs:
            total += float(np.sum((run.white @ misses[run.press][run.rows]) ** 2))
            added = self.covariance(position, position, run.rows.size)
            total -= self.position_noise_mm**2 * float(run.diagonals @ added)
        return total

    def misses(self, numbers: FloatArray) -> list[FloatArray]:
        expected = [
            predicted(t, numbers, s, self.sensor) for t, s in zip(self.ticks, self.stretches, strict=True)
        ]
        return [felt - force for felt, force in zip(self.felt, expected, strict=True)]

    def normal(self, numbers: FloatArray, runs: list[Run]) -> tuple[FloatArray, FloatArray]:
        """Give downhill gradient, (12,), and normal matrix, (12, 12), both in spreads of the prior."""
        gradient, matrix = (-part for part in self.taken_out(numbers, runs))
        told = [slopes(t, numbers, s, self.sensor) for t, s in zip(self.ticks, self.stretches, strict=True)]
        for run in runs:
            force, slope = told[run.press]
            white = run.white @ slope[run.rows]
            gradient += white.T @ (run.white @ (self.felt[run.press] - force)[run.rows])
            matrix += white.T @ white
        gradient = self.spread * gradient - (numbers - self.mean) / self.spread
        size, axes = np.linalg.eigh(self.spread[:, np.newaxis] * matrix * self.spread)
        return gradient, (axes * np.maximum(size, 0.0)) @ axes.T + np.eye(numbers.size)

    def improve(self, numbers: FloatArray, runs: list[Run]) -> FloatArray:
        """Take a few damped steps of Gauss and Newton."""
        cost, damping = self.cost(numbers, runs), 1e-3
        for _ in range(STEPS):
            gradient, matrix = self.normal(numbers, runs)
            for _ in range(DAMPINGS):
                step = np.linalg.solve(matrix + damping * np.diag(np.diag(matrix)), gradient)
                tried = np.clip(numbers + self.spread * step, self.low, self.high)
                new = self.cost(tried, runs)
                if new < cost:
                    break
                damping *= 10.0
            else:
                return numbers
            settled = cost - new < SETTLED
            numbers, cost, damping = tried, new, 0.1 * damping
            if settled:
                break
        return numbers

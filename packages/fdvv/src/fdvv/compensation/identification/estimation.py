"""The least-squares problem of identification: windows of presses, their noise, and the prior."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from fdvv.compensation.identification.balance import (
    COUNT,
    LAG,
    MOVING,
    OWN,
    Ticks,
    finger_force_cN,
    noise,
    noise_windows,
    play_stretch,
    predict,
    slopes,
    true_runs,
    usable_windows,
    windows,
)
from fdvv.compensation.identification.own_force import NODES, prior_root
from fdvv.compensation.identification.rig_model import Prior
from fdvv.errors import FitError
from fdvv.units import FloatArray

STEPS, DAMPINGS = 4, 6
SETTLED = 1e-3
"""Iterations end when a step lowers the cost, in squared standard deviations, by less."""
FEWEST_windows = 12
LEAST_TRAVEL_mm = 0.5
SPACING_s = 7.5e-4
"""Spacing of the windows used; closer ones are redundant."""
LEAST_NOISE_cN = 0.2
FASTEST_Hz = 25.0
"""Above it the weight of windows falls: position noise, which the controller passes
into its command, would be mistaken for a response of the rig."""
UNMODELLED_cN, UNMODELLED_s = 0.3, 0.006
"""Rms and correlation time of unmodelled force."""


@dataclass(frozen=True, eq=False)
class WindowRun:
    """A contiguous run of windows: its rows in the press, and its whitening matrix."""

    press: int
    rows: npt.NDArray[np.intp]
    white: FloatArray

    @cached_property
    def diagonals(self) -> FloatArray:
        """Sums of the inverse covariance along its diagonals, both sides, (n,)."""
        inverse = self.white.T @ self.white
        n = self.rows.size
        return np.array([np.trace(inverse, k) * (1.0 if k == 0 else 2.0) for k in range(n)])


Spans = list[tuple[int, npt.NDArray[np.intp]]]
"""Press and rows of every contiguous run of windows."""


@dataclass(frozen=True)
class Unknown:
    """Spreads of what no number describes.

    Attributes
    ----------
    long_cN, short_cN : of the slow and the fast part of the rig's own force over displacement.
    force_cN, force_s : rms and correlation time of force that no term covers.
    """

    long_cN: float = 4.0
    short_cN: float = 0.5
    force_cN: float = UNMODELLED_cN
    force_s: float = UNMODELLED_s


def whiten_runs(spans: Spans, row: FloatArray) -> list[WindowRun]:
    """Return the runs of windows with their whitening matrices; row: the longest run's autocovariance."""
    from scipy.linalg import cholesky, toeplitz
    from scipy.linalg.lapack import dtrtri

    whole, _ = dtrtri(cholesky(toeplitz(row), lower=True), lower=1)
    return [WindowRun(press, rows, whole[: rows.size, : rows.size]) for press, rows in spans]


class RigEstimation:
    """The least-squares problem: the presses and the prior."""

    def __init__(self, ticks: list[Ticks], travel_mm: float, prior: Prior) -> None:
        self.ticks, self.travel_mm, self.sensor = ticks, travel_mm, prior.sensor
        self.tick_s = ticks[0].tick_s
        deepest_mm = max(float(t.sensed_mm.max()) for t in ticks)
        self.own_step_mm = max(LEAST_TRAVEL_mm, min(travel_mm, deepest_mm)) / (NODES - 1)
        mean, self.spread, low, high = prior.vectors(self.tick_s)
        self.nodes, nodes = NODES, np.zeros(NODES)
        # 1 N/m is 0.1 cN/mm
        spring_cN_mm, self.spring_spread_cN_mm = (0.1 * number for number in prior.spring_N_m)
        self.mean = np.concatenate([mean, spring_cN_mm * self.own_step_mm * np.arange(NODES)])
        self.low, self.high = np.concatenate([low, nodes - np.inf]), np.concatenate([high, nodes + np.inf])
        self.rendered = [finger_force_cN(t, self.sensor) for t in ticks]
        self.stretches = [play_stretch(t) for t in ticks]
        self.position_noise_mm = noise([t.sensed_mm for t in ticks])
        self.force_noise_cN = noise([t.force_cN for t in ticks])
        self.quiet_cN = max(self.force_noise_cN, self.sensor.noise_cN or 0.0, LEAST_NOISE_cN)
        self.stride = max(1, round(SPACING_s / self.tick_s))
        self.expect(Unknown())

    def expect(self, unknown: Unknown) -> None:
        """Set what is expected of the unknown."""
        self.unknown = unknown
        self.root = self.prior_root(unknown)
        self.unroot = np.asarray(np.linalg.inv(self.root), dtype=np.float64)

    def prior_root(self, unknown: Unknown) -> FloatArray:
        """Return a root of the prior's covariance, (COUNT, COUNT)."""
        root = np.zeros((COUNT, COUNT))
        root[: self.spread.size, : self.spread.size] = np.diag(self.spread)
        root[OWN, OWN] = prior_root(
            self.own_step_mm, unknown.long_cN, unknown.short_cN, self.spring_spread_cN_mm
        )
        return root

    def spans(self, numbers: FloatArray) -> Spans:
        """Return the rows of each run of windows, with its press."""
        spans = []
        for i, t in enumerate(self.ticks):
            for a, b in true_runs(usable_windows(t, numbers[LAG], self.travel_mm)):
                rows = np.arange(a, b, self.stride)
                if rows.size > 2:
                    spans.append((i, rows))
        if sum(rows.size for _, rows in spans) < FEWEST_windows:
            raise FitError(
                "the presses hold too few rows between the stops to identify a rig; "
                "press all the way down and back, with the cap held up at rest"
            )
        return spans

    def runs(self, numbers: FloatArray) -> list[WindowRun]:
        """Return the runs of windows, each with the whitening matrix for these parameters."""
        spans = self.spans(numbers)
        row = self.autocovariance(numbers, max(rows.size for _, rows in spans), self.unknown)
        return whiten_runs(spans, row)

    def autocovariance(
        self, numbers: FloatArray, n: int, unknown: Unknown, discount: bool = True
    ) -> FloatArray:
        """Return the autocovariance of what is left in n rows, for lags of 0 to n - 1 rows, (n,).

        discount : count fast windows less, see FASTEST_Hz; without it only what is measured and the unknown.
        """
        force, position, _ = noise_windows(self.tick_s, numbers, self.sensor)
        row = self.quiet_cN**2 * self.covariance(force, force, n)
        row += self.position_noise_mm**2 * self.covariance(position, position, n)
        if discount:
            fast = windows(self.tick_s)[3]
            row += (self.quiet_cN / (2 * np.pi * FASTEST_Hz) ** 3) ** 2 * self.covariance(fast, fast, n)
        row += unknown.force_cN**2 * np.exp(-np.arange(n) * self.stride * self.tick_s / unknown.force_s)
        return row

    def covariance(self, first: FloatArray, second: FloatArray, n: int) -> FloatArray:
        """Return the cross-covariance of white noise after two windows, for lags of 0 to n - 1 rows, (n,)."""
        full = np.correlate(first, second, "full")
        even = 0.5 * (full + full[::-1])[first.size - 1 :: self.stride]
        return np.pad(even, (0, max(0, n - even.size)))[:n]

    def noise_bias(self, numbers: FloatArray, runs: list[WindowRun]) -> tuple[FloatArray, FloatArray]:
        """Return the bias of gradient, (COUNT,), and normal matrix, (COUNT, COUNT), by position noise."""
        _, position, into = noise_windows(self.tick_s, numbers, self.sensor)
        gradient, matrix = np.zeros(COUNT), np.zeros((COUNT, COUNT))
        longest = max(run.rows.size for run in runs)
        diagonals = sum(np.pad(run.diagonals, (0, longest - run.rows.size)) for run in runs)
        variance = self.position_noise_mm**2
        for i, place in enumerate(MOVING):
            gradient[place] = -variance * diagonals @ self.covariance(into[i], position, longest)
            for j, other in enumerate(MOVING):
                matrix[place, other] = variance * diagonals @ self.covariance(into[i], into[j], longest)
        return gradient, matrix

    def cost(self, numbers: FloatArray, runs: list[WindowRun]) -> float:
        """Return the squared whitened residuals plus those of the prior, minus the bias by position noise."""
        residuals = self.residuals(numbers)
        total = float(np.sum((self.unroot @ (numbers - self.mean)) ** 2))
        _, position, _ = noise_windows(self.tick_s, numbers, self.sensor)
        for run in runs:
            total += float(np.sum((run.white @ residuals[run.press][run.rows]) ** 2))
            added = self.covariance(position, position, run.rows.size)
            total -= self.position_noise_mm**2 * float(run.diagonals @ added)
        return total

    def residuals(self, numbers: FloatArray) -> list[FloatArray]:
        each = zip(self.rendered, self.ticks, self.stretches, strict=True)
        return [rendered - predict(t, numbers, s, self.sensor, self.own_step_mm) for rendered, t, s in each]

    def slopes(self, numbers: FloatArray) -> list[tuple[FloatArray, FloatArray]]:
        """Return residual, (n,), and slopes of the prediction, (n, COUNT), of every press."""
        each = zip(self.rendered, self.ticks, self.stretches, strict=True)
        presses = []
        for rendered, t, stretch in each:
            force, slope = slopes(t, numbers, stretch, self.sensor, self.own_step_mm)
            presses.append((rendered - force, slope))
        return presses

    def normal(self, numbers: FloatArray, runs: list[WindowRun]) -> tuple[FloatArray, FloatArray]:
        """Return the negative gradient, (COUNT,), and normal matrix, in roots of the prior."""
        gradient, matrix = (-part for part in self.noise_bias(numbers, runs))
        presses = self.slopes(numbers)
        for run in runs:
            residual, slope = presses[run.press]
            white = run.white @ slope[run.rows]
            gradient += white.T @ (run.white @ residual[run.rows])
            matrix += white.T @ white
        gradient = self.root.T @ gradient - self.unroot @ (numbers - self.mean)
        # less the noise's mean effect the matrix may bend the wrong way along what no press shows
        size, axes = np.linalg.eigh(self.root.T @ matrix @ self.root)
        return gradient, (axes * np.maximum(size, 0.0)) @ axes.T + np.eye(numbers.size)

    def improve(self, numbers: FloatArray, runs: list[WindowRun]) -> FloatArray:
        """Take a few damped Gauss-Newton steps."""
        cost, damping = self.cost(numbers, runs), 1e-3
        for _ in range(STEPS):
            gradient, matrix = self.normal(numbers, runs)
            for _ in range(DAMPINGS):
                step = np.linalg.solve(matrix + damping * np.diag(np.diag(matrix)), gradient)
                tried = np.clip(numbers + self.root @ step, self.low, self.high)
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

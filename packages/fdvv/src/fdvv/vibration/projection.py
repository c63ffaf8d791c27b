"""Records that share decaying sinusoids: what their best weights leave, by inner products alone."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.units import FloatArray

EVEN_ratio = 1e-3
"""Samples whose times lie within this part of a period of an even grid are taken to lie on it."""


def shapes(t_s: FloatArray, frequency_Hz: FloatArray, decay_1_s: FloatArray) -> FloatArray:
    """Return exp(-d t) sin and exp(-d t) cos of each mode, (n, 2 modes), 0 before t = 0."""
    t = np.maximum(t_s, 0.0)[:, None]
    turned = np.exp((2j * np.pi * frequency_Hz - decay_1_s) * t) * (t_s >= 0)[:, None]
    return np.stack([turned.imag, turned.real], axis=2).reshape(t_s.size, -1)


def polynomial(t_s: FloatArray, degree: int) -> FloatArray:
    """Return Legendre polynomials over the span of t_s, (n, degree + 1); none for degree -1."""
    if degree < 0 or t_s.size == 0:
        return np.empty((t_s.size, 0))
    middle, half = 0.5 * (t_s[0] + t_s[-1]), 0.5 * max(float(t_s[-1] - t_s[0]), 1e-12)
    return np.polynomial.legendre.legvander((t_s - middle) / half, degree)


@dataclass(frozen=True, eq=False)
class Solved:
    """Least squares at given frequencies and decays, theta = (f..., d...).

    Attributes
    ----------
    theta : (p,) with p = 2 modes.
    powers : (records,) sums of squares that remain.
    slopes, curvatures : (records, p) and (records, p, p): S'r and S'S, with residuals r and slopes S of the
        model by theta, less what the weights can follow (Kaufman 1975).
    weights : (records, p) of sin and cos, at the first sample of each record.
    weights_by_theta : (records, p, p) how they follow theta.
    weight_doubt : (records, p, p) their covariance for noise of power 1 and known theta.
    """

    theta: FloatArray
    powers: FloatArray
    slopes: FloatArray
    curvatures: FloatArray
    weights: FloatArray
    weights_by_theta: FloatArray
    weight_doubt: FloatArray

    @property
    def power(self) -> float:
        """Sum of squares over all records."""
        return float(self.powers.sum())


class Records:
    """Several records that share frequencies and decays; amplitudes, phases and background are their own.

    Records sampled evenly at one rate share their shapes: a later start of a damped sinusoid only turns its
    weights. So all that a step of a search needs are inner products of one table, summed up to where each
    record ends.
    """

    def __init__(
        self, times_s: Sequence[FloatArray], signals: Sequence[FloatArray], degree: int, same_phase: bool
    ) -> None:
        self.samples = sum(t.size for t in times_s)
        # the search stops at an absolute slope, so that it needs signals of a size of its own
        self.size = math.sqrt(sum(float(y @ y) for y in signals) / max(self.samples, 1)) or 1.0
        self.starts_s = np.array([t[0] for t in times_s])
        own = [t - t[0] for t in times_s]
        signals = [y / self.size for y in signals]
        self.even = grid = None if same_phase else _grid(own)
        if grid is not None:
            self.times_s, backgrounds = [grid], [polynomial(grid, degree)]
            self.signals = signals
        elif same_phase:
            # one record with all samples, in which each press keeps a background of its own
            self.starts_s = np.zeros(1)
            self.times_s, self.signals = [np.concatenate(times_s)], [np.concatenate(signals)]
            backgrounds = [_block_diagonal([polynomial(t, degree) for t in times_s])]
        else:
            self.times_s, self.signals = own, signals
            backgrounds = [polynomial(t, degree) for t in own]
        self.backgrounds = backgrounds
        # what falls faster is over within a sample
        self.most_decay_1_s = 1 / max(float(np.median(np.diff(np.concatenate(times_s)))), 1e-6)
        self.own_powers = np.array([float(y @ y) for y in self.signals])
        self._ends = np.array([y.size for y in self.signals])
        self._padded = np.zeros((self._ends.max(), len(self.signals)))
        for r, y in enumerate(self.signals):
            self._padded[: y.size, r] = y

    def parameters(self, modes: int) -> int:
        """Count what is fitted with a number of modes."""
        per_record = 2 * modes + int(self.backgrounds[0].shape[1])
        return 2 * modes + len(self.signals) * per_record

    def at(self, theta: FloatArray) -> Solved:
        """Solve for the weights of every record. Raises LinAlgError where modes cannot be separated."""
        p = theta.size
        gram, along = self._products(theta)
        m = gram.shape[1] - p
        inside, cross, late = gram[:, :m, :m], gram[:, :m, m:], gram[:, m:, m:]
        inverse: FloatArray = np.asarray(np.linalg.inv(inside), dtype=np.float64)
        weights = inverse @ along[:, :m, None]
        turned = _slope_weights(weights[:, :p, 0])
        pushed = cross @ turned
        followed, doubt = inverse @ pushed, inverse[:, :p, :p]
        curvatures = turned.transpose(0, 2, 1) @ late @ turned - pushed.transpose(0, 2, 1) @ followed
        rest = along[:, m:, None] - cross.transpose(0, 2, 1) @ weights
        slopes = (turned.transpose(0, 2, 1) @ rest)[:, :, 0]
        powers = self.own_powers - np.sum(weights[:, :, 0] * along[:, :m], axis=1)
        return Solved(
            theta, np.maximum(powers, 0.0), slopes, curvatures, weights[:, :p, 0], -followed[:, :p], doubt
        )

    def _products(self, theta: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return inner products of shapes, background and shapes times t, with each other and the signals."""
        tables = [table(t, theta, b) for t, b in zip(self.times_s, self.backgrounds, strict=True)]
        if len(tables) == len(self.signals):
            pairs = list(zip(tables, self.signals, strict=True))
            return np.array([x.T @ x for x, _ in pairs]), np.array([x.T @ y for x, y in pairs])
        gram = np.empty((len(self.signals), tables[0].shape[1], tables[0].shape[1]))
        for which, total in _up_to(tables[0], self._ends):
            gram[which] = total
        return gram, (tables[0].T @ self._padded).T

    def typical(self, theta: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return what theta leaves of the longer half of evenly sampled records, and what it spans.

        Cut to one length: residuals (records, n) and an orthonormal basis (n, shapes and background).
        """
        most = int(np.median(self._ends))
        own = shapes(self.times_s[0][:most], *np.split(theta, 2))
        basis, _ = np.linalg.qr(np.hstack([own, self.backgrounds[0][:most]]))
        y = self._padded[:most, self._ends >= most]
        return np.asarray((y - basis @ (basis.T @ y)).T), basis


def table(t_s: FloatArray, theta: FloatArray, background: FloatArray) -> FloatArray:
    """Return shapes, background and shapes times t beside each other."""
    own = shapes(t_s, *np.split(theta, 2))
    return np.hstack([own, background, t_s[:, None] * own])


def _grid(times_s: list[FloatArray]) -> FloatArray | None:
    """Return the even grid from 0 on that all records lie on; None if they do not."""
    longest = max(times_s, key=len)
    if longest.size < 2:
        return None
    period = float(longest[-1]) / (longest.size - 1)
    grid: FloatArray = np.asarray(period * np.arange(longest.size), dtype=np.float64)
    even = all(np.abs(t - grid[: t.size]).max() <= EVEN_ratio * period for t in times_s)
    return grid if even else None


def _up_to(x: FloatArray, ends: FloatArray) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Yield, for each end that occurs, the records that end there and the inner products up to it."""
    total, last = np.zeros((x.shape[1], x.shape[1])), 0
    for end in np.unique(ends):
        total = total + x[last:end].T @ x[last:end]
        last = end
        yield ends == end, total


def _slope_weights(weights: FloatArray) -> FloatArray:
    """Return how t sin and t cos add up to the slopes by f and by d, (records, 2 modes, 2 modes)."""
    records, p = weights.shape
    k = np.arange(p // 2)
    slopes = np.zeros((records, p, p))
    sines, cosines = weights[:, 0::2], weights[:, 1::2]
    slopes[:, 2 * k, k], slopes[:, 2 * k + 1, k] = -2 * np.pi * cosines, 2 * np.pi * sines
    slopes[:, 2 * k, p // 2 + k], slopes[:, 2 * k + 1, p // 2 + k] = -sines, -cosines
    return slopes


def _block_diagonal(blocks: list[FloatArray]) -> FloatArray:
    whole = np.zeros((sum(len(b) for b in blocks), sum(b.shape[1] for b in blocks)))
    row = column = 0
    for block in blocks:
        whole[row : row + len(block), column : column + block.shape[1]] = block
        row, column = row + len(block), column + block.shape[1]
    return whole

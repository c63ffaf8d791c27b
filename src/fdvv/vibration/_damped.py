"""Decaying sinusoids on given times: their shapes, their least squares, and what noise leaves of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.errors import FitError, ModelError
from fdvv.units import FloatArray

MOST_STEPS = 25
"""Of the search; a fit that needs more has no clear minimum, and its standard errors say so."""


@dataclass(frozen=True)
class DampedMode:
    """One measured decaying sinusoid A exp(-d t) sin(2 pi f t + phase), t from the start of its record.

    Attributes
    ----------
    frequency_Hz, decay_1_s : f and d.
    amplitude : A in the signal's own unit; of several records, the root mean square over them.
    phase_rad : of the first record.
    frequency_sd_Hz, decay_sd_1_s, amplitude_sd : standard errors, from the noise that the fit left.
    """

    frequency_Hz: float
    decay_1_s: float
    amplitude: float
    phase_rad: float
    frequency_sd_Hz: float
    decay_sd_1_s: float
    amplitude_sd: float

    @property
    def duration_s(self) -> float:
        """Time in which the envelope falls to a tenth, ln 10 / d; infinite without decay."""
        return duration_s(self.decay_1_s)


@dataclass(frozen=True)
class DampedFit:
    """What a fit of decaying sinusoids gave.

    Attributes
    ----------
    modes : by falling amplitude.
    amplitudes : (records, modes) of each record.
    noise : rms of what the fit leaves, degrees of freedom taken off.
    samples : that were fitted.
    bic : samples ln(residual power) + parameters ln(samples); smaller is better, for the same samples.
    """

    modes: tuple[DampedMode, ...]
    amplitudes: FloatArray
    noise: float
    samples: int
    bic: float


def duration_s(decay_1_s: float) -> float:
    """Give the time in which exp(-d t) falls to a tenth; 15 ms at 239 Hz and a tenth of critical damping."""
    return math.log(10.0) / decay_1_s if decay_1_s > 0 else math.inf


def shapes(t_s: FloatArray, frequency_Hz: FloatArray, decay_1_s: FloatArray) -> FloatArray:
    """Give exp(-d t) sin and exp(-d t) cos of each mode, (n, 2 modes), 0 before t = 0."""
    t = np.maximum(t_s, 0.0)[:, None]
    fall = np.exp(-decay_1_s * t) * (t_s >= 0)[:, None]
    turn = 2 * np.pi * frequency_Hz * t
    return np.stack([fall * np.sin(turn), fall * np.cos(turn)], axis=2).reshape(t_s.size, -1)


def polynomial(t_s: FloatArray, degree: int) -> FloatArray:
    """Give Legendre polynomials over the span of t_s, (n, degree + 1); none for degree -1."""
    if degree < 0 or t_s.size == 0:
        return np.empty((t_s.size, 0))
    middle, half = 0.5 * (t_s[0] + t_s[-1]), 0.5 * max(float(t_s[-1] - t_s[0]), 1e-12)
    return np.polynomial.legendre.legvander((t_s - middle) / half, degree)


def _slopes(t_s: FloatArray, own: FloatArray, weight: FloatArray) -> FloatArray:
    """Give the slopes of the weighted shapes by each f, then by each d, (n, 2 modes)."""
    sines, cosines = own[:, 0::2], own[:, 1::2]
    by_f = 2 * np.pi * t_s[:, None] * (cosines * weight[0::2] - sines * weight[1::2])
    by_d = -t_s[:, None] * (sines * weight[0::2] + cosines * weight[1::2])
    return np.hstack([by_f, by_d])


def _block_diagonal(blocks: list[FloatArray]) -> FloatArray:
    whole = np.zeros((sum(len(b) for b in blocks), sum(b.shape[1] for b in blocks)))
    row = column = 0
    for block in blocks:
        whole[row : row + len(block), column : column + block.shape[1]] = block
        row, column = row + len(block), column + block.shape[1]
    return whole


class _Records:
    """Several records that share frequencies and decays; amplitudes, phases and background are their own."""

    def __init__(
        self, times_s: Sequence[FloatArray], signals: Sequence[FloatArray], degree: int, one_phase: bool
    ) -> None:
        # the search stops at an absolute slope, so that it needs signals of a size of its own
        self.size = (
            math.sqrt(sum(float(y @ y) for y in signals) / max(sum(y.size for y in signals), 1)) or 1.0
        )
        self.times_s, self.signals = times_s, [y / self.size for y in signals]
        self.backgrounds = [polynomial(t, degree) for t in times_s]
        if one_phase:
            # one record with all samples, in which each press keeps a background of its own
            self.times_s, self.signals = [np.concatenate(times_s)], [np.concatenate(self.signals)]
            self.backgrounds = [_block_diagonal(self.backgrounds)]
        self.samples = sum(t.size for t in times_s)

    def solve(self, theta: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Give residuals, their slopes by f and d, and (records, 2 modes) weights of sin and cos.

        The slopes are Kaufman's (1975): those of the shapes, with what the weights can follow taken off.
        """
        f, d = np.split(theta, 2)
        left, slopes, weights = [], [], []
        for t, y, background in zip(self.times_s, self.signals, self.backgrounds, strict=True):
            own = shapes(t, f, d)
            q, r = np.linalg.qr(np.hstack([own, background]))
            along = q.T @ y
            weight = np.linalg.lstsq(r, along, rcond=None)[0][: own.shape[1]]
            left.append(y - q @ along)
            slope = _slopes(t, own, weight)
            slopes.append(q @ (q.T @ slope) - slope)
            weights.append(weight)
        return np.concatenate(left), np.concatenate(slopes), np.array(weights)

    def parameters(self, modes: int) -> int:
        return 2 * modes + sum(2 * modes + int(b.shape[1]) for b in self.backgrounds)


def fit_damped(
    times_s: Sequence[FloatArray],
    signals: Sequence[FloatArray],
    frequency_Hz: Sequence[float],
    decay_1_s: Sequence[float],
    degree: int = -1,
    one_phase: bool = False,
) -> DampedFit:
    """Fit decaying sinusoids that several records share, by least squares from a first guess.

    times_s, signals : one array each per record, times from the moment that the modes start, even or not.
    frequency_Hz, decay_1_s : first guess, one of each per mode.
    degree : of the polynomial that each record may have beneath; -1 for none.
    one_phase : the records share amplitudes and phases too. Only then do records that were sampled at
        different phases fill each other's gaps: with phases of their own, f and its alias fit equally well.

    Weights are solved exactly at each step (variable projection, Golub and Pereyra 1973), so only f and d
    are searched. Raises FitError if there are fewer samples than parameters.
    """
    from scipy.optimize import least_squares

    records = _Records(times_s, signals, degree, one_phase)
    f0, d0 = np.asarray(frequency_Hz, dtype=np.float64), np.asarray(decay_1_s, dtype=np.float64)
    needed = records.parameters(f0.size)
    if records.samples <= needed or not f0.size:
        raise FitError(f"{f0.size} decaying sinusoids need more than {needed} samples, got {records.samples}")
    start = np.concatenate([f0, np.maximum(d0, 1e-3)])

    def left(theta: FloatArray) -> FloatArray:
        return records.solve(theta)[0]

    def slopes(theta: FloatArray) -> FloatArray:
        return records.solve(theta)[1]

    scale = np.maximum(np.abs(start), 1.0)
    found = least_squares(left, start, jac=slopes, x_scale=scale, bounds=(0.0, np.inf), max_nfev=MOST_STEPS)
    return _summary(records, np.asarray(found.x))


def _summary(records: _Records, theta: FloatArray) -> DampedFit:
    left, jacobian, weights = records.solve(theta)
    modes, needed = theta.size // 2, records.parameters(theta.size // 2)
    power = float(left @ left) / (records.samples - needed)
    covariance = np.asarray(power * np.linalg.pinv(jacobian.T @ jacobian), dtype=np.float64)
    sd = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    sines, cosines = weights[:, 0::2], weights[:, 1::2]
    amplitudes = np.hypot(sines, cosines)
    errors = _weight_variance(records, theta, covariance, power)
    total = np.sqrt(np.mean(amplitudes**2, axis=0))
    spread = np.sqrt(np.mean((amplitudes / np.maximum(total, 1e-300)) ** 2 * errors, axis=0) / len(weights))
    made = [
        DampedMode(
            float(theta[k]), float(theta[modes + k]), records.size * float(total[k]),
            float(math.atan2(cosines[0, k], sines[0, k])), float(sd[k]), float(sd[modes + k]),
            records.size * float(spread[k]),
        )
        for k in np.argsort(-total)
    ]  # fmt: skip
    mean_power = max(records.size**2 * float(left @ left) / records.samples, 1e-300)
    bic = records.samples * math.log(mean_power) + needed * math.log(records.samples)
    sizes, noise = records.size * amplitudes[:, np.argsort(-total)], records.size * math.sqrt(power)
    return DampedFit(tuple(made), sizes, noise, records.samples, bic)


def _weight_variance(
    records: _Records, theta: FloatArray, covariance: FloatArray, power: float
) -> FloatArray:
    """Give the variance of each amplitude, (records, modes): of the weights, and what f and d add to it."""
    modes = theta.size // 2
    base = records.solve(theta)[2]
    steps = 1e-5 * np.maximum(np.abs(theta), 1.0)
    slopes = np.array(
        [(records.solve(theta + step * unit)[2] - base) / step
         for step, unit in zip(steps, np.eye(theta.size), strict=True)]
    )  # fmt: skip
    found = np.zeros((len(base), modes))
    for r, (t, background) in enumerate(zip(records.times_s, records.backgrounds, strict=True)):
        matrix = np.hstack([shapes(t, *np.split(theta, 2)), background])
        own = power * np.linalg.pinv(matrix.T @ matrix)[: 2 * modes, : 2 * modes]
        total = own + slopes[:, r].T @ covariance @ slopes[:, r]
        for k in range(modes):
            pair = slice(2 * k, 2 * k + 2)
            way = base[r, pair] / max(float(np.hypot(*base[r, pair])), 1e-300)
            found[r, k] = way @ total[pair, pair] @ way
    return found


def cramer_rao(
    times_s: Sequence[FloatArray], mode: tuple[float, float, float, float], noise: float, degree: int = -1
) -> tuple[float, float]:
    """Give the least standard errors (Hz, 1/s) with which white noise lets f and d be known.

    times_s : one array per record, times after the start of the mode.
    mode : f (Hz), d (1/s), amplitude and phase (rad); the latter two are unknown in each record.
    noise : rms per sample, in the unit of the amplitude.
    degree : of the unknown polynomial beneath each record; -1 for none.

    Infinite where the records are too short to tell anything.
    """
    f, d, amplitude, phase = mode
    if noise <= 0 or amplitude <= 0:
        raise ModelError(f"noise and amplitude must be above 0, got {noise} and {amplitude}")
    fisher = np.zeros((2, 2))
    for t in times_s:
        fall, turn = np.exp(-d * t), 2 * np.pi * f * t + phase
        slopes = amplitude * np.stack([2 * np.pi * t * fall * np.cos(turn), -t * fall * np.sin(turn)], axis=1)
        free = np.hstack([shapes(t, np.array([f]), np.array([d])), polynomial(t, degree)])
        slopes -= free @ np.linalg.lstsq(free, slopes, rcond=None)[0]
        fisher += slopes.T @ slopes / noise**2
    if np.linalg.cond(fisher) > 1 / np.finfo(np.float64).eps:
        return math.inf, math.inf
    bound = np.sqrt(np.diag(np.linalg.inv(fisher)))
    return float(bound[0]), float(bound[1])

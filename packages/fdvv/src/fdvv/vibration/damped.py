"""Decaying sinusoids on given times: their shapes, their least squares, and what noise leaves of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fdvv.errors import FitError, ModelError
from fdvv.units import FloatArray
from fdvv.vibration.projection import Records, Solved, polynomial, shapes

MOST_STEPS = 25
"""Of the search; a fit that needs more has no clear minimum, and its standard errors say so."""
FIRST_DAMPING, MOST_DAMPING = 1e-2, 1e6
NEAR_ratio, SETTLED = 1e-9, 1e-4
"""A search ends with a step this small, or that gains this part of the noise power of one sample."""
DECAYS = (0.5, 2.0, 8.0)
"""Decays that are tried first, in lives per record."""


@dataclass(frozen=True)
class DampedMode:
    """One measured decaying sinusoid A exp(-d t) sin(2 pi f t + phase), t from the start of its record.

    Attributes
    ----------
    frequency_Hz, decay_1_s : f and d.
    amplitude : A in the signal's own unit; of several records, the median over them.
    phase_rad : of the first record.
    frequency_sd_Hz, decay_sd_1_s, amplitude_sd : standard errors, from the noise that the fit left, or from
        how records differ where that says more.
    frequency_spread_Hz, decay_spread_1_s : standard deviations between records; None for a single one.
    """

    frequency_Hz: float
    decay_1_s: float
    amplitude: float
    phase_rad: float
    frequency_sd_Hz: float
    decay_sd_1_s: float
    amplitude_sd: float
    frequency_spread_Hz: float | None = None
    decay_spread_1_s: float | None = None

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
    """Return the time in which exp(-d t) falls to a tenth."""
    return math.log(10.0) / decay_1_s if decay_1_s > 0 else math.inf


def fit_damped(
    times_s: Sequence[FloatArray],
    signals: Sequence[FloatArray],
    frequency_Hz: Sequence[float],
    decay_1_s: Sequence[float],
    degree: int = -1,
    same_phase: bool = False,
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
    records = Records(times_s, signals, degree, same_phase)
    start = np.concatenate([np.asarray(frequency_Hz, dtype=np.float64), np.maximum(decay_1_s, 1e-3)])
    return fit_records(records, start)


def fit_records(records: Records, start: FloatArray, held: npt.NDArray[np.bool_] | None = None) -> DampedFit:
    """Fit decaying sinusoids from a first guess (f..., d...), of which those held stay. Raises FitError."""
    modes = start.size // 2
    needed = records.parameters(modes)
    if records.samples <= needed or not modes:
        raise FitError(f"{modes} decaying sinusoids need more than {needed} samples, got {records.samples}")
    try:
        free = np.ones(start.size, dtype=bool) if held is None else ~held
        return _summary(records, _descend(records, start, free), free)
    except np.linalg.LinAlgError as error:
        raise FitError(f"{modes} decaying sinusoids cannot be separated in the records") from error


def _descend(records: Records, start: FloatArray, free: npt.NDArray[np.bool_]) -> Solved:
    """Search for the least squares (Levenberg and Marquardt), neither frequencies nor decays below 0."""
    at, damping = records.at(start), FIRST_DAMPING
    freedom = max(records.samples - records.parameters(start.size // 2), 1)
    for _ in range(MOST_STEPS if free.any() else 0):
        slope, curvature = at.slopes.sum(axis=0)[free], at.curvatures.sum(axis=0)[np.ix_(free, free)]
        stiff = curvature + damping * np.diag(np.maximum(np.diag(curvature), 1e-300))
        theta = at.theta.copy()
        theta[free] = np.maximum(theta[free] + np.linalg.solve(stiff, slope), 0.0)
        theta[theta.size // 2 :] = np.minimum(theta[theta.size // 2 :], records.most_decay_1_s)
        tried = None
        with suppress(np.linalg.LinAlgError):
            tried = records.at(theta)
        if tried is None or tried.power > at.power:
            damping *= 10
        else:
            gained = at.power - tried.power
            moved = np.max(np.abs(theta - at.theta) / np.maximum(np.abs(theta), 1.0))
            at, damping = tried, 0.1 * damping
            if moved < NEAR_ratio or gained < SETTLED * at.power / freedom:
                break
        if damping > MOST_DAMPING:
            break
    return at


def _summary(records: Records, solved: Solved, free: npt.NDArray[np.bool_]) -> DampedFit:
    modes = solved.theta.size // 2
    f, d = np.split(solved.theta, 2)
    needed = records.parameters(modes)
    power = solved.power / (records.samples - needed)
    inner = np.ix_(free, free)
    covariance = np.zeros(solved.curvatures.shape[1:])
    covariance[inner] = power * np.linalg.pinv(solved.curvatures.sum(axis=0)[inner], hermitian=True)
    spreads = between_records(solved, free)
    sd = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    if spreads is not None:
        sd = np.maximum(sd, spreads / math.sqrt(len(solved.weights)))
    sines, cosines = solved.weights[:, 0::2], solved.weights[:, 1::2]
    # what each record has at its first sample, drawn back to the moment that the modes start
    amplitudes = np.hypot(sines, cosines) * np.exp(d * records.starts_s[:, None])
    phases = np.arctan2(cosines[0], sines[0]) - 2 * np.pi * f * records.starts_s[0]
    doubts = np.sqrt(amplitude_variances(records, solved, covariance, power))
    # of the median: a record that ends early may hold no amplitude at all
    total = np.median(amplitudes, axis=0)
    spread = np.median(amplitudes * doubts, axis=0) * math.sqrt(
        (np.pi / 2 if len(doubts) > 2 else 1) / len(doubts)
    )
    order = np.argsort(-total)
    made = [
        DampedMode(
            float(f[k]), float(d[k]), records.size * float(total[k]),
            float(np.angle(np.exp(1j * phases[k]))), float(sd[k]), float(sd[modes + k]),
            records.size * float(spread[k]),
            *(None if spreads is None else float(spreads[i]) for i in (k, modes + k)),
        )
        for k in order
    ]  # fmt: skip
    size, samples = records.size, records.samples
    mean_power = max(size**2 * solved.power / samples, 1e-300)
    bic = samples * math.log(mean_power) + needed * math.log(samples)
    return DampedFit(tuple(made), size * amplitudes[:, order], size * math.sqrt(power), samples, bic)


def between_records(solved: Solved, free: npt.NDArray[np.bool_]) -> FloatArray | None:
    """Return the standard deviations between records of f and d, (p,), 0 where fixed; None for one record.

    From one step of the search without each record (a jackknife), times the root of their number.
    """
    records = len(solved.weights)
    if records < 2:
        return None
    each = solved.curvatures[:, free][:, :, free]
    # small against any curvature, so that a step along what only one record determines stays finite
    least = 1e-9 * np.trace(each.sum(axis=0)) / max(free.sum(), 1) * np.eye(int(free.sum()))
    steps = -np.linalg.solve(each.sum(axis=0) - each + least, solved.slopes[:, free, None])[:, :, 0]
    spreads = np.zeros(free.size)
    spreads[free] = math.sqrt(records - 1) * np.sqrt(np.sum((steps - steps.mean(axis=0)) ** 2, axis=0))
    return spreads


def amplitude_variances(records: Records, solved: Solved, covariance: FloatArray, power: float) -> FloatArray:
    """Return variances of the logarithms of amplitudes, (records, modes): their own, and those of f and d."""
    modes = solved.theta.size // 2
    variances = np.zeros((len(solved.weights), modes))
    for k in range(modes):
        pair = slice(2 * k, 2 * k + 2)
        size = np.maximum(np.hypot(*solved.weights[:, pair].T), 1e-300)
        way = solved.weights[:, pair] / size[:, None]
        by_theta = np.einsum("ri,rip->rp", way, solved.weights_by_theta[:, pair]) / size[:, None]
        by_theta[:, modes + k] += records.starts_s
        own = power * np.einsum("ri,rij,rj->r", way, solved.weight_doubt[:, pair, pair], way) / size**2
        variances[:, k] = own + np.einsum("rp,pq,rq->r", by_theta, covariance, by_theta)
    return np.maximum(variances, 0.0)


def cramer_rao(
    times_s: Sequence[FloatArray], mode: tuple[float, float, float, float], noise: float, degree: int = -1
) -> tuple[float, float]:
    """Return the least standard errors (Hz, 1/s) with which white noise lets f and d be known.

    times_s : one array per record, times after the start of the mode.
    mode : f (Hz), d (1/s), amplitude and phase (rad); the latter two are unknown in each record.
    noise : rms per sample, in the unit of the amplitude.
    degree : of the unknown polynomial beneath each record; -1 for none.

    Infinite where the records are too short to determine anything.
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


def fit_decaying_sinusoid(
    t_s: npt.ArrayLike, signal: npt.ArrayLike, degree: int = -1, lowest_Hz: float | None = None
) -> DampedFit:
    """Fit one decaying sinusoid by least squares; the fit has one mode.

    t_s, signal : (n,) from the onset on, rising; even spacing is not needed.
    degree : of a polynomial beneath, -1 for none.
    lowest_Hz : where the search begins; one period of the record if None.

    The record's own spectrum on a grid of frequencies, at three decays, gives the first guess. Raises
    FitError if there are too few samples.
    """
    t, y = np.asarray(t_s, dtype=np.float64), np.asarray(signal, dtype=np.float64)
    if t.shape != y.shape or t.ndim != 1 or t.size < 2 or np.any(np.diff(t) <= 0):
        raise ModelError(f"a signal needs one value at each of rising times, got {y.shape} at {t.shape}")
    length = float(t[-1] - t[0])
    fits = []
    for lives in DECAYS:
        loudest_Hz = _loudest_Hz(t, y * np.exp(-lives * (t - t[0]) / length), lowest_Hz)
        fits.append(fit_damped([t], [y], [loudest_Hz], [lives / length], degree))
    return min(fits, key=lambda fit: fit.bic)


def _loudest_Hz(t: FloatArray, y: FloatArray, lowest_Hz: float | None) -> float:
    """Return the frequency with the largest spectrum up to half the mean rate, four points to a line."""
    length = float(t[-1] - t[0])
    step, highest = 0.25 / length, 0.5 * (t.size - 1) / length
    grid = np.arange(lowest_Hz or 1 / length, highest, step)
    if not grid.size:
        return 1 / length
    return float(grid[np.argmax(np.abs(np.exp(-2j * np.pi * np.outer(grid, t)) @ (y - y.mean())))])

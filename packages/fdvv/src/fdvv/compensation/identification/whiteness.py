"""Is what the model leaves white? If not, the model lacks something, and the standard errors are too small.

Two tests on whitened residuals: a cumulative periodogram (Bartlett 1955; Durbin 1969) over time, and a score
test (Rao 1948) for a force that repeats over displacement and differs between press and release.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.compensation.identification.balance import (
    LAG,
    NUMBER_COUNT,
    SLIDING_mm_s,
    convolve_columns,
    windows,
)
from fdvv.compensation.identification.estimation import RigEstimation, Unknown, WindowRun, whiten_runs
from fdvv.compensation.identification.own_force import hats
from fdvv.force_text import force_text
from fdvv.units import FloatArray

CHANCE = 1e-3
"""Probability of a false alarm of each test."""
KOLMOGOROV = 1.949
"""Bound of the cumulative periodogram at CHANCE, times the square root of its frequencies."""
EVERY = 2
"""Every second value of the own force has one of the direction beside it."""
REPEATS = 2.0
"""Times its bound by chance: play and lags are linear in the model, not in a rig, which repeats a little."""
NOTICED_cN = 1.5
"""A smaller repeating force is not reported."""
SPREAD_cN = 5.0
SLOW_ratio = 0.1
"""Part of the frequencies that carries what the numbers are estimated from."""


@dataclass(frozen=True)
class Whiteness:
    """Result of both tests.

    Attributes
    ----------
    periodogram : largest excess of the cumulative periodogram at low frequencies, times the square root of
        the number of frequencies; KOLMOGOROV by chance.
    slow_ratio : power of the slow residuals, in that of white ones; standard errors grow with its root.
    repeating : statistic of the score test over its bound; above REPEATS it fails.
    repeating_cN, repeating_mm : rms of the force that repeats, and where it is largest.
    """

    periodogram: float
    slow_ratio: float
    repeating: float
    repeating_cN: float
    repeating_mm: float

    @property
    def misfit(self) -> str:
        """What the model lacks and what to do, in one sentence; empty if nothing shows."""
        if self.repeating > REPEATS and self.repeating_cN > NOTICED_cN:
            return (
                f"the residual repeats over displacement: {force_text(self.repeating_cN, '.1f')} rms that "
                "change sign "
                f"between press and release, most at {self.repeating_mm:.1f} mm, which no number describes; "
                "look for something that binds or rubs there, then identify again"
            )
        if self.periodogram > KOLMOGOROV:
            return (
                f"the residual is not white (cumulative periodogram {self.periodogram:.1f}, at most "
                f"{KOLMOGOROV:.1f} by chance): a force acts that no number describes, and the standard "
                f"errors are {self.widening**0.5:.1f} times larger for it; press again and compare"
            )
        return ""

    @property
    def widening(self) -> float:
        """Factor of the variances: the slow residuals are what the numbers are estimated from."""
        return max(1.0, self.slow_ratio) if self.periodogram > KOLMOGOROV else 1.0


def whiteness_of(problem: RigEstimation, numbers: FloatArray) -> Whiteness:
    """Test the residuals of an identification."""
    from scipy.stats import chi2

    spans = problem.spans(numbers)
    row = problem.autocovariance(numbers, max(rows.size for _, rows in spans), Unknown(), discount=False)
    runs, presses = whiten_runs(spans, row), problem.slopes(numbers)
    residual = np.concatenate([run.white @ presses[run.press][0][run.rows] for run in runs])
    excess, slow_ratio = _periodogram(residual)
    own, curve, pull = _score(problem, numbers, runs, presses)
    level = max(1.0, float(np.mean(residual**2)))
    statistic = float(pull @ np.linalg.solve(curve, pull)) / level
    size = np.linalg.solve(curve / level + np.eye(pull.size) / SPREAD_cN**2, pull / level)
    at = EVERY * problem.own_step_mm * int(np.abs(size).argmax())
    bound = float(chi2.isf(CHANCE, own))
    return Whiteness(excess, slow_ratio, statistic / bound, float(np.sqrt(np.mean(size**2))), at)


def _periodogram(residual: FloatArray) -> tuple[float, float]:
    """Return the excess of low frequencies, and their power against that of white noise of the same rms.

    Fitted numbers take power from the low frequencies: their bound counts the rest alone.
    """
    power = np.abs(np.fft.rfft(residual - residual.mean()))[1:-1] ** 2
    free = max(1.0, power.size - 0.5 * NUMBER_COUNT)
    excess = np.cumsum(power) / power.sum() - np.arange(1, power.size + 1) / power.size
    slow = power[: max(1, round(SLOW_ratio * power.size))]
    return float(excess.max() * np.sqrt(free)), float(slow.mean() / np.median(power) * np.log(2.0))


def _score(
    problem: RigEstimation,
    numbers: FloatArray,
    runs: list[WindowRun],
    presses: list[tuple[FloatArray, FloatArray]],
) -> tuple[int, FloatArray, FloatArray]:
    """Return degrees of freedom, curvature and gradient of forces with direction, the numbers free."""
    added = [_direction_columns(problem, numbers, i) for i in range(len(problem.ticks))]
    parts = [
        [run.white @ column[run.rows] for column in (added[run.press], *presses[run.press])] for run in runs
    ]
    force, residual, slope = (np.concatenate([part[i] for part in parts]) for i in range(3))
    slope = slope @ problem.root
    inner = slope.T @ slope + np.eye(slope.shape[1])
    share = np.linalg.solve(inner, slope.T @ force).T
    prior = problem.unroot @ (numbers - problem.mean)
    pull = force.T @ residual - share @ (slope.T @ residual - prior)
    curve = force.T @ force - share @ (slope.T @ force)
    return pull.size, curve + 1e-6 * np.trace(curve) * np.eye(pull.size), pull


def _direction_columns(problem: RigEstimation, numbers: FloatArray, press: int) -> FloatArray:
    """Return the columns of forces that change sign with the direction, (n, k)."""
    ticks = problem.ticks[press]
    _, velocity, acceleration, _ = ticks.motion
    way = np.tanh((velocity + numbers[LAG] * acceleration) / SLIDING_mm_s)
    x = ticks.ahead_mm(numbers[LAG])
    wide = hats(x, EVERY * problem.own_step_mm)[:, : (problem.nodes - 1) // EVERY + 1]
    return convolve_columns(windows(ticks.tick_s)[0], wide * way[:, np.newaxis])

"""The timing of tapping people: fitted on some, judged on others, against simpler guesses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.errors import FitError
from fdvv.optimize._taps import Taps
from fdvv.units import FloatArray

FEWEST = 20
"""Taps that a spread needs."""


@dataclass(frozen=True)
class TimingFit:
    """What people who tap have in common, and how they differ. A clock whose spread grows with the period.

    Attributes
    ----------
    clock_ratio : spread of a tap over the period, the middle person.
    clock_spread : between people, of its logarithm.
    bias_ms, bias_ratio : mean asynchrony, and its slope over the period.
    bias_spread_ms : between people, at the shortest period.
    gain : share of an asynchrony that the next tap makes up for, the middle person at the shortest period.
    gain_spread : between people, straight.
    """

    clock_ratio: float
    clock_spread: float
    bias_ms: float
    bias_ratio: float
    bias_spread_ms: float
    gain: float
    gain_spread: float


BAATH = TimingFit(0.06245, 0.2544, -14.06, -0.0288, 18.07, 0.5463, 0.1554)
"""fit_timing() of 15 of the people of Baath and Madison (2012), whose data are under the MIT licence."""


def person_spreads_ms(taps: Taps) -> FloatArray:
    """Give the spread of each person at each period, (people, periods); NaN where there are too few taps."""
    cells = [[taps.of([one], period).late_ms for period in taps.periods_ms] for one in taps.people]
    return np.array([[_spread(cell) for cell in row] for row in cells])


def fit_timing(taps: Taps) -> TimingFit:
    """Fit it by the middle of people and periods. FitError if nobody tapped often enough."""
    spreads, periods = person_spreads_ms(taps), np.array(taps.periods_ms)
    ratios = np.log(spreads / periods)
    if np.isnan(ratios).all() or len(taps.people) < 2:
        raise FitError(f"timing needs two people of {FEWEST} taps, got {len(taps.people)}")
    own = np.nanmean(ratios, axis=1)
    biases = np.array([[_mean(taps.of([one], p).late_ms) for p in taps.periods_ms] for one in taps.people])
    slope, start = _line(periods, np.nanmean(biases, axis=0))
    gains = np.array([1 - _carried(taps.of([one], taps.periods_ms[0])) for one in taps.people])
    return TimingFit(
        float(np.exp(np.nanmean(own))),
        float(np.nanstd(own, ddof=1)),
        start,
        slope,
        float(np.nanstd(biases[:, 0], ddof=1)),
        float(np.nanmedian(gains)),
        float(np.nanstd(gains, ddof=1)),
    )


def timing_log_likelihood(fit: TimingFit, taps: Taps) -> float:
    """Give the mean log-likelihood of a tap (nats) of people whom the fit does not know."""
    mean = fit.bias_ms + fit.bias_ratio * taps.period_ms
    # between people both bias and spread differ; a normal of the whole variance stands for the mixture
    grown = np.exp(2 * fit.clock_spread**2)
    variance = (fit.clock_ratio * taps.period_ms) ** 2 * grown + fit.bias_spread_ms**2
    return _log_likelihood(taps.late_ms, mean, variance)


def pooled_log_likelihood(known: Taps, taps: Taps) -> float:
    """Give the same of one normal for all periods, fitted on known people: the simple guess."""
    return _log_likelihood(
        taps.late_ms, np.full(1, known.late_ms.mean()), np.full(1, known.late_ms.var(ddof=1))
    )


def spread_error_ratio(guess_ms: FloatArray, taps: Taps) -> float:
    """Give how far people's spreads are from a guess per period, (periods,): rms of the log ratio."""
    miss = np.log(person_spreads_ms(taps) / guess_ms)
    return float(np.sqrt(np.nanmean(miss**2)))


def _log_likelihood(values: FloatArray, mean: FloatArray, variance: FloatArray) -> float:
    return float(np.mean(-0.5 * (np.log(2 * np.pi * variance) + (values - mean) ** 2 / variance)))


def _spread(values: FloatArray) -> float:
    return float(np.std(values, ddof=1)) if values.size >= FEWEST else np.nan


def _mean(values: FloatArray) -> float:
    return float(np.mean(values)) if values.size >= FEWEST else np.nan


def _line(x: FloatArray, y: FloatArray) -> tuple[float, float]:
    fine = ~np.isnan(y)
    if fine.sum() < 2:
        return 0.0, float(np.nanmean(y))
    slope, start = np.polyfit(x[fine], y[fine], 1)
    return float(slope), float(start)


def _carried(taps: Taps) -> float:
    """Give the share of a tap's asynchrony that the next one still has, within trials about their means."""
    if taps.late_ms.size < FEWEST:
        return np.nan
    off = taps.late_ms.copy()
    for trial in np.unique(taps.trial):
        off[taps.trial == trial] -= off[taps.trial == trial].mean()
    same = taps.trial[1:] == taps.trial[:-1]
    return float(np.sum((off[1:] * off[:-1])[same]) / np.sum((off[:-1] ** 2)[same]))

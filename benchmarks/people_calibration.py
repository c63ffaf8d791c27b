"""The timing of tapping people: fitted on some, judged on others, against simpler guesses."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fdvv.errors import FitError, InputError
from fdvv.recording.read import read_log
from fdvv.recording.types import Quantity
from fdvv.units import FloatArray

COLUMNS = ["subject", "trial", "isi", "asynch"]


@dataclass(frozen=True, eq=False)
class Taps:
    """Asynchronies, every column (n,) in the order of tapping.

    Attributes
    ----------
    person, trial : who, in which trial. period_ms : of the metronome. late_ms : tap - beat.
    """

    person: FloatArray
    trial: FloatArray
    period_ms: FloatArray
    late_ms: FloatArray

    @property
    def people(self) -> tuple[int, ...]:
        return tuple(int(one) for one in np.unique(self.person))

    @property
    def periods_ms(self) -> tuple[float, ...]:
        return tuple(np.unique(self.period_ms).tolist())

    def of(self, people: Collection[int], period_ms: float | None = None) -> Taps:
        """Keep the taps of some people, and of one period if given."""
        keep = np.isin(self.person, list(people))
        if period_ms is not None:
            keep &= self.period_ms == period_ms
        return Taps(self.person[keep], self.trial[keep], self.period_ms[keep], self.late_ms[keep])


def read_taps(path: Path) -> Taps:
    """Read columns subject, trial, isi, asynch (ms), as Baath and Madison's data have them (MIT).

    Taps further than half a period from their beat belong to no beat and are left out. InputError.
    """
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    if not lines or lines[0].split(",") != COLUMNS:
        raise InputError(path, "line 1", "no table of taps", f"give the columns {','.join(COLUMNS)}")
    try:
        table = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:] if line])
        person, trial, period, late = table.reshape(-1, len(COLUMNS)).T
    except ValueError as error:
        reason = f"a row cannot be read ({error})"
        raise InputError(path, "table", reason, "give four numbers a row") from error
    near = np.abs(late) < period / 2
    return Taps(person[near], trial[near], period[near], late[near])


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
    """Return the spread by person and period, (people, periods); NaN where there are too few taps."""
    return _by_person(taps, lambda late_ms: np.std(late_ms, ddof=1))


def _by_person(taps: Taps, statistic: Callable[[FloatArray], Any]) -> FloatArray:
    cells = [[taps.of([one], period).late_ms for period in taps.periods_ms] for one in taps.people]
    return np.array([[statistic(cell) if cell.size >= FEWEST else np.nan for cell in row] for row in cells])


def fit_timing(taps: Taps) -> TimingFit:
    """Fit it by the middle of people and periods. Raises FitError if nobody tapped often enough."""
    spreads, periods = person_spreads_ms(taps), np.array(taps.periods_ms)
    ratios = np.log(spreads / periods)
    if np.isnan(ratios).all() or len(taps.people) < 2:
        raise FitError(f"timing needs two people of {FEWEST} taps, got {len(taps.people)}")
    own = np.nanmean(ratios, axis=1)
    biases = _by_person(taps, np.mean)
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
    """Return the mean log-likelihood of a tap (nats) of people whom the fit does not know."""
    mean = fit.bias_ms + fit.bias_ratio * taps.period_ms
    # between people both bias and spread differ; a normal of the whole variance stands for the mixture
    grown = np.exp(2 * fit.clock_spread**2)
    variance = (fit.clock_ratio * taps.period_ms) ** 2 * grown + fit.bias_spread_ms**2
    return _log_likelihood(taps.late_ms, mean, variance)


def pooled_log_likelihood(known: Taps, taps: Taps) -> float:
    """Return the same of one normal for all periods, fitted on known people: the simple guess."""
    return _log_likelihood(taps.late_ms, known.late_ms.mean(), known.late_ms.var(ddof=1))


def spread_error_ratio(guess_ms: FloatArray, taps: Taps) -> float:
    """Return how far people's spreads are from a guess per period, (periods,): rms of the log ratio."""
    miss = np.log(person_spreads_ms(taps) / guess_ms)
    return float(np.sqrt(np.nanmean(miss**2)))


def _log_likelihood(values: FloatArray, mean: Any, variance: Any) -> float:
    return float(np.mean(-0.5 * (np.log(2 * np.pi * variance) + (values - mean) ** 2 / variance)))


def _line(x: FloatArray, y: FloatArray) -> tuple[float, float]:
    fine = ~np.isnan(y)
    if fine.sum() < 2:
        return 0.0, float(np.nanmean(y))
    slope, start = np.polyfit(x[fine], y[fine], 1)
    return float(slope), float(start)


def _carried(taps: Taps) -> float:
    """Return the share of a tap's asynchrony that the next one still has, within trials about their means."""
    if taps.late_ms.size < FEWEST:
        return np.nan
    off = taps.late_ms.copy()
    for trial in np.unique(taps.trial):
        off[taps.trial == trial] -= off[taps.trial == trial].mean()
    same = taps.trial[1:] == taps.trial[:-1]
    return float(np.sum((off[1:] * off[:-1])[same]) / np.sum((off[:-1] ** 2)[same]))


APART_s = 2e-3
"""Samples further apart belong to different taps."""
FEWEST_TAPS = 10
"""Taps that a trial needs to count."""


def tap_peaks(path: Path) -> FloatArray:
    """Return the largest count of each tap of a ForcePeaks log, (taps,); empty where the log tells no times.

    A tap whose every sample is 0 was never heard by the sensor and is left out. InputError.
    """
    streams = (stream for take in read_log(path).takes for stream in take.of(Quantity.COUNTS))
    stream = next((stream for stream in streams if stream.clock == "board"), None)
    if stream is None:
        return np.zeros(0)
    cuts = np.flatnonzero(np.diff(stream.t_s) > APART_s) + 1
    peaks = np.array([piece.max() for piece in np.split(stream.raw.astype(np.float64), cuts)])
    return peaks[peaks > 0]


def force_spread_ratio(paths: Sequence[Path]) -> float:
    """Return the spread of a person's taps within a trial over its mean, the middle of trials. FitError.

    The counts are of a sensor that saturates, so the spread of the force itself is no smaller.
    """
    trials = [peaks for peaks in map(tap_peaks, paths) if peaks.size >= FEWEST_TAPS]
    if not trials:
        raise FitError(f"no trial of {FEWEST_TAPS} taps whose force has times, in {len(paths)} logs")
    return float(np.median([np.std(peaks, ddof=1) / np.mean(peaks) for peaks in trials]))

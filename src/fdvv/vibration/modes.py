"""How many modes free records hold: one after the other, while each is worth its parameters and is one."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence

import numpy as np

from fdvv.errors import FitError
from fdvv.units import FloatArray
from fdvv.vibration._damped import DampedFit, DampedMode, fit_records
from fdvv.vibration._projection import Records, polynomial, shapes

MOST_TERMS = 5
BACKGROUND_DEGREE = 2
"""The cap's own motion after the snap, a polynomial of each press."""

LOWEST_Hz, HIGHEST_ratio = 40.0, 0.4
"""A mode lies between these; the latter in parts of the sampling rate."""

FREE_ratio, MOST_DRIVES = 0.2, 2
"""Damping, in parts of critical, above which a term is a fading drive and no mode; how many at most."""

LEAST_FALL = 0.3
"""A mode decays within the record: its envelope falls by this many nepers."""

FEWEST_PER_PERIOD = 8.0
"""Samples per period of 250 Hz below which records are searched for one mode only."""

NEXT_ratio, NEXT_DAMPING = 1.06, (0.08, 0.35)
"""Steps of the frequencies from which a term is searched; damping that a mode and a drive start with."""


def most_likely(
    times_s: list[FloatArray],
    signals: list[FloatArray],
    period_s: float,
    known: tuple[float, float] | None = None,
    most_drives: int = MOST_DRIVES,
) -> DampedFit:
    """Fit free records with as many modes as BIC allows, down to none.

    times_s, signals : of each record, evenly sampled, times after the onset.
    known : frequency and decay of a mode that is there and stays as it is.
    most_drives : terms that fade as a drive does, fitted beside modes so that these do not bend to them.

    Each term starts where the residual of those before has most to gain. A fit in which a mode is none of its
    own ends the search: outside the band, one that does not decay within the record, or half of a pair nearer
    to each other than records of that length can tell apart (1/T). Raises FitError if the records are too
    short for the known mode.
    """
    records = Records(times_s, signals, BACKGROUND_DEGREE, one_phase=False)
    longest_s = max(float(t[-1] - t[0]) for t in times_s)
    theta = np.asarray(known if known else (), dtype=np.float64)
    best = fit_records(records, theta, np.full(2, True)) if known else _background(times_s, signals)
    dense = 1 / period_s >= FEWEST_PER_PERIOD * 250.0
    for _ in range((MOST_TERMS if dense else 1) - theta.size // 2 if records.even is not None else 0):
        try:
            start = _one_more(records, theta, period_s, longest_s, most_drives > 0)
            held = np.tile(start[: start.size // 2] == (known[0] if known else 0.0), 2)
            fit = fit_records(records, start, held)
        except FitError:
            break
        if fit.bic >= best.bic or not sound(fit, longest_s, period_s, most_drives):
            break
        best = fit
        theta = np.array([m.frequency_Hz for m in fit.modes] + [m.decay_1_s for m in fit.modes])
    return best


def drives(mode: DampedMode) -> bool:
    """Tell whether a term fades so fast that it is a drive, not a mode."""
    return mode.decay_1_s > FREE_ratio * 2 * math.pi * mode.frequency_Hz


def overlapped(mode: DampedMode, modes: Sequence[DampedMode]) -> bool:
    """Tell whether another mode lies nearer than both are wide (decay / pi): two halves of what is one."""
    return any(
        abs(other.frequency_Hz - mode.frequency_Hz) < (other.decay_1_s + mode.decay_1_s) / math.tau
        for other in modes
        if other is not mode and not drives(other)
    )


def sound(fit: DampedFit, longest_s: float, period_s: float, most_drives: int) -> bool:
    """Tell whether every mode of a fit is one: in the band, falling, and none nearer to another than 1/T."""
    modes = [mode for mode in fit.modes if not drives(mode)]
    apart = bool(np.all(np.diff(np.sort([mode.frequency_Hz for mode in modes])) >= 1 / longest_s))
    lowest = max(LOWEST_Hz, 1 / longest_s)
    return (
        apart
        and len(fit.modes) - len(modes) <= most_drives
        and all(
            lowest <= m.frequency_Hz <= HIGHEST_ratio / period_s and m.decay_1_s * longest_s >= LEAST_FALL
            for m in modes
        )
    )


def _one_more(
    records: Records, theta: FloatArray, period_s: float, longest_s: float, drive: bool
) -> FloatArray:
    """Start one more term where it takes most off the residual. Raises FitError where there is no room."""
    left, basis = records.typical(theta)
    f, d, columns = _candidates(round(period_s, 12), left.shape[1])
    known, decays = np.split(theta, 2)
    room = np.all(np.abs(f[:, None] - known) >= 1 / longest_s, axis=1)
    fading = d > FREE_ratio * math.tau * f
    room = np.where(fading, drive, room)
    free = columns - basis @ (basis.T @ columns)
    pairs = free.T.reshape(f.size, 2, -1)
    gram = pairs @ pairs.transpose(0, 2, 1) + 1e-9 * np.eye(2)
    along = pairs @ left.T
    gain = np.sum(along * np.linalg.solve(gram, along), axis=(1, 2))
    k = int(np.argmax(np.where(room, gain, -1.0)))
    return np.concatenate([known, [f[k]], decays, [d[k]]])


@functools.lru_cache(maxsize=64)
def _candidates(period_s: float, samples: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    highest = HIGHEST_ratio / period_s
    steps = np.arange(1 + int(math.log(highest / LOWEST_Hz) / math.log(NEXT_ratio)))
    one: FloatArray = np.asarray(LOWEST_Hz * NEXT_ratio**steps, dtype=np.float64)
    f = np.tile(one, len(NEXT_DAMPING))
    d: FloatArray = np.asarray(math.tau * f * np.repeat(NEXT_DAMPING, one.size), dtype=np.float64)
    return f, d, shapes(np.asarray(period_s * np.arange(samples)), f, d)


def _background(times: list[FloatArray], signals: list[FloatArray]) -> DampedFit:
    """Fit without any mode."""
    total = 0.0
    for t, y in zip(times, signals, strict=True):
        q, _ = np.linalg.qr(polynomial(t, BACKGROUND_DEGREE))
        left = y - q @ (q.T @ y)
        total += float(left @ left)
    samples, needed = sum(t.size for t in times), len(times) * (BACKGROUND_DEGREE + 1)
    bic = samples * math.log(max(total / samples, 1e-300)) + needed * math.log(samples)
    noise = math.sqrt(total / max(samples - needed, 1))
    return DampedFit((), np.empty((len(times), 0)), noise, samples, bic)

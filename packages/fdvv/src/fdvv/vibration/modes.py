"""Damped modes of a signal: how many, and which, by the matrix pencil."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from fdvv.errors import FitError, ModelError
from fdvv.units import FloatArray
from fdvv.vibration.damped import DampedFit, DampedMode, fit_damped, fit_records
from fdvv.vibration.projection import Records, polynomial, shapes

MOST_MODES = 6
LONGEST_WINDOW = 400
"""Rows and columns of the matrix grow with the record; beyond this they add work, not knowledge."""
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


def fit_modes(
    signal: npt.ArrayLike, rate_Hz: float, count: int | None = None, most: int = MOST_MODES, degree: int = -1
) -> DampedFit:
    """Find the damped modes of one record, or those that several records share.

    signal : (n,) or (records, n), each from the moment the modes start.
    rate_Hz : of the samples.
    count : how many modes; None takes the number up to `most` with the smallest BIC.
    degree : of the polynomial that each record may have beneath; -1 for none.

    Poles come from the matrix pencil (Hua and Sarkar 1990): the singular vectors of the signal's Hankel
    matrix span what exponentials span, and a shift by one sample turns each by its pole. They start a least
    squares fit, so the errors are those of maximum likelihood under white noise. An empty fit (no modes, BIC
    of noise alone) says that none is worth its parameters. Raises FitError if the record is too short.
    """
    records = np.atleast_2d(np.asarray(signal, dtype=np.float64))
    if records.ndim != 2 or not np.isfinite(records).all():
        raise ModelError(f"a signal must be finite, of shape (n,) or (records, n), got {records.shape}")
    if not rate_Hz > 0:
        raise ModelError(f"rate_Hz must be above 0, got {rate_Hz}")
    times = [np.arange(records.shape[1]) / rate_Hz] * len(records)
    if count is not None:
        fit = _with(records, times, rate_Hz, count, degree)
        if fit is None:
            raise FitError(
                f"no {count} modes that ring and decay in {records.shape[1]} samples; ask for fewer"
            )
        return fit
    fits = [_with(records, times, rate_Hz, k, degree) for k in range(1, most + 1)]
    empty = _nothing(records, degree)
    return min([empty, *(fit for fit in fits if fit is not None)], key=lambda fit: fit.bic)


def _nothing(records: FloatArray, degree: int) -> DampedFit:
    samples, parameters = records.size, len(records) * (degree + 1)
    x = np.linspace(-1, 1, records.shape[1])
    matrix = np.polynomial.legendre.legvander(x, degree) if degree >= 0 else np.zeros((x.size, 1))
    left = records - (matrix @ np.linalg.lstsq(matrix, records.T, rcond=None)[0]).T
    power = float(np.mean(left**2))
    bic = samples * np.log(max(power, 1e-300)) + parameters * np.log(samples)
    return DampedFit((), np.empty((len(records), 0)), float(np.sqrt(power)), samples, float(bic))


def _with(
    records: FloatArray, times: list[FloatArray], rate_Hz: float, count: int, degree: int
) -> DampedFit | None:
    """Fit a number of modes from the pencil's poles; None if there are not so many that ring."""
    # a polynomial beneath takes poles near 1 of its own
    poles = pencil_poles(records, 2 * count + max(degree + 1, 0))
    ringing = [z for z in poles if z.imag > 1e-6]
    if len(ringing) < count:
        return None
    logs = rate_Hz * np.log(np.array(sorted(ringing, key=lambda z: -abs(z))[:count]))
    decays = np.maximum(-logs.real, 1e-3)
    try:
        fit = fit_damped(times, list(records), list(logs.imag / (2 * np.pi)), list(decays), degree)
    except (FitError, np.linalg.LinAlgError):
        return None
    return fit if all(0 < mode.frequency_Hz < 0.5 * rate_Hz for mode in fit.modes) else None


def pencil_poles(records: FloatArray, count: int) -> npt.NDArray[np.complex128]:
    """Return the poles z (per sample) of the sum of exponentials nearest to the records, (count,).

    records : (records, n) that share their poles. The pencil is a third of the record, the length with the
    least variance (Hua and Sarkar 1990). Raises FitError if the records are too short for so many poles.
    """
    length = min(records.shape[1] // 3, LONGEST_WINDOW)
    windows = np.vstack([np.lib.stride_tricks.sliding_window_view(row, length + 1) for row in records])
    if count > min(length, len(windows)):
        raise FitError(f"{count} poles need longer records than {records.shape[1]} samples")
    # right singular vectors through the small square matrix: half the digits, a fraction of the work
    values, vectors = np.linalg.eigh(windows.T @ windows)
    span = vectors[:, np.argsort(-values)[:count]]
    turn = np.linalg.lstsq(span[:-1], span[1:], rcond=None)[0]
    return np.asarray(np.linalg.eigvals(turn), dtype=np.complex128)


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
    to each other than records of that length can resolve (1/T). Raises FitError if the records are too
    short for the known mode.
    """
    records = Records(times_s, signals, BACKGROUND_DEGREE, same_phase=False)
    longest_s = max(float(t[-1] - t[0]) for t in times_s)
    theta = np.asarray(known if known else (), dtype=np.float64)
    best = fit_records(records, theta, np.full(2, True)) if known else _background(times_s, signals)
    dense = 1 / period_s >= FEWEST_PER_PERIOD * 250.0
    for _ in range((MOST_TERMS if dense else 1) - theta.size // 2 if records.even is not None else 0):
        try:
            start = _add_term(records, theta, period_s, longest_s, most_drives > 0)
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
    """Return whether a term fades so fast that it is a drive, not a mode."""
    return mode.decay_1_s > FREE_ratio * 2 * math.pi * mode.frequency_Hz


def overlaps(mode: DampedMode, modes: Sequence[DampedMode]) -> bool:
    """Return whether another mode lies nearer than both are wide (decay / pi): two halves of what is one."""
    return any(
        abs(other.frequency_Hz - mode.frequency_Hz) < (other.decay_1_s + mode.decay_1_s) / math.tau
        for other in modes
        if other is not mode and not drives(other)
    )


def sound(fit: DampedFit, longest_s: float, period_s: float, most_drives: int) -> bool:
    """Return whether every mode of a fit lies in the band, decays, and is at least 1/T from the others."""
    modes = [mode for mode in fit.modes if not drives(mode)]
    apart = bool(np.all(np.diff(np.sort([mode.frequency_Hz for mode in modes])) >= 1 / longest_s))
    lowest = max(LOWEST_Hz, 1 / longest_s)
    heard = all(
        lowest <= m.frequency_Hz <= HIGHEST_ratio / period_s and m.decay_1_s * longest_s >= LEAST_FALL
        for m in modes
    )
    return apart and heard and len(fit.modes) - len(modes) <= most_drives


def _add_term(
    records: Records, theta: FloatArray, period_s: float, longest_s: float, drive: bool
) -> FloatArray:
    """Start one more term where it takes most off the residual. Raises FitError where there is no room."""
    left, basis = records.typical(theta)
    # rounded, so that presses of one sensor share the cached columns
    f, d, columns = _candidates(round(period_s, 12), left.shape[1])
    known, decays = np.split(theta, 2)
    room = np.all(np.abs(f[:, None] - known) >= 1 / longest_s, axis=1)
    fading = d > FREE_ratio * math.tau * f
    room = np.where(fading, drive, room)
    free = columns - basis @ (basis.T @ columns)
    pairs = free.T.reshape(f.size, 2, -1)
    # candidates that the basis spans already have nothing left to invert
    gram = pairs @ pairs.transpose(0, 2, 1) + 1e-9 * np.eye(2)
    along = pairs @ left.T
    gain = np.sum(along * np.linalg.solve(gram, along), axis=(1, 2))
    k = int(np.argmax(np.where(room, gain, -1.0)))
    return np.concatenate([known, [f[k]], decays, [d[k]]])


@functools.lru_cache(maxsize=64)
def _candidates(period_s: float, samples: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    highest = HIGHEST_ratio / period_s
    steps = np.arange(1 + int(math.log(highest / LOWEST_Hz) / math.log(NEXT_ratio)))
    grid_Hz: FloatArray = np.asarray(LOWEST_Hz * NEXT_ratio**steps, dtype=np.float64)
    f = np.tile(grid_Hz, len(NEXT_DAMPING))
    d: FloatArray = np.asarray(math.tau * f * np.repeat(NEXT_DAMPING, grid_Hz.size), dtype=np.float64)
    return f, d, shapes(np.asarray(period_s * np.arange(samples)), f, d)


def _background(times: list[FloatArray], signals: list[FloatArray]) -> DampedFit:
    total = 0.0
    for t, y in zip(times, signals, strict=True):
        q, _ = np.linalg.qr(polynomial(t, BACKGROUND_DEGREE))
        left = y - q @ (q.T @ y)
        total += float(left @ left)
    samples, needed = sum(t.size for t in times), len(times) * (BACKGROUND_DEGREE + 1)
    bic = samples * math.log(max(total / samples, 1e-300)) + needed * math.log(samples)
    noise = math.sqrt(total / max(samples - needed, 1))
    return DampedFit((), np.empty((len(times), 0)), noise, samples, bic)

"""Damped modes of a signal: how many, and which, by the matrix pencil."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fdvv.errors import FitError, ModelError
from fdvv.units import FloatArray
from fdvv.vibration._damped import DampedFit, fit_damped

MOST_MODES = 6
LONGEST_WINDOW = 400
"""Rows and columns of the matrix grow with the record; beyond this they add work, not knowledge."""


def fit_modes(
    signal: npt.ArrayLike,
    rate_Hz: float,
    count: int | None = None,
    most: int = MOST_MODES,
    degree: int = -1,
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
    rows, empty = list(records), _nothing(records, degree)
    if count is not None:
        fit = _with(records, times, rows, rate_Hz, count, degree)
        if fit is None:
            raise FitError(
                f"no {count} modes that ring and decay in {records.shape[1]} samples; ask for fewer"
            )
        return fit
    fits = [_with(records, times, rows, rate_Hz, k, degree) for k in range(1, most + 1)]
    return min([empty, *(fit for fit in fits if fit is not None)], key=lambda fit: fit.bic)


def _nothing(records: FloatArray, degree: int) -> DampedFit:
    """Give the fit without any mode."""
    samples, parameters = records.size, len(records) * (degree + 1)
    x = np.linspace(-1, 1, records.shape[1])
    matrix = np.polynomial.legendre.legvander(x, degree) if degree >= 0 else np.zeros((x.size, 1))
    left = records - (matrix @ np.linalg.lstsq(matrix, records.T, rcond=None)[0]).T
    power = float(np.mean(left**2))
    bic = samples * np.log(max(power, 1e-300)) + parameters * np.log(samples)
    return DampedFit((), np.empty((len(records), 0)), float(np.sqrt(power)), samples, float(bic))


def _with(
    records: FloatArray,
    times: list[FloatArray],
    rows: list[FloatArray],
    rate_Hz: float,
    count: int,
    degree: int,
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
        fit = fit_damped(times, rows, list(logs.imag / (2 * np.pi)), list(decays), degree)
    except (FitError, np.linalg.LinAlgError):
        return None
    return fit if all(0 < mode.frequency_Hz < 0.5 * rate_Hz for mode in fit.modes) else None


def pencil_poles(records: FloatArray, count: int) -> npt.NDArray[np.complex128]:
    """Give the poles z (per sample) of the sum of exponentials nearest to the records, (count,).

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

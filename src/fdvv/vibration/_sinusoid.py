"""The paper's single decaying sinusoid."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv.vibration._damped import DampedFit, fit_damped

DECAYS = (0.5, 2.0, 8.0)
"""Decays that are tried first, in lives per record."""


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
    fits = [
        fit_damped(
            [t],
            [y],
            [_loudest_Hz(t, y * np.exp(-lives * (t - t[0]) / length), lowest_Hz)],
            [lives / length],
            degree,
        )
        for lives in DECAYS
    ]
    return min(fits, key=lambda fit: fit.bic)


def _loudest_Hz(t: FloatArray, y: FloatArray, lowest_Hz: float | None) -> float:
    """Give the frequency with the largest spectrum up to half the mean rate, four points to a line."""
    length = float(t[-1] - t[0])
    step, highest = 0.25 / length, 0.5 * (t.size - 1) / length
    grid = np.arange(lowest_Hz or 1 / length, highest, step)
    if not grid.size:
        return 1 / length
    return float(grid[np.argmax(np.abs(np.exp(-2j * np.pi * np.outer(grid, t)) @ (y - y.mean())))])

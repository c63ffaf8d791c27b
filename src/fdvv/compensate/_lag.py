"""A first-order lag, as a coil's current has it."""

from __future__ import annotations

import numpy as np

from fdvv.units import FloatArray


def late(signal: FloatArray, lag_s: float, tick_s: float) -> FloatArray:
    """Pass a signal, straight between ticks, through a first-order lag, from rest at its first value."""
    from scipy.signal import lfilter

    if lag_s <= 0.0:
        return signal
    keep = float(np.exp(-tick_s / lag_s))
    mean = lag_s / tick_s * (1.0 - keep)
    return np.asarray(lfilter([1 - mean, mean - keep], [1, -keep], signal, zi=[mean * signal[0]])[0])

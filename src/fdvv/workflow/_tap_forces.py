"""How much the force of a person's taps differs from tap to tap, out of ForcePeaks logs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from fdvv.errors import FitError
from fdvv.recording import Quantity, read_log
from fdvv.units import FloatArray

APART_s = 2e-3
"""Samples further apart belong to different taps."""
FEWEST = 10
"""Taps that a trial needs to count."""


def tap_peaks(path: Path) -> FloatArray:
    """Give the largest count of each tap of a ForcePeaks log, (taps,); empty where the log tells no times.

    A tap whose every sample is 0 was never heard by the sensor and is left out. InputError.
    """
    found = [
        stream
        for take in read_log(path).takes
        for stream in take.of(Quantity.COUNTS)
        if stream.clock == "board"
    ]
    if not found:
        return np.zeros(0)
    stream = found[0]
    cuts = np.flatnonzero(np.diff(stream.t_s) > APART_s) + 1
    peaks = np.array([piece.max() for piece in np.split(stream.raw.astype(np.float64), cuts)])
    return peaks[peaks > 0]


def force_spread_ratio(paths: Sequence[Path]) -> float:
    """Give the spread of a person's taps within a trial over its mean, the middle of trials. FitError.

    The counts are of a sensor that saturates, so the spread of the force itself is no smaller.
    """
    trials = [peaks for peaks in map(tap_peaks, paths) if peaks.size >= FEWEST]
    if not trials:
        raise FitError(f"no trial of {FEWEST} taps whose force has times, in {len(paths)} logs")
    return float(np.median([np.std(peaks, ddof=1) / np.mean(peaks) for peaks in trials]))

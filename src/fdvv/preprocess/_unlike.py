"""Presses whose force is unlike that of the others."""

from __future__ import annotations

import numpy as np

from fdvv.preprocess._average import Pooled

GAIN_OFF = 0.1
"""Presses at one pace differ in force as a whole by less: that is the pace's own spread."""

LEAST_USUAL_cN = 1.0
"""What presses differ by is never taken as less."""

FEWEST = 3
"""Of so few none can be told from the others."""


def unlike(pooled: Pooled, limit: float) -> list[int]:
    """Find presses that differ from the mean by much more than presses do, the worst first."""
    slipped = _slipped(pooled)
    if slipped:
        return slipped
    apart = np.sqrt(np.nanmean(pooled.apart_cN**2, axis=1))
    usual = float(np.median(apart))
    far = np.flatnonzero(apart > limit * max(usual, LEAST_USUAL_cN))
    return [int(i) for i in far if apart[i] >= 0.5 * apart.max()] if apart.size > FEWEST else []


def _slipped(pooled: Pooled) -> list[int]:
    """Find presses whose force is that of the others times a number: the sensor slipped, or was tilted."""
    gains = []
    for apart in pooled.apart_cN:
        seen = np.isfinite(apart)
        mean = pooled.force_cN[seen]
        gains.append(1 + float(apart[seen] @ mean) / max(float(mean @ mean), 1e-9))
    off = np.abs(np.array(gains) - np.median(gains))
    far = np.flatnonzero(off > max(GAIN_OFF, 4 * 1.4826 * float(np.median(off))))
    return [int(i) for i in far if off[i] >= 0.5 * off.max()] if len(gains) > FEWEST else []

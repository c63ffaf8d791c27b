"""Doubt near designs that failed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fdvv.optimize._space import DesignSpace
from fdvv.optimize._trial import Trial, TrialState
from fdvv.units import FloatArray

NEAR = 0.1
"""Distance over which one failure lets expect another, parts of a range, root mean square over parameters."""
SURE = 0.95
"""Chance that the very design that failed fails again."""


def log_success(space: DesignSpace, trials: Sequence[Trial], places: FloatArray) -> FloatArray:
    """Give the log of the chance, (n,), that a trial at places (n, d) can be scored.

    Every failure takes away a share that falls with distance, whatever succeeded beside it.
    """
    failed = [trial.design for trial in trials if trial.state is TrialState.FAILED]
    if not failed:
        return np.zeros(len(places))
    squared = ((places[:, None] - space.to_unit(failed)[None]) ** 2).mean(axis=2)
    return np.asarray(np.log1p(-SURE * np.exp(-0.5 * squared / NEAR**2)).sum(axis=1))

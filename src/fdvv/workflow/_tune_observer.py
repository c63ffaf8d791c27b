"""A simulated observer for a tuning, who hides a favourite among the candidates. Evidence of nothing."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fdvv.model import Vibration
from fdvv.vibration import SimulatedObserver, correlation
from fdvv.workflow._tune_candidates import Candidates

TIMES_s = np.arange(800) / 8000
FOR_SHAPE, FOR_STRENGTH = 4.0, 1.5
"""How much is liked less, in units of the noise: for another shape altogether, for twice the strength."""


def simulated_observer(candidates: Sequence[Candidates], seed: int = 0) -> SimulatedObserver:
    """Make an observer whose favourite of each velocity is drawn; others are liked as they are alike."""
    random = np.random.default_rng([seed, 1])
    likes = []
    for found in candidates:
        favourite = found.vibrations[int(random.integers(len(found.vibrations)))]
        likes.append([_like(vibration, favourite) for vibration in found.vibrations])
    return SimulatedObserver(likes, seed=seed)


def _like(vibration: Vibration, favourite: Vibration) -> float:
    felt, wanted = (v.acceleration_m_s2(TIMES_s) for v in (vibration, favourite))
    strength = abs(float(np.log2((np.linalg.norm(felt) + 1e-9) / (np.linalg.norm(wanted) + 1e-9))))
    return FOR_SHAPE * (correlation(felt, wanted) - 1) - FOR_STRENGTH * strength

"""The exact distribution of signed-rank sums: every turn of the signs, counted by dynamic programming."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from fdvv.units import FloatArray

CHUNK_BYTES = 64_000_000
"""Room that the sums of as many studies as go together may take."""


def lower_tail(ranks: FloatArray, sums: FloatArray) -> FloatArray:
    """Give the chance of a sum of positive ranks as small or smaller, all signs being tossed.

    ranks : (studies, people), whole or half; 0 for who has no sign to toss. sums : (studies,).
    """
    doubled = np.sort(np.rint(2 * ranks).astype(np.int64), axis=1)
    tops = np.rint(2 * sums).astype(np.int64)
    # studies with like sums go together: none has to count beyond the largest
    order = np.argsort(tops, kind="stable")
    tail = np.empty(len(tops))
    start = 0
    while start < len(order):
        size = max(1, CHUNK_BYTES // (8 * (int(tops[order[-1]]) + 1)))
        rows = order[start : start + size]
        tail[rows] = _chunk(doubled[rows], tops[rows])
        start += size
    return tail


def _chunk(ranks: np.ndarray, tops: np.ndarray) -> FloatArray:
    """Count (studies, 0 to the largest top) subset sums, halving at each toss so that no count overflows."""
    chance = np.zeros((len(ranks), int(tops.max(initial=0)) + 1))
    chance[:, 0] = 1.0
    for column in ranks.T:
        for rank in np.unique(column[column > 0]):
            rows = np.flatnonzero(column == rank)
            part = 0.5 * (chance if rows.size == len(ranks) else chance[rows])
            moved = part[:, : part.shape[1] - min(rank, part.shape[1])].copy()
            part[:, part.shape[1] - moved.shape[1] :] += moved
            chance[rows] = part
    counted = np.arange(chance.shape[1]) <= tops[:, np.newaxis]
    return np.asarray(np.sum(chance * counted, axis=1))


@lru_cache(maxsize=256)
def untied_quantile(n: int, level: float) -> int | None:
    """Give the largest sum of n ranks without ties whose lower tail is at most level; None without one."""
    chance = np.zeros(n * (n + 1) // 2 + 1)
    chance[0] = 1.0
    for rank in range(1, n + 1):
        moved = chance[: chance.size - rank].copy()
        chance[rank:] += moved
        chance *= 0.5
    below = int(np.searchsorted(np.cumsum(chance), level, side="right")) - 1
    return below if below >= 0 else None

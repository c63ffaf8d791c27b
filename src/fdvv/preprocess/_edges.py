"""Edges of a light: as the board switched it, and as frames saw it; which belong together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.units import FloatArray

IntArray = npt.NDArray[np.int64]

GROUP_GAP_s = 0.25
"""Edges further apart than this belong to two patterns."""

LEAST_HITS = 3
"""Fewer edges in common are chance."""

TOLERANCE_s = 6e-3
"""The edges of one pattern agree with their common lead to this: half of 3.9 ms, and the clocks' parting."""

DARK, LIT = 0.02, 0.98
"""Brightness is noisy by less; what lies between is a frame that an edge cut through."""


@dataclass(frozen=True, eq=False)
class Edges:
    """When a light was switched.

    Attributes
    ----------
    t_s : (n,) rising.
    on : (n,) switched on there, off otherwise.
    """

    t_s: FloatArray
    on: npt.NDArray[np.bool_]

    def __post_init__(self) -> None:
        if self.t_s.shape != self.on.shape or np.any(np.diff(self.t_s) <= 0):
            raise ModelError("edges need rising times and one direction each")

    @classmethod
    def of(cls, on_s: FloatArray, off_s: FloatArray) -> Edges:
        """Sort times of switching on and off into one row."""
        times = np.concatenate([on_s, off_s])
        order = np.argsort(times)
        return cls(times[order], (np.arange(times.size) < on_s.size)[order])


@dataclass(frozen=True, eq=False)
class SeenEdges:
    """Edges as a camera saw them: (m,) bounds of when each was, and its direction."""

    low_s: FloatArray
    high_s: FloatArray
    on: npt.NDArray[np.bool_]

    @property
    def t_s(self) -> FloatArray:
        """Middles of the bounds."""
        return 0.5 * (self.low_s + self.high_s)


def seen_edges(frame_s: FloatArray, light: FloatArray, exposure_s: float) -> SeenEdges:
    """Find edges in the brightness of frames.

    Between a dark and a lit frame the edge lies after the first exposure ends and before the second begins. A
    frame that is partly lit tells the moment itself, to 2 % of the exposure. Lost frames widen the bounds.
    """
    seen = np.isfinite(light)
    times, part = frame_s[seen], _scaled(light[seen])
    lit, dark = part > LIT, part < DARK
    found: list[tuple[float, float, bool]] = []
    state = bool(part[0] > 0.5) if part.size else False
    last = 0
    for i in range(1, times.size):
        if (lit if state else dark)[i]:
            last = i
        elif (dark if state else lit)[i]:
            on = not state
            found.append((*_bounds(times, part, last, i, on, exposure_s), on))
            state, last = on, i
    low, high, on_flags = (np.array([f[k] for f in found]) for k in range(3))
    return SeenEdges(low.astype(np.float64), high.astype(np.float64), on_flags.astype(np.bool_))


def _scaled(light: FloatArray) -> FloatArray:
    """Bring any brightness to 0 for dark and 1 for lit."""
    if not light.size:
        return light
    low, high = float(light.min()), float(light.max())
    return (light - low) / (high - low) if high > low else np.zeros_like(light)


def _bounds(
    times: FloatArray, part: FloatArray, before: int, after: int, on: bool, exposure_s: float
) -> tuple[float, float]:
    """Tell when an edge was, between the last frame of the old state and the first of the new."""
    if after == before + 2 and exposure_s > 0:
        lit = float(part[before + 1]) if on else 1 - float(part[before + 1])
        moment = float(times[before + 1]) + exposure_s * (1 - lit)
        return moment - DARK * exposure_s, moment + DARK * exposure_s
    return float(times[before]) + exposure_s, float(times[after])


def match(board: Edges, seen: SeenEdges, rate_error: float) -> npt.NDArray[np.int64]:
    """Pair edges of the board with those seen, (pairs, 2) indices, both rising.

    Edges come in groups, one before each press. The pattern of one group is looked for everywhere; from
    there on the groups before and after are looked for where the clocks may have parted to, by rate_error
    at first and by less as more groups are found. Edges that one side lacks are left out.
    """
    groups = np.split(np.arange(board.t_s.size), np.flatnonzero(np.diff(board.t_s) > GROUP_GAP_s) + 1)
    begun = _begin(board, seen, groups)
    if begun is None:
        return np.zeros((0, 2), dtype=np.int64)
    first, lead_s = begun
    pairs: list[tuple[int, int]] = []
    for order in (groups[first:], groups[:first][::-1]):
        pairs += _follow(board, seen, order, lead_s, rate_error)
    return np.array(sorted(pairs), dtype=np.int64).reshape(-1, 2)


def _begin(board: Edges, seen: SeenEdges, groups: Sequence[IntArray]) -> tuple[int, float] | None:
    """Find a group to begin with and the camera's lead there; None if no pattern agrees."""
    best: tuple[int, int, float] | None = None
    for k, group in enumerate(groups):
        hits, lead_s = _best_lead(board, seen, group, _leads(board, seen, group))
        if best is None or hits > best[0]:
            best = hits, k, lead_s
        if hits >= max(LEAST_HITS, 0.8 * group.size):
            break
    return (best[1], best[2]) if best and best[0] >= min(LEAST_HITS, board.t_s.size) else None


def _leads(board: Edges, seen: SeenEdges, group: IntArray) -> FloatArray:
    """Give every lead at which one of the first edges of a group was seen."""
    return np.unique(
        np.concatenate([seen.t_s[seen.on == board.on[i]] - board.t_s[i] for i in group[:LEAST_HITS]])
    )


def _best_lead(board: Edges, seen: SeenEdges, group: IntArray, leads: FloatArray) -> tuple[int, float]:
    """Find the lead at which most of a group was seen, with the middle of what those edges tell."""
    best = (0, 0.0)
    for lead in leads:
        own, theirs = _hits(board, seen, group, float(lead))
        if own.size > best[0]:
            best = (int(own.size), float(np.median(seen.t_s[theirs] - board.t_s[own])))
    return best


def _hits(board: Edges, seen: SeenEdges, group: IntArray, lead_s: float) -> tuple[IntArray, IntArray]:
    """Tell which edges of a group were seen at a lead, and as which."""
    near = _nearest(seen.t_s, board.t_s[group] + lead_s)
    hit = np.abs(seen.t_s[near] - board.t_s[group] - lead_s) <= TOLERANCE_s
    hit &= seen.on[near] == board.on[group]
    return group[hit], near[hit]


def _nearest(sorted_s: FloatArray, at_s: FloatArray) -> IntArray:
    right = np.clip(np.searchsorted(sorted_s, at_s), 1, max(sorted_s.size - 1, 1))
    left = right - 1
    right = np.minimum(right, sorted_s.size - 1)
    return np.where(at_s - sorted_s[left] <= sorted_s[right] - at_s, left, right)


def _follow(
    board: Edges, seen: SeenEdges, groups: Sequence[IntArray], lead_s: float, rate_error: float
) -> list[tuple[int, int]]:
    """Go from group to group; each is expected at the lead of the last, and the rate so far."""
    pairs: list[tuple[int, int]] = []
    trail: list[tuple[float, float]] = []
    drift, doubt = 0.0, rate_error
    for group in groups:
        at = float(board.t_s[group[0]])
        gap = abs(at - trail[-1][0]) if trail else 0.0
        expected = lead_s + drift * (at - trail[-1][0]) if trail else lead_s
        leads = _leads(board, seen, group)
        leads = leads[np.abs(leads - expected) <= TOLERANCE_s + doubt * gap]
        hits, found = _best_lead(board, seen, group, leads)
        if hits < min(LEAST_HITS, group.size):
            continue
        own, theirs = _hits(board, seen, group, found)
        pairs += zip(own.tolist(), theirs.tolist(), strict=True)
        lead_s = found
        trail.append((at, found))
        span = abs(at - trail[0][0])
        if span > 0:
            drift = (found - trail[0][1]) / (at - trail[0][0])
            doubt = min(rate_error, 2 * TOLERANCE_s / span)
    return pairs

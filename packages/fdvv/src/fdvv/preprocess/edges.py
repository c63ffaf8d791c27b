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
TOLERANCE_s, CLOSE_s = 4e-3, 1.5e-3
"""An edge lies within its bounds and this, at a lead known from one edge, and at the lead of its group."""
SURE_sigmas = 5.0
"""A frame is dark or lit if nearer to that than so many times the noise; what is between, an edge cut."""
LEAST_DOUBT, MOST_DOUBT = 0.02, 0.3
"""Bounds of that, in parts of the brightness."""


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


def find_edges(frame_s: FloatArray, light: FloatArray, exposure_s: float) -> SeenEdges:
    """Find edges in the brightness of frames.

    Between a dark and a lit frame the edge lies after the first exposure ends and before the second begins. A
    frame that is partly lit gives the moment itself, as well as the noise of brightness lets it. Lost frames
    widen the bounds.
    """
    seen = np.isfinite(light)
    times, (part, doubt) = frame_s[seen], _normalize(light[seen])
    lit, dark = part > 1 - doubt, part < doubt
    edges: list[tuple[float, float, bool]] = []
    state = bool(part[0] > 0.5) if part.size else False
    last = 0
    for i in range(1, times.size):
        if (lit if state else dark)[i]:
            last = i
        elif (dark if state else lit)[i]:
            on = not state
            edges.append((*_bounds(times, part, doubt, (last, i), on, exposure_s), on))
            state, last = on, i
    low, high, on_flags = (np.array([f[k] for f in edges]) for k in range(3))
    return SeenEdges(low.astype(np.float64), high.astype(np.float64), on_flags.astype(np.bool_))


def _normalize(light: FloatArray) -> tuple[FloatArray, float]:
    """Scale any brightness to 0 for dark and 1 for lit, with the tolerance of either state."""
    if not light.size or np.ptp(light) == 0:
        return np.zeros_like(light), LEAST_DOUBT
    middle = 0.5 * (float(light.min()) + float(light.max()))
    dark, lit = float(np.median(light[light < middle])), float(np.median(light[light >= middle]))
    part = (light - dark) / (lit - dark)
    # a standard deviation from the median one, which half-lit frames do not move
    noise = 1.4826 * float(np.median(np.abs(part[light < middle])))
    return part, min(max(SURE_sigmas * noise, LEAST_DOUBT), MOST_DOUBT)


def _bounds(
    times: FloatArray, part: FloatArray, doubt: float, between: tuple[int, int], on: bool, exposure_s: float
) -> tuple[float, float]:
    """Bound every edge by the last frame of the old state and the first of the new."""
    before, after = between
    if after == before + 2 and exposure_s > 0:
        lit = float(part[before + 1]) if on else 1 - float(part[before + 1])
        moment = float(times[before + 1]) + exposure_s * (1 - lit)
        return moment - doubt * exposure_s, moment + doubt * exposure_s
    # a sure frame may still be cut by an edge, by as much as its doubt
    return float(times[before]) + exposure_s * (1 - doubt), float(times[after]) + exposure_s * doubt


def match(board: Edges, seen: SeenEdges, rate_error: float) -> npt.NDArray[np.int64]:
    """Pair edges of the board with those seen, (pairs, 2) indices, both rising.

    Edges come in groups, one before each press, and groups may be alike. The pattern of one group is looked
    for everywhere; from every place where it is found, the groups before and after are looked for where the
    clocks may have parted to, by rate_error at first and by less as more groups are found. The place from
    which most edges are found is right. Edges that one side lacks are left out.
    """
    groups = np.split(np.arange(board.t_s.size), np.flatnonzero(np.diff(board.t_s) > GROUP_GAP_s) + 1)
    best: list[tuple[int, int]] = []
    enough = 0.9 * min(board.t_s.size, seen.t_s.size)
    # from the middle outwards: there the clocks have parted least from either end
    for first in dict.fromkeys(int(part * (len(groups) - 1)) for part in (0.5, 0.25, 0.75, 0.0, 1.0)):
        later, earlier = groups[first:], groups[:first][::-1]
        for lead_s in _likely(board, seen, groups[first]):
            pairs = [p for way in (later, earlier) for p in _follow(board, seen, way, lead_s, rate_error)]
            best = max(best, pairs, key=len)
            if len(best) >= enough:
                return _again(board, seen, best)
    return _again(board, seen, best)


def _again(board: Edges, seen: SeenEdges, pairs: Sequence[tuple[int, int]]) -> npt.NDArray[np.int64]:
    """Pair all edges once more, along the line through those already paired."""
    paired = np.array(sorted(pairs), dtype=np.int64).reshape(-1, 2)
    if len(paired) < LEAST_HITS:
        return paired
    own, theirs = board.t_s[paired[:, 0]], seen.t_s[paired[:, 1]]
    middle = own.mean()
    rate = np.polyfit(own - middle, theirs, 1)
    at_s = np.asarray(np.polyval(rate, board.t_s - middle), dtype=np.float64)
    near, hit = _match_times(seen, at_s, board.on, CLOSE_s)
    return np.column_stack([np.flatnonzero(hit), near[hit]])


def _match_times(
    seen: SeenEdges, at_s: FloatArray, on: npt.NDArray[np.bool_], slack_s: float
) -> tuple[IntArray, npt.NDArray[np.bool_]]:
    """Return the seen edge nearest to each time, and whether it was then and of that direction."""
    near = _nearest(seen.t_s, at_s)
    hit = (at_s >= seen.low_s[near] - slack_s) & (at_s <= seen.high_s[near] + slack_s)
    return near, hit & (seen.on[near] == on)


def _likely(board: Edges, seen: SeenEdges, group: IntArray) -> list[float]:
    leads = _leads(board, seen, group)
    hits = np.array([_best_lead(board, seen, group, leads[i : i + 1])[0] for i in range(leads.size)])
    good = leads[hits >= max(min(LEAST_HITS, group.size), 0.6 * group.size)]
    # leads closer together than the tolerance are one
    parts = np.split(good, np.flatnonzero(np.diff(good) > TOLERANCE_s) + 1)
    return [float(part.mean()) for part in parts if part.size]


def _leads(board: Edges, seen: SeenEdges, group: IntArray) -> FloatArray:
    leads = [seen.t_s[seen.on == board.on[i]] - board.t_s[i] for i in group[:LEAST_HITS]]
    return np.unique(np.concatenate(leads))


def _best_lead(board: Edges, seen: SeenEdges, group: IntArray, leads: FloatArray) -> tuple[int, float]:
    best = (0, 0.0)
    for lead in leads:
        own, theirs = _hits(board, seen, group, float(lead))
        if own.size:
            middle = float(np.median(seen.t_s[theirs] - board.t_s[own]))
            hits = int(_hits(board, seen, group, middle, CLOSE_s)[0].size)
            best = max(best, (hits, middle))
    return best


def _hits(
    board: Edges, seen: SeenEdges, group: IntArray, lead_s: float, slack_s: float = TOLERANCE_s
) -> tuple[IntArray, IntArray]:
    """Return which edges of a group were seen at a lead, and as which."""
    near, hit = _match_times(seen, board.t_s[group] + lead_s, board.on[group], slack_s)
    return group[hit], near[hit]


def _nearest(sorted_s: FloatArray, at_s: FloatArray) -> IntArray:
    right = np.clip(np.searchsorted(sorted_s, at_s), 1, max(sorted_s.size - 1, 1))
    left = right - 1
    right = np.minimum(right, sorted_s.size - 1)
    return np.where(at_s - sorted_s[left] <= sorted_s[right] - at_s, left, right)


def _follow(
    board: Edges, seen: SeenEdges, groups: Sequence[IntArray], lead_s: float, rate_error: float
) -> list[tuple[int, int]]:
    pairs: list[tuple[int, int]] = []
    trail: list[tuple[float, float]] = []
    drift, doubt = 0.0, rate_error
    for group in groups:
        at = float(board.t_s[group[0]])
        gap = abs(at - trail[-1][0]) if trail else 0.0
        expected = lead_s + drift * (at - trail[-1][0]) if trail else lead_s
        leads = _leads(board, seen, group)
        leads = leads[np.abs(leads - expected) <= TOLERANCE_s + doubt * gap]
        hits, best_s = _best_lead(board, seen, group, leads)
        if hits < min(LEAST_HITS, group.size):
            continue
        own, theirs = _hits(board, seen, group, best_s, CLOSE_s)
        pairs += zip(own.tolist(), theirs.tolist(), strict=True)
        lead_s = best_s
        trail.append((at, best_s))
        span = abs(at - trail[0][0])
        if span > 0:
            drift = (best_s - trail[0][1]) / (at - trail[0][0])
            doubt = min(rate_error, 2 * TOLERANCE_s / span)
    return pairs

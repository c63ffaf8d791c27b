"""One clock out of two: a light that one instrument switches and the other sees (clapperboard).

A frame shows of an edge only that it fell between two exposures, at 256 Hz 3.6 ms of doubt, or how much
of one exposure it cut off, and then to microseconds. Many edges narrow offset and rate down together:
each is a pair of bounds, ``low <= offset + rate * edge <= high``, and what fits all of them is a polygon
(linear programming). Edges that contradict the others cost slack and are reported.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.preprocess.edges import Edges, find_edges, match
from fdvv.units import FloatArray

PPM_LARGEST = 2e4
"""Two clocks that part by more than 2 % are not clocks."""
SLACK_s = 2e-4
"""An edge that misses its bounds by more than this contradicts the others."""


@dataclass(frozen=True)
class ClockFit:
    """How another clock runs against that of the board.

    Attributes
    ----------
    offset_s, rate : its time is offset_s + rate * board time.
    doubt_s : half of what offset may differ by within the bounds, at the edge where that is most.
    edges, refused : how many edges it rests on, and how many contradicted it.
    """

    offset_s: float
    rate: float = 1.0
    doubt_s: float = 0.0
    edges: int = 0
    refused: int = 0

    def board_s(self, other_s: FloatArray) -> FloatArray:
        """Return the board's time for one of the other clock."""
        return (other_s - self.offset_s) / self.rate


def align_clocks(
    board: Edges, frame_s: FloatArray, light: FloatArray, exposure_s: float, other: str = "camera"
) -> ClockFit:
    """Find how the camera's clock runs against the board's.

    board : when the light was switched, on the board's clock.
    frame_s, light : (f,) starts of exposures on the camera's clock and the part of each that was lit, 0 to 1,
        or any brightness that rises with it; NaN where a frame was lost.
    exposure_s : length of an exposure; 0 if unknown, then partly lit frames carry no more than others.

    Raises ModelError where no pattern of edges is common to both.
    """
    seen = find_edges(frame_s, light, exposure_s)
    pairs = match(board, seen, PPM_LARGEST * 1e-6)
    if not len(pairs):
        raise ModelError(
            f"the light's {board.t_s.size} switchings and the {seen.low_s.size} that the {other} saw have no "
            "pattern in common; check that they belong together"
        )
    edge_s, low_s, high_s = board.t_s[pairs[:, 0]], seen.low_s[pairs[:, 1]], seen.high_s[pairs[:, 1]]
    kept = _fits(edge_s, low_s, high_s)
    edge_s, low_s, high_s = edge_s[kept], low_s[kept], high_s[kept]
    return _polygon(edge_s, low_s, high_s, int(kept.size - kept.sum()))


def _fits(edge_s: FloatArray, low_s: FloatArray, high_s: FloatArray) -> npt.NDArray[np.bool_]:
    from scipy import sparse

    n, middle = edge_s.size, float(edge_s.mean())
    ones, away = np.ones(n), edge_s - middle
    base = float(np.median(0.5 * (low_s + high_s) - edge_s))
    # unknown: offset at the middle, rate - 1, slack of each edge
    line, slack = sparse.csr_array(np.column_stack([ones, away])), sparse.eye_array(n, format="csr")
    sides: Any = sparse.block_array([[-line, -slack], [line, -slack]], format="csr")
    limits = np.concatenate([-(low_s - edge_s - base), high_s - edge_s - base])
    bounds = [(None, None), (-PPM_LARGEST * 1e-6, PPM_LARGEST * 1e-6), *[(0, None)] * n]
    costs = np.concatenate([[0.0, 0.0], ones])
    return np.asarray(_least(costs, sides, limits, bounds)[2:] <= SLACK_s)


def _least(costs: Any, sides: Any, limits: FloatArray, bounds: Sequence[Any]) -> FloatArray:
    """Solve a linear program. Raises ModelError where nothing fits."""
    from scipy.optimize import linprog

    result: Any = linprog(costs, sides, limits, bounds=bounds, method="highs")
    if not result.success:
        raise ModelError(f"the two clocks cannot be joined by a line: {result.message}")
    return np.asarray(result.x)


def _polygon(edge_s: FloatArray, low_s: FloatArray, high_s: FloatArray, refused: int) -> ClockFit:
    """Find the middle of what all bounds allow, and how wide that is at the first, middle and last edge."""
    middle, span = float(edge_s.mean()), max(float(np.ptp(edge_s)), 1e-3)
    away = (edge_s - middle) / span
    base = float(np.median(0.5 * (low_s + high_s) - edge_s))
    line = np.column_stack([np.ones(away.size), away])
    sides = np.concatenate([-line, line])
    # in microseconds: the solver takes what differs by 1e-7 for the same
    # the slack that a few good edges need (noise of brightness) widens all bounds alike
    widen = 1e6 * np.concatenate([-(low_s - edge_s - base), high_s - edge_s - base])
    most = PPM_LARGEST * span
    bounds = [(None, None), (-most, most)]
    slack = np.column_stack([sides, -np.ones(widen.size)])
    least = _least([0.0, 0.0, 1.0], slack, widen, [*bounds, (0, None)])
    # with the least slack a single line is left, which would seem certain: as much again is doubt,
    # and a nanosecond for the solver's rounding
    limits = widen + 2 * float(least[2]) + 1e-3
    places = (away.min(), 0.0, away.max())
    # (place, sign, offset and tilt)
    ends = [[_least([s, s * at], sides, limits, bounds) for s in (1.0, -1.0)] for at in places]
    corners = 1e-6 * np.array(ends)
    offset, tilt = corners.reshape(-1, 2).mean(axis=0)
    widths = [0.5 * abs(np.diff(pair @ [1.0, at])[0]) for pair, at in zip(corners, places, strict=True)]
    rate = 1 + tilt / span
    return ClockFit(base + offset - (rate - 1) * middle, rate, float(max(widths)), int(edge_s.size), refused)

"""What two clocks were joined by: every edge of the light with its bounds, to be looked at."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.preprocess._clock import ClockFit
from fdvv.preprocess._edges import seen_edges
from fdvv.preprocess._takes import switched_light
from fdvv.recording import Quantity, Recording
from fdvv.units import FloatArray


@dataclass(frozen=True, eq=False)
class EdgeBounds:
    """Edges of a light as a camera bounds them, less the fitted line.

    Attributes
    ----------
    board_s : (n,) when each was switched, on the board's clock.
    low_s, high_s : (n,) what the frames bound it by, on the camera's clock, less where the line puts it.
        An edge agrees with the line where low_s <= 0 <= high_s.
    """

    board_s: FloatArray
    low_s: FloatArray
    high_s: FloatArray


def edge_bounds(recording: Recording, clock: ClockFit) -> EdgeBounds | None:
    """Give the bounds of every edge that both clocks know; None where no light joined them.

    Each switching is paired with the nearest edge of its direction that was seen, as the line leads.
    """
    lights = [s.clock for take in recording.takes for s in take.of(Quantity.LIGHT)]
    marks = [m.clock for take in recording.takes for m in take.marks if m.name.startswith("light")]
    if not clock.edges or not lights or not marks:
        return None
    edges, frame_s, light = switched_light(recording, marks[0], lights[0])
    seen = seen_edges(frame_s, light, 1e-3 * recording.bench.exposure_ms)
    found = []
    for direction in (True, False):
        board_s = edges.t_s[edges.on == direction]
        there = np.flatnonzero(seen.on == direction)
        if not there.size or not board_s.size:
            continue
        line_s = clock.offset_s + clock.rate * board_s
        nearest = there[np.abs(seen.t_s[there][None, :] - line_s[:, None]).argmin(axis=1)]
        found.append(np.stack([board_s, seen.low_s[nearest] - line_s, seen.high_s[nearest] - line_s]))
    table: FloatArray = np.concatenate(found, axis=1).astype(np.float64)
    return EdgeBounds(*table[:, np.argsort(table[0])])

"""One press as it comes out of a recording: samples and frames on one clock, nothing averaged yet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.model.curve import Stroke
from fdvv.units import FloatArray

GUARD_s = 0.02
"""Rest ends this long before the cap is seen to move, and begins this long after it came back."""


@dataclass(frozen=True, eq=False)
class RawPress:
    """A press and its release on the clock of the force.

    Attributes
    ----------
    take, part : number of its take, and which press of that take, both from 1.
    velocity_mm_s : the requested velocity; None if none was.
    t_s, force_cN : (n,) even times and what the force sensor felt, its filter undone, zero taken off.
    frame_s, frame_mm : (k,) middle of each exposure, and how deep the cap was; 0 at rest before the press.
    apart_mm : (k,) how far the two markers went from each other; NaN where not both were seen, or one is all.
    closed_s, open_s : when the circuit closed first and opened last; None if it did not or nobody looked.
    """

    take: int
    part: int
    velocity_mm_s: float | None
    t_s: FloatArray
    force_cN: FloatArray
    frame_s: FloatArray
    frame_mm: FloatArray
    apart_mm: FloatArray
    closed_s: float | None = None
    open_s: float | None = None

    @property
    def name(self) -> str:
        return f"take {self.take}" if self.part == 1 else f"take {self.take}, press {self.part}"


@dataclass(frozen=True)
class Spans:
    """When the strokes of a press begin and end, seconds on its clock.

    Attributes
    ----------
    start_s : the cap leaves its rest.
    bottom_s, leave_s : it reaches the lowest place and leaves it again.
    end_s : it is back at rest.
    bottom_mm : the lowest place, as a median over the time there.
    """

    start_s: float
    bottom_s: float
    leave_s: float
    end_s: float
    bottom_mm: float

    @property
    def rest_end_s(self) -> float:
        """End of the rest before the press."""
        return self.start_s - GUARD_s

    def of(self, stroke: Stroke) -> tuple[float, float]:
        return (self.start_s, self.bottom_s) if stroke is Stroke.PRESS else (self.leave_s, self.end_s)


@dataclass(frozen=True, eq=False)
class StrokeTrack:
    """One stroke of a press, reconstructed at the samples of the force.

    Attributes
    ----------
    take, part, stroke : of which press, and which stroke of it.
    t_s, displacement_mm, velocity_mm_s, acceleration_m_s2 : (n,) of the cap; velocity signed, down positive.
    force_cN : (n,) between finger and cap: what the tip's own mass took is given back.
    """

    take: int
    part: int
    stroke: Stroke
    t_s: FloatArray
    displacement_mm: FloatArray
    velocity_mm_s: FloatArray
    acceleration_m_s2: FloatArray
    force_cN: FloatArray


MOVED_mm = 0.3
"""The cap is being pressed when it is deeper than this, and was not when it is back within half of it."""
LEFT_mm = 0.05
"""A stroke begins, or ends, this far from rest: the paper's bin."""
NEAR_mm = 0.12
"""Closer than this to the lowest place is at the bottom; stops give way by less, frames are noisy by less."""
SPEED_START_mm = 0.1
"""Mean speed counts from this depth to the bottom."""


def excursions(depth_mm: FloatArray) -> list[tuple[int, int]]:
    """Find presses in a record of depth whose rest is 0: (first, last) index of each, rest left out."""
    spans = []
    start: int | None = None
    for i, depth in enumerate(depth_mm):
        if start is None and depth > MOVED_mm:
            start = i
        elif start is not None and depth < 0.5 * MOVED_mm:
            spans.append((start, i))
            start = None
    return spans if start is None else [*spans, (start, depth_mm.size - 1)]


def whole_press(press: RawPress) -> tuple[int, int]:
    """Find the press of a record that holds one: from its first to its last deep frame."""
    deep = np.flatnonzero(press.frame_mm > MOVED_mm)
    if not deep.size:
        return 0, press.frame_mm.size - 1
    back = np.flatnonzero(press.frame_mm[deep[-1] :] < 0.5 * MOVED_mm)
    return int(deep[0]), int(deep[-1] + back[0]) if back.size else press.frame_mm.size - 1


def spans_of(t_s: FloatArray, depth_mm: FloatArray, excursion: tuple[int, int]) -> Spans:
    """Find the strokes of one press; between frames on a line.

    The lowest place is the median of what lies within 0.12 mm of the deepest frame.
    """
    first, last = excursion
    inside = depth_mm[first : last + 1]
    bottom = float(np.median(inside[inside >= inside.max() - NEAR_mm]))
    low = np.flatnonzero(inside >= bottom - NEAR_mm) + first
    before = np.flatnonzero(depth_mm[:first] < LEFT_mm)
    after = np.flatnonzero(depth_mm[last:] < LEFT_mm)
    start = int(before[-1]) if before.size else 0
    end = int(after[0]) + last if after.size else depth_mm.size - 1
    return Spans(
        _when(t_s, depth_mm, start, LEFT_mm),
        _when(t_s, depth_mm, int(low[0]) - 1, bottom - NEAR_mm),
        _when(t_s, depth_mm, int(low[-1]), bottom - NEAR_mm),
        _when(t_s, depth_mm, end - 1, LEFT_mm),
        bottom,
    )


def _when(t_s: FloatArray, depth_mm: FloatArray, i: int, level_mm: float) -> float:
    i = min(max(i, 0), t_s.size - 2)
    rise = depth_mm[i + 1] - depth_mm[i]
    part = (level_mm - depth_mm[i]) / rise if rise else 0.5
    return float(t_s[i] + min(max(part, 0.0), 1.0) * (t_s[i + 1] - t_s[i]))


def press_speed_mm_s(press: RawPress, spans: Spans) -> float:
    """Return the mean speed of the press between 0.1 mm and the bottom; NaN where it is undefined.

    Both ends lie between frames; they are found on lines, so one press at 200 mm/s is known to some per cent.
    """
    down = (press.frame_s >= spans.start_s) & (press.frame_s <= spans.leave_s)
    t, x = press.frame_s[down], press.frame_mm[down]
    if t.size < 2:
        return float("nan")
    deepest = np.maximum.accumulate(x)
    above = np.flatnonzero(deepest > SPEED_START_mm)
    if not above.size or spans.bottom_mm <= SPEED_START_mm + NEAR_mm:
        return float("nan")
    last_above = int(np.flatnonzero(down)[0]) + int(above[0]) - 1
    start_s = _when(press.frame_s, press.frame_mm, last_above, SPEED_START_mm)
    end_mm = spans.bottom_mm - NEAR_mm
    return (end_mm - SPEED_START_mm) / max(spans.bottom_s - start_s, 1e-6)


def common_bottom_mm(bottoms_mm: Sequence[float]) -> float:
    """Find the stop from the lowest places of many presses: the middle of the densest 0.12 mm.

    Presses that did not reach the stop end anywhere, those that did end together.
    """
    places = np.sort(np.asarray(bottoms_mm, dtype=np.float64))
    counts = np.searchsorted(places, places + NEAR_mm, side="right") - np.arange(places.size)
    # of equally full windows the deepest: a stop is where the cap cannot go on
    first = int(places.size - 1 - np.argmax(counts[::-1]))
    return float(np.median(places[first : first + counts[first]]))

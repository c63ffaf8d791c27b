"""One press as it comes out of a recording: samples and frames on one clock, nothing averaged yet."""

from __future__ import annotations

from dataclasses import dataclass

from fdvv.model import Stroke
from fdvv.units import FloatArray

GUARD_s = 0.02
"""Rest ends this long before the cap is seen to move, and begins this long after it came back."""


@dataclass(frozen=True, eq=False)
class RawPress:
    """A press and its release on the clock of the force.

    Attributes
    ----------
    take, part : number of its take, and which press of that take, both from 1.
    velocity_mm_s : pace that was asked for; None if none was.
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
        """Name the press for messages."""
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
    def rested_s(self) -> float:
        """Until when the cap surely rests before the press."""
        return self.start_s - GUARD_s

    def of(self, stroke: Stroke) -> tuple[float, float]:
        """Give begin and end of one stroke."""
        return (self.start_s, self.bottom_s) if stroke is Stroke.PRESS else (self.leave_s, self.end_s)


@dataclass(frozen=True, eq=False)
class StrokeTrack:
    """One stroke of a press, reconstructed at the samples of the force.

    Attributes
    ----------
    take, part : of which press.
    stroke : press or release.
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

"""Whether a press may be used: the reasons why not, each with what to do about it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fdvv.compensate._strokes import Span, mean_speed_mm_s, split_strokes, why_incomplete
from fdvv.errors import ModelError
from fdvv.model import Press
from fdvv.units import FloatArray

PAUSE_WINDOW_ratio = 1 / 16
"""Part of the travel in which a finger that pauses stays: 0.25 of 4 mm."""

MS_PER_s = 1000.0


@dataclass(frozen=True)
class Acceptance:
    """Bounds that a press keeps to be used.

    Attributes
    ----------
    pace_ratio : largest distance of the achieved mean speed from the one asked for, as a part of it. People
        who follow a pace spread by 0.08 to 0.15; three such deviations of a habit of 0.12 are still used.
        Infinite: any pace.
    lifted_mm : largest way back on the way down. A finger that presses through goes back by 0.01 mm.
    paused_ratio : largest part of the stroke's time spent within a sixteenth of the travel; a press in one
        go, slow where it begins, spends up to a quarter.
    saturated_ratio : largest part of both strokes at which the rig was at its limit. Beyond it the felt force
        is not what a table asked for. 1 where the rig itself is judged: then its limit is part of the result.
    patience : after so many presses in a row that cannot be used the session stops.
    """

    pace_ratio: float = 0.35
    lifted_mm: float = 0.2
    paused_ratio: float = 0.5
    saturated_ratio: float = 0.25
    patience: int = 10

    def __post_init__(self) -> None:
        parts, above = (self.paused_ratio, self.saturated_ratio), (self.pace_ratio, self.lifted_mm)
        if not (all(0 < p <= 1 for p in parts) and all(p > 0 for p in above) and self.patience >= 1):
            told = "other ratios in 0..1, patience at least 1"
            raise ModelError(f"pace_ratio and lifted_mm must be above 0, {told}, got {self}")

    def at_pace(self, pace_ratio: float | None) -> Acceptance:
        """Give the bounds with another one for the pace; the same for None."""
        return self if pace_ratio is None else replace(self, pace_ratio=pace_ratio)


@dataclass(frozen=True)
class Verdict:
    """What was found of one press.

    Attributes
    ----------
    reason : why it cannot be used and what to do; empty if it can.
    achieved_mm_s : mean speed of the press between the guards; NaN if it has none.
    """

    reason: str
    achieved_mm_s: float


def rig_columns(press: Press) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Give time, displacement and force as the rig knows them, at its ticks; the true ones without a rig."""
    rows = np.ones(press.t_s.size, dtype=np.bool_) if press.tick is None else press.tick
    sensed = press.displacement_mm if press.sensed_mm is None else press.sensed_mm
    force = press.force_cN if press.sensed_cN is None else press.sensed_cN
    return press.t_s[rows], sensed[rows], force[rows]


def judge(
    press: Press, travel_mm: float, bounds: Acceptance | None = None, true_position: bool = False
) -> Verdict:
    """Tell whether a press may be used, from its record alone.

    true_position : judge by the true displacement of the cap; else by what the rig sensed at its ticks, which
        is all that is known of a real one.
    """
    bounds = bounds or Acceptance()
    t_s, x_mm = (press.t_s, press.displacement_mm) if true_position else rig_columns(press)[:2]
    if x_mm.size < 2 or not np.isfinite(x_mm).all():
        return Verdict(
            "the record holds no samples that can be used; check the position sensor", float("nan")
        )
    reason = why_incomplete(x_mm, travel_mm)
    if reason:
        return Verdict(f"{reason}; press down to the stop, from the top", float("nan"))
    down, up = split_strokes(x_mm, travel_mm)
    speed = mean_speed_mm_s(t_s, x_mm, down)
    if not np.isfinite(speed):
        return Verdict("too few samples between the guards to tell the speed; press slower", speed)
    found = (
        _off_pace(speed, press.velocity_mm_s, bounds.pace_ratio),
        _lifted(x_mm[down.rows], bounds.lifted_mm),
        _paused(t_s[down.rows], x_mm[down.rows], travel_mm, bounds.paused_ratio),
        _saturated(press, (t_s, down, up), bounds.saturated_ratio),
        "" if true_position else _numb(press),
    )
    return Verdict(next(filter(None, found), ""), speed)


def _numb(press: Press) -> str:
    """Notice a force sensor that tells one value throughout, as one does whose wire is broken."""
    if press.sensed_cN is None or np.ptp(press.sensed_cN) > 0:
        return ""
    return f"the force sensor told {press.sensed_cN[0]:g} cN throughout; check it and its cable"


def _off_pace(achieved_mm_s: float, asked_mm_s: float, bound: float) -> str:
    if abs(achieved_mm_s / asked_mm_s - 1) <= bound:
        return ""
    remedy = "slower" if achieved_mm_s > asked_mm_s else "faster"
    return f"{achieved_mm_s:.0f} mm/s, asked for {asked_mm_s:g}: press {remedy}"


def _lifted(x_mm: FloatArray, bound_mm: float) -> str:
    back = np.maximum.accumulate(x_mm) - x_mm
    at = int(back.argmax())
    if back[at] <= bound_mm:
        return ""
    return f"the finger was lifted at {x_mm[: at + 1].max():.2f} mm on its way down; press in one go"


def _paused(t_s: FloatArray, x_mm: FloatArray, travel_mm: float, bound: float) -> str:
    """Find the longest time in which the cap did not get on by the window."""
    deepest = np.maximum.accumulate(x_mm)
    left = np.searchsorted(deepest, deepest + PAUSE_WINDOW_ratio * travel_mm)
    spent = t_s[np.minimum(left, t_s.size - 1)] - t_s
    at = int(spent.argmax())
    if spent[at] <= bound * (t_s[-1] - t_s[0]):
        return ""
    middle = float(np.interp(t_s[at] + spent[at] / 2, t_s, deepest))
    return f"the finger paused at {middle:.2f} mm for {spent[at] * MS_PER_s:.0f} ms; press in one go"


def _saturated(press: Press, strokes: tuple[FloatArray, Span, Span], bound: float) -> str:
    """Find the part of the strokes at which a command was cut."""
    if press.saturated is None:
        return ""
    t_s, down, up = strokes
    cut = press.saturated[np.searchsorted(press.t_s, t_s)]
    part = float(np.concatenate([cut[down.rows], cut[up.rows]]).mean())
    if part <= bound:
        return ""
    return f"the rig was at its limit for {part:.0%} of the strokes; choose slower speeds or a lighter button"

"""Acceptance of a press: its strokes, their speed, and the reason why it cannot be used."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fdvv.compensation.parts.rules import silent_fault
from fdvv.errors import ModelError
from fdvv.model.press import Press
from fdvv.units import FloatArray

EDGE_mm = 0.1
"""Guard at both ends of the travel: initial contact at the top, bounce at the stop."""
HOME_mm = 0.1
"""A resting cap is above this displacement, outside the range that is learned."""
FROM_mm, STOP_GUARD_mm = 0.3, 0.1
"""Errors count from 0.3 mm, after contact, to 0.1 mm before the stop."""
SHORT_mm = 0.3
"""A press that ends this far before the stop did not reach it; a servo sets its stop to 0.1 mm."""


def why_incomplete(displacement_mm: FloatArray, travel_mm: float) -> str:
    """Return why a record is not one press down to the stop; empty if it is.

    It must begin in the upper half and reach the last 0.3 mm of the travel. A cap that does not return
    fully is a fault of the table, not of the press, and is left for the law to correct.
    """
    deepest = float(displacement_mm.max())
    if displacement_mm[0] > 0.5 * travel_mm:
        return f"the cap rested at {displacement_mm[0]:.2f} mm, where it should be up"
    if deepest < travel_mm - SHORT_mm:
        return f"the press stopped at {deepest:.2f} of {travel_mm:.2f} mm"
    return ""


def split_strokes(displacement_mm: FloatArray, travel_mm: float) -> tuple[slice, slice]:
    """Return the rows of press and release of a record that reached the stop, each between the guards.

    The press runs from the last time at the upper guard to the first time at the lower one, the release
    from the last time at the lower guard to the next time at the upper one: dwell, impact and what came
    before contact belong to neither. The lower guard lies 0.1 mm before the stop, or before the deepest
    point where that is less deep; the upper one at 0.1 mm, or that far below where the cap rests.
    """
    deep = np.flatnonzero(displacement_mm >= min(travel_mm, float(displacement_mm.max())) - EDGE_mm)
    first, last = int(deep[0]), int(deep[-1])
    before = np.flatnonzero(displacement_mm[:first] <= _upper(displacement_mm[0]))
    after = np.flatnonzero(displacement_mm[last:] <= _upper(displacement_mm[-1]))
    start = int(before[-1]) + 1 if before.size else 0
    end = last + int(after[0]) if after.size else displacement_mm.size
    return slice(start, first), slice(last + 1, max(last + 1, end))


def _upper(rest_mm: float) -> float:
    return EDGE_mm if rest_mm <= EDGE_mm else rest_mm + EDGE_mm


def mean_speed_mm_s(t_s: FloatArray, displacement_mm: FloatArray, stroke: slice) -> float:
    """Return the mean speed of a stroke between the guards, always positive; NaN for fewer than 2 rows."""
    t, x = t_s[stroke], displacement_mm[stroke]
    return float(abs(x[-1] - x[0]) / (t[-1] - t[0])) if t.size > 1 else float("nan")


PAUSE_WINDOW_ratio = 1 / 16
"""Part of the travel within which a finger counts as paused: 0.25 of 4 mm."""
MS_PER_s = 1000.0  # by definition


@dataclass(frozen=True)
class AcceptanceLimits:
    """Bounds within which a press is used.

    Attributes
    ----------
    pace_ratio : largest relative deviation of the achieved mean speed from the requested one. People who
        follow a pace spread by 0.08 to 0.15; three standard deviations of 0.12 are accepted. Infinite: any
        speed.
    lifted_mm : largest upward motion during the press. A continuous press goes back by 0.01 mm.
    paused_ratio : largest part of the stroke's time spent within a sixteenth of the travel; a continuous
        press with a slow start spends up to a quarter.
    saturated_ratio : largest part of both strokes in which the rig was at its limit, where it does not render
        what the table commands. 1 where the rig itself is judged: its limit is part of the result.
    patience : the session stops after this many unusable presses in a row.
    """

    pace_ratio: float = 0.35
    lifted_mm: float = 0.2
    paused_ratio: float = 0.5
    saturated_ratio: float = 0.25
    patience: int = 10

    def __post_init__(self) -> None:
        parts, above = (self.paused_ratio, self.saturated_ratio), (self.pace_ratio, self.lifted_mm)
        if not (all(0 < p <= 1 for p in parts) and all(p > 0 for p in above) and self.patience >= 1):
            raise ModelError(
                "pace_ratio and lifted_mm must be above 0, other ratios in 0..1, patience at least 1, "
                f"got {self}"
            )

    def with_pace(self, pace_ratio: float | None) -> AcceptanceLimits:
        """Return the bounds with another pace_ratio; unchanged for None."""
        return self if pace_ratio is None else replace(self, pace_ratio=pace_ratio)


@dataclass(frozen=True)
class PressAcceptance:
    """Whether a press can be used.

    Attributes
    ----------
    reason : why it cannot be used and the remedy; empty if it can.
    achieved_mm_s : mean speed of the press between the guards; NaN if undefined.
    """

    reason: str
    achieved_mm_s: float


def rig_columns(press: Press) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return time, displacement and force as sensed at the rig's ticks; the true ones without a rig."""
    rows = np.ones(press.t_s.size, dtype=np.bool_) if press.tick is None else press.tick
    sensed = press.displacement_mm if press.sensed_mm is None else press.sensed_mm
    force = press.force_cN if press.sensed_cN is None else press.sensed_cN
    return press.t_s[rows], sensed[rows], force[rows]


def judge_press(
    press: Press, travel_mm: float, bounds: AcceptanceLimits | None = None, true_position: bool = False
) -> PressAcceptance:
    """Decide from its record whether a press can be used.

    true_position : use the true displacement of the cap; else the one sensed at the rig's ticks, all that a
        real rig records.
    """
    bounds = bounds or AcceptanceLimits()
    t_s, x_mm = (press.t_s, press.displacement_mm) if true_position else rig_columns(press)[:2]
    if x_mm.size < 2 or not np.isfinite(x_mm).all():
        return PressAcceptance("the record holds no usable samples; check the position sensor", float("nan"))
    reason = why_incomplete(x_mm, travel_mm)
    if reason:
        return PressAcceptance(f"{reason}; press down to the stop, from the top", float("nan"))
    down, up = split_strokes(x_mm, travel_mm)
    speed = mean_speed_mm_s(t_s, x_mm, down)
    if not np.isfinite(speed):
        return PressAcceptance("too few samples between the guards to measure the speed; press slower", speed)
    reasons = (
        _off_pace(speed, press.velocity_mm_s, bounds.pace_ratio),
        _explain_lift(x_mm[down], bounds.lifted_mm),
        _explain_pause(t_s[down], x_mm[down], travel_mm, bounds.paused_ratio),
        _explain_saturation(press, (t_s, down, up), bounds.saturated_ratio),
        "" if true_position else _silent_sensor(press),
    )
    return PressAcceptance(next(filter(None, reasons), ""), speed)


def _silent_sensor(press: Press) -> str:
    fault = None if press.sensed_cN is None else silent_fault(press.sensed_cN)
    return "" if fault is None else str(fault)


def _off_pace(achieved_mm_s: float, requested_mm_s: float, bound: float) -> str:
    if abs(achieved_mm_s / requested_mm_s - 1) <= bound:
        return ""
    remedy = "slower" if achieved_mm_s > requested_mm_s else "faster"
    return f"{achieved_mm_s:.0f} mm/s instead of {requested_mm_s:g}: press {remedy}"


def _explain_lift(x_mm: FloatArray, bound_mm: float) -> str:
    back = np.maximum.accumulate(x_mm) - x_mm
    at = int(back.argmax())
    if back[at] <= bound_mm:
        return ""
    return f"the finger was lifted at {x_mm[: at + 1].max():.2f} mm on its way down; press without stopping"


def _explain_pause(t_s: FloatArray, x_mm: FloatArray, travel_mm: float, bound: float) -> str:
    """Find the longest time within one window of displacement."""
    deepest = np.maximum.accumulate(x_mm)
    left = np.searchsorted(deepest, deepest + PAUSE_WINDOW_ratio * travel_mm)
    spent = t_s[np.minimum(left, t_s.size - 1)] - t_s
    at = int(spent.argmax())
    if spent[at] <= bound * (t_s[-1] - t_s[0]):
        return ""
    middle = float(np.interp(t_s[at] + spent[at] / 2, t_s, deepest))
    return f"the finger paused at {middle:.2f} mm for {spent[at] * MS_PER_s:.0f} ms; press without stopping"


def _explain_saturation(press: Press, strokes: tuple[FloatArray, slice, slice], bound: float) -> str:
    if press.saturated is None:
        return ""
    t_s, down, up = strokes
    cut = press.saturated[np.searchsorted(press.t_s, t_s)]
    part = float(np.concatenate([cut[down], cut[up]]).mean())
    if part <= bound:
        return ""
    return f"the rig was at its limit for {part:.0%} of the strokes; choose slower speeds or a lighter button"

"""Which presses may not be averaged, and why."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from fdvv.preprocess.average import Pooled
from fdvv.preprocess.press import NEAR_mm, RawPress, Spans, common_bottom_mm, press_speed_mm_s
from fdvv.units import FloatArray


class Reason(StrEnum):
    """Why a press is left out."""

    INCOMPLETE = "did not reach the bottom"
    TOO_DEEP = "a marker moved on the cap: the press seems deeper than the stop"
    MARKERS = "the markers moved against each other"
    UNSEEN = "too few frames show it"
    TWO = "two presses where one was asked for"
    OFF_PACE = "far off the pace of the others"
    HESITATION = "the finger stopped on the way"
    FORCE = "its force is unlike that of the others"


@dataclass(frozen=True)
class Limits:
    """When a press is left out; all but the last look at the motion alone, so that they cannot shape a curve.

    Attributes
    ----------
    short_mm : that much above the stop is not at the bottom.
    apart_mm : the markers may differ so much more after the press than before.
    slowest_ratio, fastest_ratio : of the median speed at the same velocity.
    stop_ratio : part of the stroke's time that the cap may spend within a twentieth of the travel.
    unlike : a press may differ from the mean by so many times what presses differ by.
    """

    short_mm: float = NEAR_mm
    apart_mm: float = 0.08
    slowest_ratio: float = 0.62
    fastest_ratio: float = 1.6
    stop_ratio: float = 0.4
    unlike: float = 4.0


@dataclass(frozen=True)
class Judged:
    """One press and what is thought of it.

    Attributes
    ----------
    press, spans : the record and its strokes.
    achieved_mm_s : mean speed of its press.
    reason : why it is left out; None if it is not.
    """

    press: RawPress
    spans: Spans
    achieved_mm_s: float
    reason: Reason | None = None


def judge(presses: Sequence[RawPress], spans: Sequence[Spans], limits: Limits) -> list[Judged]:
    """Judge presses by how the cap moved; the first reason found counts.

    The stop is found from all of them, so one press alone is complete by definition.
    """
    if not presses:
        return []
    bottom_mm = common_bottom_mm([span.bottom_mm for span in spans])
    several = {press.take for press in presses if press.part > 1}
    judged = []
    for press, span in zip(presses, spans, strict=True):
        two = press.velocity_mm_s is not None and press.take in several
        reason = _reason(press, span, bottom_mm, two, limits)
        judged.append(Judged(press, span, press_speed_mm_s(press, span), reason))
    return _off_pace(judged, limits)


def _reason(press: RawPress, span: Spans, bottom_mm: float, two: bool, limits: Limits) -> Reason | None:
    during = (press.frame_s >= span.start_s) & (press.frame_s <= span.end_s)
    if during.sum() < 4:
        return Reason.UNSEEN
    if _was_knocked(press, span, limits.apart_mm):
        return Reason.MARKERS
    if span.bottom_mm > bottom_mm + 1.5 * limits.short_mm:
        return Reason.TOO_DEEP
    if span.bottom_mm < bottom_mm - limits.short_mm:
        return Reason.INCOMPLETE
    if two:
        return Reason.TWO
    return Reason.HESITATION if _has_pause(press, span, limits.stop_ratio) else None


def _was_knocked(press: RawPress, span: Spans, apart_mm: float) -> bool:
    before = press.apart_mm[press.frame_s < span.start_s]
    after = press.apart_mm[press.frame_s > span.end_s]
    before, after = before[np.isfinite(before)], after[np.isfinite(after)]
    if before.size < 3 or after.size < 3:
        return False
    return abs(float(np.median(after)) - float(np.median(before))) > apart_mm


def _has_pause(press: RawPress, span: Spans, stop_ratio: float) -> bool:
    """Return whether the cap rested between a tenth and four fifths of the way down.

    The longest time within a twentieth of the travel is compared with the time of the stroke.
    """
    t, x = press.frame_s, press.frame_mm
    down = (t >= span.start_s) & (t <= span.bottom_s)
    down &= (x > 0.1 * span.bottom_mm) & (x < 0.8 * span.bottom_mm)
    t, x = t[down], x[down]
    if t.size < 4:
        return False
    longest = max(float(t[np.abs(x - x[i]) < 0.025 * span.bottom_mm].max() - t[i]) for i in range(t.size))
    frame_s = float(np.median(np.diff(press.frame_s)))
    return longest > stop_ratio * (span.bottom_s - span.start_s) and longest > 2.5 * frame_s


def _off_pace(entries: Sequence[Judged], limits: Limits) -> list[Judged]:
    speeds: dict[float, list[float]] = {}
    for entry in entries:
        if entry.press.velocity_mm_s is not None and entry.reason is None:
            speeds.setdefault(entry.press.velocity_mm_s, []).append(entry.achieved_mm_s)
    usual = {requested_mm_s: float(np.nanmedian(achieved)) for requested_mm_s, achieved in speeds.items()}
    judged = []
    for entry in entries:
        if entry.press.velocity_mm_s is not None and entry.reason is None:
            ratio = entry.achieved_mm_s / usual[entry.press.velocity_mm_s]
            # an unknown speed is off, too
            if not limits.slowest_ratio <= ratio <= limits.fastest_ratio:
                entry = replace(entry, reason=Reason.OFF_PACE)
        judged.append(entry)
    return judged


GAIN_OFF = 0.1
"""Presses at one velocity differ in force as a whole by less: that is its own spread."""
LEAST_USUAL_cN = 1.0
"""What presses differ by is never taken as less."""
FEWEST = 3
"""Among so few no outlier can be detected."""


def unlike(pooled: Pooled, limit: float) -> list[int]:
    """Find presses that differ from the mean by much more than presses do, the worst first."""
    slipped = _find_slips(pooled)
    if slipped:
        return slipped
    apart = np.sqrt(np.nanmean(pooled.apart_cN**2, axis=1))
    return _worst(apart, limit * max(float(np.median(apart)), LEAST_USUAL_cN))


def _worst(off: FloatArray, limit: float) -> list[int]:
    """Find what is off by more than a limit and half of the worst; the others are judged again without it."""
    far = np.flatnonzero((off > limit) & (off >= 0.5 * off.max()))
    return far.tolist() if off.size > FEWEST else []


def _find_slips(pooled: Pooled) -> list[int]:
    """Find presses whose force is the others' times a number: the sensor slipped or was tilted."""
    gains = []
    for apart in pooled.apart_cN:
        seen = np.isfinite(apart)
        mean = pooled.force_cN[seen]
        gains.append(1 + float(apart[seen] @ mean) / max(float(mean @ mean), 1e-9))
    off = np.abs(np.array(gains) - np.median(gains))
    return _worst(off, max(GAIN_OFF, 4 * 1.4826 * float(np.median(off))))

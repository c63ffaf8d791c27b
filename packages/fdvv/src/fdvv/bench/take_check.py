"""A quick check of a take that was just made against the plan."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fdvv.recording.types import Quantity, Stage, Take
from fdvv.units import FloatArray

START_mm = 0.1
"""Where a stroke's speed begins to count, as in the twin (docs: twin.md); 3.5 times its markers' noise."""
SHORT_mm = 0.15
"""A press that stays so far from the bottom is incomplete: the least by which the twin misses it."""
STILL_mm, STILL_cN = 0.5, 15.0
"""A bench at rest moves and pulls less: 18 and 50 times the rms noise of the twin's bench; assumed."""
KNOCKED_mm = 0.2
"""Markers that come back to rest by so much differently from each other were knocked. The twin knocks by
0.5 mm and more; medians of 16 frames with its 40 um of noise differ by 0.04 mm (calculated)."""
GAP_s = 0.015
"""Longest time in a stroke without displacement: two frames lost in a row leave 12 ms at
256/s; the twin hides a marker for 20 ms and more."""
FELT_mm = 0.5
"""Less is no press: a third of real files' least travel, 1.49 mm; metal domes have less (plausible.py)."""
FELT_cN = 25.0
"""More than a finger that rests on the cap, 10 cN in the twin; a press goes beyond, typing from 60 cN on."""
FEWEST, REST_PART = 16, 8
"""Fewest frames that show anything: two for the rest. The first part of a take shows the cap at rest: an
eighth is less than the 0.18 s before the twin's finger moves, in takes below 1.4 s."""
HALT_s, HALT_mm = 0.03, 0.2
"""A stroke halts where this way takes so long, or six times what its mean speed needs; assumed. Of the twin's
halts, 80 to 300 ms, 398 of 480 are noticed; of 480 good presses 4 are refused (docs: capture-bench.md)."""


@dataclass(frozen=True)
class TakeCheck:
    """Whether a take can be used.

    Attributes
    ----------
    ok : the take can be used.
    achieved_mm_s : mean speed of the stroke down; NaN if there is none.
    travel_mm : how far the cap went; NaN if it is unknown.
    reason : why it cannot be used and what to do; empty if it can.
    """

    ok: bool
    achieved_mm_s: float = math.nan
    travel_mm: float = math.nan
    reason: str = ""


def quick_look(take: Take, travel_mm: float | None = None, pace_ratio: float = 0.35) -> TakeCheck:
    """Check a take by its own clock.

    travel_mm : of the button, None while it is unknown. pace_ratio : by which a press may miss its pace.
    """
    if take.stage is Stage.REST:
        return _rest(take)
    if take.stage is Stage.PROBE:
        return _probe(take, travel_mm)
    track = _displacement(take)
    if isinstance(track, TakeCheck):
        return track if take.of(Quantity.MARKER) or take.of(Quantity.DISPLACEMENT) else _force(take, track)
    return _press(take.velocity_mm_s, *track, travel_mm, pace_ratio)


def _force(take: Take, unseen: TakeCheck) -> TakeCheck:
    """Check by the force alone, where cameras record on their own and are joined later."""
    if not take.of(Quantity.FORCE):
        return unseen
    force_cN = take.of(Quantity.FORCE)[0].values
    pressed = force_cN > np.median(force_cN[: force_cN.size // REST_PART]) + FELT_cN
    reason = "" if pressed.any() else "no press was felt; press when the bar goes down"
    return TakeCheck(not reason, reason=reason)


def _rest(take: Take) -> TakeCheck:
    forces = [float(np.ptp(stream.values)) for stream in take.of(Quantity.FORCE)]
    track = _displacement(take)
    moved_mm = 0.0 if isinstance(track, TakeCheck) else float(np.ptp(track[1]))
    touched = max(forces, default=0.0) > STILL_cN or moved_mm > STILL_mm
    reason = "something touched the bench; take the finger off and wait" if touched else ""
    return TakeCheck(not touched, reason=reason)


def _probe(take: Take, travel_mm: float | None) -> TakeCheck:
    displacements, forces = take.of(Quantity.DISPLACEMENT), take.of(Quantity.FORCE)
    if not displacements or not forces:
        track = _displacement(take)
        return track if isinstance(track, TakeCheck) else _deep(float(track[1].max()), travel_mm)
    displacement, force = displacements[0], forces[0]
    turn = int(np.argmax(displacement.values))
    force_cN = np.interp(displacement.t_s, force.t_s, force.values)
    loaded = np.flatnonzero(force_cN[: turn + 1] > force_cN[:10].mean() + 3.0)
    if not loaded.size:
        return TakeCheck(False, reason="the probe felt no force; lead it down until the stop")
    return _deep(float(displacement.values[turn] - displacement.values[loaded[0]]), travel_mm)


def _deep(depth_mm: float, travel_mm: float | None) -> TakeCheck:
    wanted_mm = travel_mm or FELT_mm
    short = f"stopped at {depth_mm:.1f} of {wanted_mm:.1f} mm; press down to the stop"
    reason = short if depth_mm < wanted_mm - SHORT_mm else ""
    return TakeCheck(not reason, travel_mm=depth_mm, reason=reason)


def _displacement(take: Take) -> tuple[FloatArray, FloatArray] | TakeCheck:
    """Return times and the cap's distance from its rest, (n,) each, or why it cannot be determined.

    From a displacement stream; else from the markers, along the line on which they moved farthest.
    """
    displacements, markers = take.of(Quantity.DISPLACEMENT), take.of(Quantity.MARKER)
    if displacements:
        known = np.isfinite(displacements[0].values)
        t_s, down = displacements[0].t_s[known], displacements[0].values[known]
    elif markers:
        positions = np.stack([np.reshape(m.values, (m.t_s.size, -1)) for m in markers])
        seen = np.isfinite(positions).all(axis=(0, 2))
        t_s, positions = markers[0].t_s[seen], positions[:, seen]
        if seen.sum() >= FEWEST and _marker_shift_mm(positions) > KNOCKED_mm:
            return TakeCheck(False, reason="a marker moved on the cap; fix it and press again")
        down = _along(positions.mean(axis=0))
    else:
        return TakeCheck(False, reason="nothing shows where the cap is; check cameras and cables")
    if down.size < FEWEST:
        return TakeCheck(False, reason="the cap was hardly ever seen; check markers and cameras")
    return t_s, down - np.median(down[: down.size // REST_PART])


def _marker_shift_mm(positions_mm: FloatArray) -> float:
    """Return how much the rest positions of markers (2, n, axes) relative to each other changed."""
    apart = positions_mm[0] - positions_mm[-1]
    few = len(apart) // REST_PART
    return float(np.linalg.norm(np.median(apart[-few:], axis=0) - np.median(apart[:few], axis=0)))


def _along(position_mm: FloatArray) -> FloatArray:
    """Project positions (n, axes) on the line from rest to the farthest."""
    if len(position_mm) < FEWEST:
        return np.zeros(len(position_mm))
    off = position_mm - np.median(position_mm[: len(position_mm) // REST_PART], axis=0)
    far = off[int(np.argmax(np.linalg.norm(off, axis=1)))]
    return np.asarray(off @ (far / max(float(np.linalg.norm(far)), 1e-9)))


def _press(
    requested_mm_s: float | None,
    t_s: FloatArray,
    down_mm: FloatArray,
    travel_mm: float | None,
    pace_ratio: float,
) -> TakeCheck:
    # one frame that shows too much must not make a press
    smooth = np.median(np.stack([down_mm[:-2], down_mm[1:-1], down_mm[2:]]), axis=0)
    depth_mm = float(smooth.max())
    if depth_mm < FELT_mm:
        return TakeCheck(False, travel_mm=depth_mm, reason="no press was seen; press when the bar goes down")
    deep = _deep(depth_mm, travel_mm)
    if not deep.ok:
        return deep
    level_mm = min(travel_mm or depth_mm, depth_mm) - 0.05
    end = int(np.argmax(down_mm > level_mm))
    start = int(np.flatnonzero(np.append(0.0, down_mm[:end]) <= START_mm)[-1])
    begun_s = _crossing_s(t_s, down_mm, start - 1, START_mm)
    done_s = _crossing_s(t_s, down_mm, end - 1, level_mm)
    achieved = (level_mm - START_mm) / max(done_s - begun_s, 1e-4)
    stroke = slice(max(start - 1, 0), end + 1)
    reason = _fault(t_s[stroke], down_mm[stroke], smooth, achieved)
    reason = reason or _off_velocity(achieved, requested_mm_s, pace_ratio)
    return TakeCheck(not reason, achieved, depth_mm, reason)


def _fault(t_s: FloatArray, stroke_mm: FloatArray, smooth_mm: FloatArray, achieved_mm_s: float) -> str:
    down = smooth_mm > 0.5 * smooth_mm.max()
    if np.sum(np.diff(down.astype(int)) == 1) > 1:
        return "pressed twice; press once and let go"
    if np.diff(t_s).max(initial=0.0) > GAP_s:
        return "a marker was hidden on the way down; keep the finger clear of it"
    later = np.searchsorted(np.maximum.accumulate(stroke_mm), stroke_mm + HALT_mm)
    inside = later < t_s.size
    halts_s = (t_s[later[inside]] - t_s[inside])[stroke_mm[inside] > START_mm]
    if halts_s.max(initial=0.0) > max(HALT_s, 6 * HALT_mm / achieved_mm_s):
        return "the press paused on its way; press in one move"
    return ""


def _off_velocity(achieved_mm_s: float, requested_mm_s: float | None, pace_ratio: float) -> str:
    if requested_mm_s is None or abs(achieved_mm_s / requested_mm_s - 1) <= pace_ratio:
        return ""
    way, remedy = ("slow", "faster") if achieved_mm_s < requested_mm_s else ("fast", "slower")
    return f"too {way}, {achieved_mm_s:.0f} instead of {requested_mm_s:g} mm/s; press {remedy}"


def _crossing_s(t_s: FloatArray, x_mm: FloatArray, i: int, level_mm: float) -> float:
    i = max(i, 0)
    rise_mm = x_mm[i + 1] - x_mm[i]
    part = (level_mm - x_mm[i]) / rise_mm if rise_mm else 0.0
    return float(t_s[i] + np.clip(part, 0.0, 1.0) * (t_s[i + 1] - t_s[i]))

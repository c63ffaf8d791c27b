"""Find the defects of real benches in one track or stroke, and repair them with a sentence each.

Every function takes samples in the order of time and returns them, shorter where samples were left
out; nothing is smoothed or made up.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt
from numpy.lib.stride_tricks import sliding_window_view

from fdvv.formats.force.types import Notes, RawCycle, Track
from fdvv.model.bump import first_loaded
from fdvv.model.curve import Stroke
from fdvv.units import FloatArray

FAR_mm, STRONG_cN = 1000.0, 100_000.0
"""No button travels a metre or takes a kilonewton."""
SPIKE_cN = 20.0
SPIKE_HALF = 5
SPIKE_WIDTH_mm = 0.06
"""A spike stands 20 cN off the running median of 11 samples and is back within 60 um; the undershoot
of a real snap stays below (15 cN in the loudest click bar measured)."""
STUCK_DROP_cN = 15.0
STUCK_RISE_cN_mm = 150.0
STUCK_WIDTH_mm = 0.5
"""A probe that sticks climbs like a stop (450 to 520 cN/mm seen) and falls in one sample back to where
it came from; a click bar climbs at 20 to 40 cN/mm before its snap."""
JUMP_mm = 0.5
PULL_cN = -5.0
AIR_cN = 2.0
SLIP_mm = 0.25


def _where_x(track: Track, first: int, last: int) -> str:
    a, b = float(track.x_mm[first]), float(track.x_mm[last])
    return f"{track.where} at {a:.3f} mm" if first == last else f"{track.where} from {a:.3f} to {b:.3f} mm"


def drop_impossible(track: Track, notes: Notes) -> Track:
    """Leave out samples beyond a metre or a kilonewton."""
    bad = (np.abs(track.x_mm) > FAR_mm) | (np.abs(track.force_cN) > STRONG_cN)
    return _drop(track, bad, notes, "{x_mm:.3g} mm, {force_cN:.3g} cN cannot be")


def drop_stray_positions(track: Track, notes: Notes) -> Track:
    """Leave out single samples whose displacement jumps away and back by more than 0.5 mm."""
    x = track.x_mm
    step = np.diff(x)
    stray = np.zeros(x.size, dtype=bool)
    stray[1:-1] = (np.minimum(np.abs(step[:-1]), np.abs(step[1:])) > JUMP_mm) & (step[:-1] * step[1:] < 0)
    stray[1:-1] &= np.abs(x[2:] - x[:-2]) < 0.2 * JUMP_mm
    return _drop(track, stray, notes, "displacement jumps to {x_mm:.3f} mm and back")


def _drop(track: Track, bad: npt.NDArray[np.bool_], notes: Notes, fault: str) -> Track:
    """Leave samples out; fault describes the first, whose x_mm and force_cN it may name."""
    if not bad.any():
        return track
    first = int(np.argmax(bad))
    said = fault.format(x_mm=track.x_mm[first], force_cN=track.force_cN[first])
    notes.say(f"{track.where}, sample {first + 1}: {said}; {_samples(int(bad.sum()))} left out")
    return track.take(~bad)


def drop_spikes(track: Track, notes: Notes) -> Track:
    """Leave out isolated excursions of the force: there and back within 60 um.

    A step that stays (a click bar's drop) is no excursion: the samples on both sides must agree.
    """
    force, x = track.force_cN, track.x_mm
    if force.size < 2 * SPIKE_HALF + 1:
        return track
    padded = np.pad(force, SPIKE_HALF, mode="edge")
    off = np.abs(force - np.median(sliding_window_view(padded, 2 * SPIKE_HALF + 1), axis=1))
    spike = np.zeros(force.size, dtype=bool)
    # the feet of a spike belong to it
    for first, last in _runs(off > 0.2 * SPIKE_cN):
        inside = first > 0 and last < force.size - 1
        if not inside or off[first : last + 1].max() <= SPIKE_cN or last - first >= 2 * SPIKE_HALF:
            continue
        back = abs(force[last + 1] - force[first - 1]) < 0.5 * SPIKE_cN
        if back and abs(x[last + 1] - x[first - 1]) <= SPIKE_WIDTH_mm:
            spike[first : last + 1] = True
            worst = first + int(np.argmax(np.abs(force[first : last + 1] - force[first - 1])))
            notes.say(
                f"{_where_x(track, first, last)}: the force leaps to {force[worst]:.1f} cN and back; "
                f"{_samples(last - first + 1)} left out"
            )
    return track.take(~spike) if spike.any() else track


def _runs(mask: npt.NDArray[np.bool_]) -> list[tuple[int, int]]:
    edges = np.flatnonzero(np.diff(np.concatenate(([False], mask, [False])).astype(np.int8)))
    return [(int(a), int(b) - 1) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def drop_stuck_probe(track: Track, notes: Notes) -> Track:
    """Leave out where the probe stuck: a climb as steep as a stop, undone in one sample.

    The force must come back to the level it climbed from, and that level must have been flat: the
    climb of a stiff tact switch before its snap starts at contact and is left alone.
    """
    x, force = track.x_mm, track.force_cN
    keep = np.ones(force.size, dtype=bool)
    for last in np.flatnonzero(np.diff(force) < -STUCK_DROP_cN):
        before = np.flatnonzero(force[:last] <= force[last + 1] + 1.0)
        if not before.size or not keep[last]:
            continue
        first = int(before[-1])
        peak = float(force[first : last + 1].max())
        rise, width = peak - force[first], x[last] - x[first]
        flat = np.flatnonzero((x[:first] > x[first] - 0.2) & (x[:first] < x[first] - 0.01))
        if force[first] < 5.0 or not 0.0 < width <= STUCK_WIDTH_mm or flat.size < 3:
            continue
        base = abs(force[first] - force[flat[0]]) / (x[first] - x[flat[0]])
        if rise / width > STUCK_RISE_cN_mm and base < 0.33 * rise / width:
            keep[first + 1 : last + 1] = False
            notes.say(
                f"{_where_x(track, first + 1, int(last))}: the probe stuck, the force climbs to {peak:.1f} "
                f"cN and falls by {force[last] - force[last + 1]:.1f} cN in one sample; "
                f"{_samples(int(last) - first)} left out"
            )
    return track.take(keep) if not keep.all() else track


def drop_lost_tare(track: Track, notes: Notes) -> Track:
    """Leave out the air before contact or after release where the force reads below -5 cN."""
    pulling = track.force_cN < PULL_cN
    if not pulling.any():
        return track
    runs = _runs(pulling)
    start = runs[0][1] + 1 if runs[0][0] == 0 else 0
    end = runs[-1][0] if runs[-1][1] == pulling.size - 1 else pulling.size
    if end - start < 4 or (start == 0 and end == pulling.size):
        return track
    at = 0 if start else pulling.size - 1
    notes.say(
        f"{track.where}, {'begins' if start else 'ends'} at {track.force_cN[at]:.1f} cN in the air, the "
        f"tare was lost; {_samples(pulling.size - (end - start))} left out"
    )
    return track.take(slice(start, end))


def warn_of_jumps(track: Track, notes: Notes) -> None:
    """Warn where a stretch of the stroke is missing; it stays missing."""
    step = np.diff(track.x_mm)
    limit = max(JUMP_mm, 20.0 * float(np.median(np.abs(step))))
    for i in np.flatnonzero(np.abs(step) > limit)[:3]:
        notes.say(
            f"{track.where}: displacement jumps by {step[i]:.2f} mm, from {track.x_mm[i]:.2f} to "
            f"{track.x_mm[i + 1]:.2f} mm; the samples between are missing and were not made up"
        )


def correct_slip(cycle: RawCycle, notes: Notes) -> RawCycle:
    """Move a press back onto its release where the position counter slipped as the stage turned.

    The evidence must be double: the release leaps off the stop while the force still holds, and press
    and release touch the cap as far apart as that leap.
    """
    press, release = cycle.press, cycle.release
    if press is None or release is None or release.x_mm.size < 12:
        return cycle
    step = np.diff(release.x_mm[:12])
    held = release.force_cN[1:12] > 0.5 * release.force_cN[0]
    leaps = np.flatnonzero((step < -JUMP_mm) & held)
    if not leaps.size:
        return cycle
    apart = _contact_mm(press) - _contact_mm(release)
    fell = float(release.x_mm[0] - release.x_mm[leaps[-1] + 1])
    if apart < SLIP_mm or abs(fell - apart) > 0.5:
        return cycle
    notes.say(
        f"{press.where}: the position counter slipped by {apart:.2f} mm as the stage turned (press and "
        f"release touch the cap that far apart); the press was moved by {-apart:.2f} mm and "
        f"{_samples(int(leaps[-1]) + 1)} caught in the slip left out of the release"
    )
    # the turning samples handed over from the release carry the same slip, so the whole press moves
    moved = replace(press, x_mm=press.x_mm - apart)
    return replace(cycle, press=moved, release=release.take(slice(int(leaps[-1]) + 1, None)))


def _contact_mm(track: Track) -> float:
    # at 10 cN, not at first touch: the air after a release rings
    order = np.argsort(track.x_mm, kind="stable")
    x, force = track.x_mm[order], track.force_cN[order]
    return float(x[first_loaded(x, force)])


def rising(track: Track, notes: Notes) -> tuple[FloatArray, FloatArray]:
    """Put the samples in the order of displacement: (x_mm, force_cN).

    A stage that wavers measures the force at the place where it then is, so each sample keeps its own
    displacement and the samples are sorted (stable: repeats stay in the order of time). Lifting the
    displacement to its running maximum would assign forces to places where they were not measured.
    """
    x, force = track.x_mm, track.force_cN
    if x[-1] < x[0]:
        x, force = x[::-1], force[::-1]
    back = float((np.maximum.accumulate(x) - x).max())
    forward = np.diff(x)
    quantum = float(np.median(forward[forward > 0])) if (forward > 0).any() else 0.0
    # in the air the order makes no difference to the curve
    loaded = x[force > AIR_cN]
    back_loaded = float((np.maximum.accumulate(loaded) - loaded).max()) if loaded.size else 0.0
    if back_loaded > 1.01 * max(quantum, 0.005):
        notes.tally(
            "{places}: displacement wavers back by up to {most:.3f} mm; the samples were put in the order "
            "of displacement, none dropped",
            track.where,
            back_loaded,
        )
    if back > 0.0:
        order = np.argsort(x, kind="stable")
        x, force = x[order], force[order]
    return x, force


def _samples(count: int) -> str:
    return "1 sample was" if count == 1 else f"{count} samples were"


def switching_mm(track: Track | None, stroke: Stroke, notes: Notes) -> float | None:
    """Find the first sample after the one edge of the contact; None, with a reason, if there is not one.

    A press closes the contact, a release opens it. A contact that chatters has no single point.
    """
    if track is None or track.closed is None:
        return None
    closed = track.closed > 0.5
    edges = np.flatnonzero(np.diff(closed.astype(np.int8)))
    if edges.size == 1 and closed[-1] == (stroke is Stroke.PRESS):
        return float(track.x_mm[edges[0] + 1])
    point = "actuation" if stroke is Stroke.PRESS else "reset"
    if edges.size > 1:
        places = f"{track.x_mm[edges].min():.3f} to {track.x_mm[edges].max():.3f} mm"
        notes.say(f"{track.where}: the contact chatters, {edges.size} edges from {places}; no {point} point")
    else:
        notes.say(
            f"{track.where}: the contact never {'closed' if not closed.any() else 'opened'}; no {point} point"
        )
    return None


def mean_velocity_mm_s(track: Track) -> float | None:
    """Compute the mean speed between 10 % and 90 % of the stroke, to three digits; None without a clock."""
    if track.time_s is None:
        return None
    x = track.x_mm
    low, high = x.min() + 0.1 * np.ptp(x), x.min() + 0.9 * np.ptp(x)
    inside = np.flatnonzero((x >= low) & (x <= high))
    if inside.size < 2:
        return None
    took = float(track.time_s[inside[-1]] - track.time_s[inside[0]])
    moved = float(abs(x[inside[-1]] - x[inside[0]]))
    if took <= 0.0 or moved <= 0.0 or not np.isfinite(moved / took):
        return None
    return float(f"{moved / took:.3g}")

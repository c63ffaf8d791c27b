"""Find the defects of real benches in one track or stroke, and repair them with a sentence each.

Every function takes samples in the order of time and returns them, shorter where samples were left
out; nothing is smoothed or made up.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from fdvv.force_text import force_text
from fdvv.formats.force.types import Notes, RawCycle, Track
from fdvv.model.bump import LOADED_cN, bounds_of_runs, find_contact_mm, first_loaded
from fdvv.model.curve import MeasuredCurve, Stroke
from fdvv.units import FloatArray

FAR_mm, STRONG_cN = 1000.0, 100_000.0
"""No button travels a metre or takes a kilonewton."""
JUMP_mm = 0.5
PULL_cN = -5.0
RESTED, FELL_cN = 10, 12.0
"""Samples within 5 cN of zero after a release (39 were seen), or a fall in one sample: either shows that the
zero was right while the button was pressed."""
LOST_TARE_ratio = 0.3
"""Of the greatest force; at most 0.17 was seen. More is no tare, and stays for the gates."""
AIR_cN = 2.0  # assumed; a fifth of LOADED_cN, the force of contact
SLIP_mm = 0.25  # assumed; below the 0.48 mm by which a real file slips (tests/formats/test_shared_data.py)


def where_x(track: Track, first: int, last: int) -> str:
    a, b = float(track.x_mm[first]), float(track.x_mm[last])
    return f"{track.where} at {a:.3f} mm" if first == last else f"{track.where} from {a:.3f} to {b:.3f} mm"


def drop_impossible(track: Track, notes: Notes) -> Track:
    """Leave out samples beyond a metre or a kilonewton."""
    bad = (np.abs(track.x_mm) > FAR_mm) | (np.abs(track.force_cN) > STRONG_cN)
    return _drop(track, bad, notes, "{x_mm:.3g} mm, {force} cannot be")


def drop_stray_positions(track: Track, notes: Notes) -> Track:
    """Leave out single samples whose displacement jumps away and back by more than 0.5 mm."""
    x = track.x_mm
    step = np.diff(x)
    stray = np.zeros(x.size, dtype=bool)
    stray[1:-1] = (np.minimum(np.abs(step[:-1]), np.abs(step[1:])) > JUMP_mm) & (step[:-1] * step[1:] < 0)
    stray[1:-1] &= np.abs(x[2:] - x[:-2]) < 0.2 * JUMP_mm
    return _drop(track, stray, notes, "displacement jumps to {x_mm:.3f} mm and back")


def _drop(track: Track, bad: npt.NDArray[np.bool_], notes: Notes, fault: str) -> Track:
    """Leave samples out; fault describes the first, whose x_mm and force it may name."""
    if not bad.any():
        return track
    first = int(np.argmax(bad))
    said = fault.format(x_mm=track.x_mm[first], force=force_text(track.force_cN[first], ".3g"))
    notes.say(f"{track.where}, sample {first + 1}: {said}; {samples(int(bad.sum()))} left out")
    return track.take(~bad)


def runs(mask: npt.NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return the first and the last index of every run of True."""
    return [(int(a), int(b) - 1) for a, b in zip(*bounds_of_runs(mask), strict=True)]


def drop_lost_tare(track: Track, notes: Notes) -> Track:
    """Leave out the air before contact or after release where the force reads below -5 cN."""
    pulling = track.force_cN < PULL_cN
    if not pulling.any():
        return track
    pulls = runs(pulling)
    start = pulls[0][1] + 1 if pulls[0][0] == 0 else 0
    end = pulls[-1][0] if pulls[-1][1] == pulling.size - 1 else pulling.size
    if end - start < 4 or (start == 0 and end == pulling.size):
        return track
    if -track.force_cN.min() > LOST_TARE_ratio * track.force_cN.max():
        return track
    if end < pulling.size and not _lost_after(track.force_cN, end):
        return track
    at = 0 if start else pulling.size - 1
    notes.say(
        f"{track.where}, {'begins' if start else 'ends'} at {force_text(track.force_cN[at], '.1f')} in the "
        "air, the "
        f"tare was lost; {samples(pulling.size - (end - start))} left out"
    )
    return track.take(slice(start, end))


def _lost_after(force_cN: FloatArray, end: int) -> bool:
    rested = np.abs(force_cN[max(0, end - RESTED) : end]) <= -PULL_cN
    return bool(rested.all()) or float(force_cN[end - 1] - force_cN[end]) > FELL_cN


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
    apart = contact_mm(press) - contact_mm(release)
    fell = float(release.x_mm[0] - release.x_mm[leaps[-1] + 1])
    if apart < SLIP_mm or abs(fell - apart) > 0.5:
        return cycle
    notes.say(
        f"{press.where}: the position counter slipped by {apart:.2f} mm as the stage turned (press and "
        f"release touch the cap that far apart); the press was moved by {-apart:.2f} mm and "
        f"{samples(int(leaps[-1]) + 1)} caught in the slip left out of the release"
    )
    # the turning samples handed over from the release carry the same slip, so the whole press moves
    moved = replace(press, x_mm=press.x_mm - apart)
    return replace(cycle, press=moved, release=release.take(slice(int(leaps[-1]) + 1, None)))


def contact_mm(track: Track) -> float:
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


def warn_of_touches(curve: MeasuredCurve, where: str, notes: Notes) -> None:
    """Warn where the force reaches 10 cN in the air and falls back: that is not contact."""
    air = curve.displacement_mm < find_contact_mm(curve)
    touching = air & (curve.force_cN >= LOADED_cN)
    if touching.any():
        place = float(curve.displacement_mm[touching][0])
        notes.say(
            f"{where} at {place:.3f} mm: the force touches "
            f"{force_text(curve.force_cN[touching].max(), '.1f')} in the "
            "air and falls back; it is not taken for contact"
        )


def samples(count: int) -> str:
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

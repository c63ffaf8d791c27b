"""Turn a run into press and release: which way the axes point, where each cycle turns."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from fdvv.formats.force.types import Notes, RawCycle, Track
from fdvv.units import FloatArray

CYCLE = "cycle"
"""Label of the cycles of a run that goes down and up several times, before their numbers."""
LEAST_RETURN = 0.1
"""A run that goes back by less than this part of its travel has no second stroke."""


def orient(track: Track, notes: Notes, begins_out: bool = True) -> Track:
    """Point displacement into the button and force against the finger.

    begins_out : a run and a press begin outside the button. What would begin inside with its sign turned
    counts the force from its greatest, so it stays as it is.

    The deep end of a stroke is where the force is: if the force is greatest in size at the least
    displacement, the file counted height, and its sign is turned; if the force there is negative, the
    load cell counted push as minus.
    """
    x, force = track.x_mm, track.force_cN
    span = float(np.ptp(x))
    # a contact step is 2 % of the travel: a wider window would hold it
    shallow, deep = force[x <= x.min() + 0.01 * span], force[x >= x.max() - 0.01 * span]
    low, high = float(np.median(shallow)), float(np.median(deep))
    inside = begins_out and x[0] < 0.5 * (x.min() + x.max())
    if abs(low) > 2.0 * abs(high) and abs(low) > 20.0 and not inside:
        notes.tally("{places}: displacement counts outwards; its sign was turned", track.where, span)
        track = replace(track, x_mm=-x)
        high = low
    if high < -20.0 and np.median(force) <= 0.0:
        notes.tally("{places}: force counts a push as negative; its sign was turned", track.where, -high)
        track = replace(track, force_cN=-force)
    return track


def cycle_bounds(x_mm: FloatArray) -> list[slice]:
    """Find the cycles of a run that goes down and up several times.

    A cycle counts when the run has been below a quarter and above three quarters of its span; two
    cycles part at the least displacement between their deep ends.
    """
    low, high = x_mm.min() + 0.25 * np.ptp(x_mm), x_mm.min() + 0.75 * np.ptp(x_mm)
    level = np.where(x_mm >= high, 1, np.where(x_mm <= low, -1, 0))
    at = np.flatnonzero(level)
    changes = np.flatnonzero(np.diff(level[at]) != 0)
    deep_starts = [int(at[i + 1]) for i in changes if level[at[i + 1]] == 1]
    if level[at[0]] == 1:
        deep_starts.insert(0, 0)
    cuts = [0]
    for before, after in pairwise(deep_starts):
        rest = before + np.flatnonzero(x_mm[before:after] == x_mm[before:after].min())
        cuts.append(int(rest[0] + rest[-1] + 1) // 2)
    return [slice(a, b) for a, b in zip(cuts, [*cuts[1:], x_mm.size], strict=True)]


def turn_index(x_mm: FloatArray, force_cN: FloatArray) -> int:
    """Find the last sample of the press: the greatest force among the deepest samples.

    The stage dwells at the deep end while the force relaxes; those samples belong to the release.
    """
    deepest = np.flatnonzero(x_mm >= x_mm.max() - 0.002 * np.ptp(x_mm))
    return int(deepest[np.argmax(force_cN[deepest])])


def split_run(cycle: RawCycle, notes: Notes) -> list[RawCycle]:
    """Split a run into cycles of press and release; strokes that are too short come out as None."""
    if cycle.run is None:
        return [cycle]
    run = orient(cycle.run, notes)
    bounds = cycle_bounds(run.x_mm)
    return [
        _split_one(cycle, run.take(part), f"{CYCLE} {i + 1}" if len(bounds) > 1 else cycle.label, notes)
        for i, part in enumerate(bounds)
    ]


def _split_one(cycle: RawCycle, run: Track, label: str, notes: Notes) -> RawCycle:
    run = replace(run, where=label or run.where)
    turn = turn_index(run.x_mm, run.force_cN)
    span = float(np.ptp(run.x_mm))
    press: Track | None = replace(run.take(slice(0, turn + 1)), where=f"press of {run.where}")
    release: Track | None = replace(run.take(slice(turn + 1, None)), where=f"release of {run.where}")
    # the other stroke's samples then only dwell at the end: they stay with the stroke they end
    if run.x_mm[turn] - run.x_mm[-1] < LEAST_RETURN * span or release is None or release.x_mm.size < 4:
        notes.tally("{places}: the run ends at its deep end; there is no release", run.where, 0.0)
        press, release = replace(run, where=f"press of {run.where}"), None
    elif run.x_mm[turn] - run.x_mm[0] < LEAST_RETURN * span or turn < 3:
        notes.tally("{places}: the run begins at its deep end; there is no press", run.where, 0.0)
        press, release = None, replace(run, where=f"release of {run.where}")
    return replace(cycle, label=label, run=None, press=press, release=release)


def hand_over_turn(cycle: RawCycle, notes: Notes) -> RawCycle:
    """Move the first samples of a release that still go down to the press they end.

    Benches that cut their record where the force was reached, not where the stage turned, store the
    last of the press as the first of the release.
    """
    press, release = cycle.press, cycle.release
    if press is None or release is None or release.x_mm[-1] >= release.x_mm[0]:
        return cycle
    turn = int(np.argmax(release.x_mm))
    if turn == 0 or turn > 0.1 * release.x_mm.size or release.x_mm.size - turn < 4:
        return cycle
    notes.tally(
        "{places}: the first samples (at most {most:.0f}) still go down; they were given to the press",
        release.where,
        turn,
    )
    joined = replace(
        press,
        x_mm=np.concatenate((press.x_mm, release.x_mm[:turn])),
        force_cN=np.concatenate((press.force_cN, release.force_cN[:turn])),
        time_s=None,
        closed=None,
    )
    return replace(cycle, press=joined, release=release.take(slice(turn, None)))

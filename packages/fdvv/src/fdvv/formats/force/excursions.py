"""Excursions of the force that are the bench's, not the switch's: spikes, and climbs of a stuck probe."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from fdvv.force_text import force_text
from fdvv.formats.force.repair import contact_mm, runs, samples, where_x
from fdvv.formats.force.types import Notes, Track

SPIKE_cN = 20.0
SPIKE_HALF = 5
SPIKE_WIDTH_mm = 0.06
"""A spike stands 20 cN off the running median of 11 samples and is back within 60 um and 5 samples, more of
which the median does not see through; the undershoot of a real snap stays below (15 cN in the loudest click
bar measured)."""
SLIP_CLIMB_mm = 0.1
RECURS_mm = 0.2
"""The same feature of two cycles lies within this, from contact."""
KEPT = "{places}: the force leaps by up to {force} and back, alike in several cycles; it was kept"
STUCK_DROP_cN = 15.0
STUCK_RISE_cN_mm = 150.0
STUCK_WIDTH_mm = 0.5
STUCK_AFTER_mm = 0.05
"""A probe that sticks climbs like a stop (450 to 520 cN/mm seen) and falls in one sample back to where
it came from; a click bar climbs at 20 to 40 cN/mm before its snap."""


class Excursion(NamedTuple):
    """Samples first to last, of which the worst stands height_cN off the one before the first."""

    first: int
    last: int
    worst: int
    height_cN: float


def drop_spikes(track: Track, notes: Notes, repeats: Sequence[Track] = ()) -> Track:
    """Leave out isolated excursions of the force: there and back within 60 um.

    A step that stays (a click bar's drop) is no excursion: the samples on both sides must agree. A slip,
    a fall amid a climb to where the force was within 0.1 mm before, stays; so does what recurs within 0.2 mm
    in one of the repeats, the same stroke of other cycles: it is the switch's own.
    """
    keep = np.ones(track.force_cN.size, dtype=bool)
    for one in _foreign(track, _spikes, notes, repeats):
        keep[one.first : one.last + 1] = False
        notes.say(
            f"{where_x(track, one.first, one.last)}: the force leaps to "
            f"{force_text(track.force_cN[one.worst], '.1f')} "
            f"and back; {samples(one.last - one.first + 1)} left out"
        )
    return track.take(keep) if not keep.all() else track


def _foreign(
    track: Track,
    find: Callable[[Track], list[Excursion]],
    notes: Notes,
    repeats: Sequence[Track],
) -> list[Excursion]:
    """Find excursions; what recurs in a repeat is reported and left out of the list."""
    foreign = []
    for one in find(track):
        place_mm = track.x_mm[one.worst] - contact_mm(track)
        recurs = any(
            abs(other.x_mm[theirs.worst] - contact_mm(other) - place_mm) <= RECURS_mm
            and theirs.height_cN * one.height_cN > 0
            for other in repeats
            for theirs in find(other)
        )
        if recurs:
            notes.tally(KEPT, track.where, abs(one.height_cN))
        else:
            foreign.append(one)
    return foreign


def _spikes(track: Track) -> list[Excursion]:
    force, x = track.force_cN, track.x_mm
    if force.size < 2 * SPIKE_HALF + 1:
        return []
    padded = np.pad(force, SPIKE_HALF, mode="edge")
    off = np.abs(force - np.median(sliding_window_view(padded, 2 * SPIKE_HALF + 1), axis=1))
    found = []
    # the feet of a spike belong to it
    for first, last in runs(off > 0.2 * SPIKE_cN):
        inside = first > 0 and last < force.size - 1
        if not inside or off[first : last + 1].max() <= SPIKE_cN or last - first >= SPIKE_HALF:
            continue
        back = abs(force[last + 1] - force[first - 1]) < 0.5 * SPIKE_cN
        if back and abs(x[last + 1] - x[first - 1]) <= SPIKE_WIDTH_mm:
            worst = first + int(np.argmax(np.abs(force[first : last + 1] - force[first - 1])))
            spike = Excursion(first, last, worst, float(force[worst] - force[first - 1]))
            found += [] if _slips(track, spike) else [spike]
    return found


def _slips(track: Track, spike: Excursion) -> bool:
    """Whether a spike is a fall amid a climb, to no less than the force 0.1 mm less deep."""
    x, force = track.x_mm, track.force_cN
    above = (x < x[[spike.first, spike.last]].min()) & (x >= x[spike.worst] - SLIP_CLIMB_mm)
    return spike.height_cN < 0 and bool(above.any()) and bool(force[above].min() <= force[spike.worst])


def drop_stuck_probe(track: Track, notes: Notes, repeats: Sequence[Track] = ()) -> Track:
    """Leave out where the probe stuck: a climb as steep as a stop, undone in one sample.

    The force must come back to the level it climbed from, and that level must have been flat: the
    climb of a stiff tact switch before its snap starts at contact and is left alone, as is what recurs in
    one of the repeats.
    """
    keep = np.ones(track.force_cN.size, dtype=bool)
    for one in _foreign(track, _stuck, notes, repeats):
        keep[one.first : one.last + 1] = False
        fell_cN = track.force_cN[one.last] - track.force_cN[one.last + 1]
        notes.say(
            f"{where_x(track, one.first, one.last)}: the probe stuck, the force climbs to "
            f"{force_text(track.force_cN[one.worst], '.1f')} and falls by {force_text(fell_cN, '.1f')} in "
            "one sample; "
            f"{samples(one.last - one.first + 1)} left out"
        )
    return track.take(keep) if not keep.all() else track


def _stuck(track: Track) -> list[Excursion]:
    x, force = track.x_mm, track.force_cN
    found: list[Excursion] = []
    for last in map(int, np.flatnonzero(np.diff(force) < -STUCK_DROP_cN)):
        before = np.flatnonzero(force[:last] <= force[last + 1] + 1.0)
        if not before.size or any(one.first <= last <= one.last for one in found):
            continue
        first = int(before[-1])
        worst = first + int(np.argmax(force[first : last + 1]))
        rise, width = float(force[worst] - force[first]), x[last] - x[first]
        flat = np.flatnonzero((x[:first] > x[first] - 0.2) & (x[:first] < x[first] - 0.01))
        if force[first] < 5.0 or not 0.0 < width <= STUCK_WIDTH_mm or flat.size < 3:
            continue
        base = abs(force[first] - force[flat[0]]) / (x[first] - x[flat[0]])
        # inside a stop the climb goes on: the cap slipped, no probe stuck
        after = force[last + 1 :][x[last + 1 :] <= x[last + 1] + STUCK_AFTER_mm]
        onward = float(after[-1] - after[0]) / STUCK_AFTER_mm
        if rise / width > STUCK_RISE_cN_mm and max(base, onward) < 0.33 * rise / width:
            found.append(Excursion(first + 1, last, worst, rise))
    return found

"""Did the bench record what it felt? What amplifiers, converters, stages and editors leave in a stroke.

Bounds as in fdvv.button.plausible; "real files" are here the 110 of the eight sets beside the checkout.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from fdvv.button.plausible import ROWS, UNITS, Implausible
from fdvv.force_text import force_number, force_text
from fdvv.model.bump import LOADED_cN, find_contact_mm
from fdvv.model.curve import MeasuredCurve, Stroke
from fdvv.units import FloatArray

CELL = "check the load cell, its amplifier and its range"

FLAT_mm, FLAT_coarse_mm, FLAT_samples = 0.25, 1.5, 10
"""A force that stays the same to its last digit. Real files: 0.13 mm. A full converter, or a cell that hangs,
holds it for longer; so does a scale of 1 gf on a flat curve, for which the second bound is."""
FINE_cN = 0.3
"""Typical step between the forces of a cell whose noise shows: equal samples are then a matter of chance."""

LEVEL_cN, LEVEL_samples = 5.0, 50
"""Typical step between the forces that occur. Real files: 1.2 cN in 81 samples, 0.1 cN in 600."""

REPEATS, REPEATS_mm = 6.0, 0.05
"""Rows per displacement where displacements are so far apart. Real files: 2.4; two decimals lost: 20. A slow
stage with a fine scale may be sampled as often."""

SWING_cN, SWING_ratio, SWINGS = 5.0, 0.05, 8
"""How often the force turns by more than this much, and this part of its range. Real files: 4; a hum: 20."""

FINE_mm = 0.03
"""Coarser samples do not tell a snap from a leap: the two bounds below are then not asked."""

LEAP_cN, LEAP_mm, RESTORED_ratio = 15.0, 0.8, 0.3
"""A leap in one sample that another undoes within this travel, the force as it was but for 0.3 of the leap.
Real files: 10.7 cN."""

RISE_ratio = {Stroke.PRESS: 2.5, Stroke.RELEASE: 3.0}
FALL_ratio = {Stroke.PRESS: 0.25, Stroke.RELEASE: 0.4}
WITHIN_mm, CONTACT_mm, SMALL_cN = 0.03, 0.15, 5.0
"""The force after 0.03 mm, or two steps, over that before, from 0.15 mm below contact on (a stroke is in the
order of rising displacement). Real files: up to 1.49 and 1.76, down to 0.38 and 0.69."""

LOST_mm, LOST_steps = 0.1, 20.0
MISSING_mm = 0.5
"""Jumps of the displacement, each longer than this and than so many steps, together. Real files: 0.3 mm."""

PULL_ratio = 0.3
"""Greatest pull over greatest push. Real files: 0.17, where the tare was lost."""

AIR_cN, AIR_mm, AIR_samples = 10.0, 0.1, 5
"""Median force where nothing is touched. Real files: -0.8 to 1.2 cN."""

REST_cN, REST_ratio, REST_mm = 15.0, 0.15, 0.02
"""Force left on the release where the press began, and part of its greatest, if it began with none: a bench
may begin on the cap. Real files: -2.2 to 10.8 cN."""


def distorted(
    wholes: Sequence[MeasuredCurve],
    parts: Sequence[MeasuredCurve],
    pairs: Sequence[tuple[MeasuredCurve, MeasuredCurve]],
) -> Iterator[Implausible]:
    """Find what no button does.

    wholes : strokes with air and stop. parts : strokes from contact to bottom-out. pairs : whole presses and
    their releases.
    """
    for whole in wholes:
        yield from distorted_whole(whole)
    for part in parts:
        yield from distorted_active(part)
    for press, release in pairs:
        yield from distorted_rest(press, release)


def distorted_whole(stroke: MeasuredCurve) -> Iterator[Implausible]:
    """Find what no button does in a whole stroke, air and stop included."""
    where, force = str(stroke.stroke), stroke.force_cN
    x, means, _ = stroke.by_displacement()
    levels = np.unique(np.round(force, 4))
    level_cN = float(np.median(np.diff(levels))) if levels.size > 1 else 0.0
    start, end, count = _longest_flat(stroke)
    if end - start > (FLAT_mm if level_cN < FINE_cN else FLAT_coarse_mm) and count >= FLAT_samples:
        reason = f"the force is exactly the same from {start:.2f} to {end:.2f} mm"
        yield Implausible(where, reason, CELL)
    if x.size >= LEVEL_samples and level_cN > LEVEL_cN:
        reason = f"the force comes in steps of {force_text(level_cN, '.3g')}"
        yield Implausible(where, reason, CELL)
    if force.size > REPEATS * x.size and x.size > 1 and np.median(np.diff(x)) >= REPEATS_mm:
        reason = f"{force.size} rows have only {x.size} displacements"
        yield Implausible(where, reason, "check that no decimals were lost")
    if -means.min() > PULL_ratio * means.max():
        reason = (
            f"the force goes down to {force_text(means.min(), '.3g')} and up to "
            f"{force_text(means.max(), '.3g')}"
        )
        yield Implausible(where, reason, UNITS)


def _longest_flat(stroke: MeasuredCurve) -> tuple[float, float, int]:
    """Return where the longest stretch of equal forces above 10 cN begins and ends, and how many it holds."""
    x, force = stroke.displacement_mm, stroke.force_cN
    cuts = np.flatnonzero(np.abs(np.diff(force)) > 1e-6)
    first, last = np.append(0, cuts + 1), np.append(cuts, force.size - 1)
    length = np.where(force[first] > LOADED_cN, x[last] - x[first], -1.0)
    at = int(np.argmax(length))
    return float(x[first[at]]), float(x[last[at]]), int(last[at] - first[at]) + 1


def distorted_active(stroke: MeasuredCurve) -> Iterator[Implausible]:
    """Find what no button does in a stroke between contact and bottom-out."""
    where = str(stroke.stroke)
    x, force, _ = stroke.by_displacement()
    if x.size < 3:
        return
    least = max(SWING_cN, SWING_ratio * float(np.ptp(force)))
    turns = _turns(force, least)
    if turns > SWINGS:
        reason = f"the force turns {turns} times by more than {force_text(least, '.3g')}"
        yield Implausible(where, reason, "check the bench for hum and loose contacts")
    step = np.diff(x)
    if np.median(step) <= FINE_mm:
        yield from _leaps(stroke.stroke, x, force)
        yield from _jumps(stroke.stroke, x, force)
    lost = float(step[step > max(LOST_mm, LOST_steps * float(np.median(step)))].sum())
    if lost > MISSING_mm:
        reason = f"the displacement jumps by {lost:.2f} mm in all"
        yield Implausible(where, reason, "check that the stage did not slip and the file is whole")


def _turns(force: FloatArray, least_cN: float) -> int:
    """Count the peaks and valleys that differ by more than least_cN from the one before."""
    count, rising, edge = 0, True, float(force[0])
    for value in map(float, force):
        if (value > edge) is rising or value == edge:
            edge = value
        elif abs(value - edge) > least_cN:
            count, rising, edge = count + 1, not rising, value
    return count


def _leaps(stroke: Stroke, x: FloatArray, force: FloatArray) -> Iterator[Implausible]:
    step = np.diff(x)
    leap = np.where(step <= max(WITHIN_mm, 2 * float(np.median(step))), np.diff(force), 0.0)
    for i in np.flatnonzero(np.abs(leap) > LEAP_cN):
        later = np.flatnonzero((leap * leap[i] < 0) & (np.abs(leap) > LEAP_cN) & (x[:-1] > x[i]))
        for j in later[x[later + 1] <= x[i] + LEAP_mm]:
            if abs(force[j + 1] - force[i]) <= RESTORED_ratio * min(abs(leap[i]), abs(leap[j])):
                reason = (
                    f"the force leaps by {force_text(leap[i], '.3g')} at {x[i]:.2f} mm, and back at "
                    f"{x[j]:.2f} mm"
                )
                yield Implausible(str(stroke), reason, CELL)
                return


def _jumps(stroke: Stroke, x: FloatArray, force: FloatArray) -> Iterator[Implausible]:
    """Find where the force goes on at another scale or from another zero."""
    within = max(WITHIN_mm, 2 * float(np.median(np.diff(x))))
    after = force[np.searchsorted(x, x + within, side="right") - 1]
    ratio = after / np.maximum(force, SMALL_cN)
    ratio[(x < x[0] + CONTACT_mm) | (np.maximum(force, after) < LOADED_cN)] = 1.0
    for at in (int(ratio.argmax()), int(ratio.argmin())):
        if not FALL_ratio[stroke] <= ratio[at] <= RISE_ratio[stroke]:
            reason = (
                f"the force jumps from {force_number(force[at], '.3g')} to {force_text(after[at], '.3g')} at "
                f"{x[at]:.2f} mm"
            )
            yield Implausible(str(stroke), reason, f"{CELL}, and the units")


def distorted_rest(press: MeasuredCurve, release: MeasuredCurve) -> Iterator[Implausible]:
    """Find a force where nothing is pressed: before contact, and where the press began."""
    contact_mm = find_contact_mm(press)
    for stroke in (press, release):
        air = stroke.force_cN[stroke.displacement_mm < contact_mm - AIR_mm]
        if air.size >= AIR_samples and abs(float(np.median(air))) > AIR_cN:
            reason = f"reads {force_text(float(np.median(air)), '.3g')} where nothing is touched"
            yield Implausible(str(stroke.stroke), reason, CELL)
    rest_cN = float(release.by_displacement()[1][0])
    begun_cN = float(press.by_displacement()[1][0])
    begun = float(release.displacement_mm[0]) <= contact_mm + REST_mm and abs(begun_cN) <= AIR_cN
    most_cN = max(REST_cN, REST_ratio * float(release.force_cN.max()))
    if begun and not -AIR_cN <= rest_cN <= most_cN:
        reason = f"ends with {force_text(rest_cN, '.3g')} where the press began"
        yield Implausible("release", reason, f"{CELL}, and {ROWS.removeprefix('check ')}")

"""From markers in space to how deep the cap is: the axis of the press, the middle of two."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.recording import Quantity, Stream, Take
from fdvv.units import FloatArray


@dataclass(frozen=True, eq=False)
class Depth:
    """How deep the cap was seen, on the clock of whoever saw it.

    Attributes
    ----------
    t_s : (k,) starts of the exposures; frames in which nothing was seen are left out.
    depth_mm : (k,) along the press, zero not yet set.
    apart_mm : (k,) how far the markers are from each other along the press; NaN where one is missing, or
        is all there is.
    """

    t_s: FloatArray
    depth_mm: FloatArray
    apart_mm: FloatArray


def press_axis(takes: Sequence[Take]) -> FloatArray | None:
    """Find the direction in which the markers go when the cap is pressed, (3,); None for one-axis sensors.

    It is the first principal axis of all movement; its sign is that in which force and place rise together.
    """
    moved, felt = [], []
    for take in takes:
        markers = [stream for stream in take.of(Quantity.MARKER) if stream.raw.ndim == 2]
        for marker in markers:
            if not np.isfinite(marker.values).any():
                continue
            place = marker.values - np.nanmedian(marker.values, axis=0)
            seen = np.isfinite(place).all(axis=1)
            moved.append(place[seen])
            force = _force_at(take, marker.t_s[seen])
            felt.append(force if force is not None else np.zeros(int(seen.sum())))
    if not moved:
        return None
    places, forces = np.concatenate(moved), np.concatenate(felt)
    if places.shape[0] < 3:
        raise ModelError("the markers were seen in fewer than 3 frames")
    far = np.linalg.norm(places, axis=1) >= np.quantile(np.linalg.norm(places, axis=1), 0.5)
    axis: FloatArray = np.linalg.svd(places[far] - places[far].mean(axis=0), full_matrices=False)[2][0]
    along = places @ axis
    rising = float(np.sum((along - along.mean()) * (forces - forces.mean())))
    return axis if rising >= 0 else -axis


def _force_at(take: Take, t_s: FloatArray) -> FloatArray | None:
    """Roughly tell the force at times of another clock: both records begin together to a fraction of them."""
    forces = take.of(Quantity.FORCE)
    if not forces or t_s.size < 2:
        return None
    force = forces[0]
    part = (t_s - t_s[0]) / (t_s[-1] - t_s[0])
    return np.asarray(np.interp(part, np.linspace(0, 1, force.t_s.size), force.values))


def depth_of(take: Take, axis: FloatArray | None) -> Depth | None:
    """Tell how deep the cap was in a take; None if nothing looked at it.

    A displacement sensor is taken as it is. Of two markers the middle counts: rocking moves them against each
    other. Where one is missing the other is led by what they were apart at that depth.
    """
    sensors = take.of(Quantity.DISPLACEMENT)
    if sensors:
        seen = np.isfinite(sensors[0].values)
        values = sensors[0].values[seen]
        return Depth(sensors[0].t_s[seen], values, np.full(values.size, np.nan))
    markers = take.of(Quantity.MARKER)
    if not markers:
        return None
    if len(markers) > 2:
        raise ModelError(f"take {take.number} has {len(markers)} markers; name the one or two on the cap")
    times, columns = _together([_along(marker, axis) for marker in markers])
    if len(columns) == 1:
        return _one(times, columns[0])
    return _two(times, columns[0], columns[1])


def _along(marker: Stream, axis: FloatArray | None) -> tuple[FloatArray, FloatArray]:
    values = marker.values
    if values.ndim == 2:
        values = values @ (axis if axis is not None else np.array([0.0, 0.0, 1.0]))
    return marker.t_s, values


def _together(columns: Sequence[tuple[FloatArray, FloatArray]]) -> tuple[FloatArray, list[FloatArray]]:
    """Put columns on all times that any of them has; NaN where one lacks a frame."""
    times = np.unique(np.concatenate([t for t, _ in columns]))
    joined = []
    for t, values in columns:
        column = np.full(times.size, np.nan)
        column[np.searchsorted(times, t)] = values
        joined.append(column)
    return times, joined


def _one(times: FloatArray, values: FloatArray) -> Depth:
    seen = np.isfinite(values)
    return Depth(times[seen], values[seen], np.full(int(seen.sum()), np.nan))


def _two(times: FloatArray, left: FloatArray, right: FloatArray) -> Depth:
    both = np.isfinite(left) & np.isfinite(right)
    if both.sum() < 3:
        return _one(times, np.where(np.isfinite(left), left, right))
    half = 0.5 * (left - right)
    middle = 0.5 * (left + right)
    for marker, sign in ((left, -1.0), (right, 1.0)):
        alone = np.isfinite(marker) & ~both
        if alone.any():
            # how far apart they are goes with how deep the cap is: rocking
            slope, start = np.polyfit(marker[both], half[both], 1)
            middle[alone] = marker[alone] + sign * (start + slope * marker[alone])
    seen = np.isfinite(middle)
    return Depth(times[seen], middle[seen], 2 * half[seen])
